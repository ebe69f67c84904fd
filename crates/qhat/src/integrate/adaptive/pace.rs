//! Pace: how long the substeps of a frame are.
//!
//! An embedded pair goes at a *free* pace: the length of each substep follows the error of the one before. A symplectic
//! method must not do so. Its energy error oscillates within bounds while the substep is constant, and each change of
//! the substep shifts the oscillation, so that the errors of many changes add up. A pendulum whose substeps followed
//! its swing lost 60 % of its energy in 9,500 periods.
//!
//! A symplectic method therefore goes at a *steady* pace. A substep is a frame over a power of two, and it stays until
//!
//! - it is rejected, or longer than the method allows, or its error is above the tolerance: then it is halved for good,
//!   or
//! - it was calm for long: `CALM` substeps in a row would have been accepted at twice the length. Then the length is
//!   doubled. Where that length has proved too long before, it takes twice as many calm substeps each time.
//!
//! The number of changes thus grows with the logarithm of the number of substeps, and a run settles at one length.

use crate::state::SteadyMemory;

/// Calm substeps in a row after which the length is doubled for the first time: a few oscillations, since a shorter
/// stretch says nothing about the next one.
const CALM: u64 = 128;

/// What an error estimate of third order grows by when the substep is doubled.
const DOUBLED: f64 = 8.0;

/// Halvings of a frame: 2⁻⁴⁰ is below `SHORTEST` of the frame loop.
const MOST_HALVINGS: u32 = 41;

/// The pace of one frame.
#[derive(Clone, Debug)]
pub(super) enum Pace {
    /// Each substep by the error of the one before: the length to try next [s].
    Free(f64),
    /// Substeps of one length.
    Steady(Steady),
}

/// Substeps of one length, a power of two in a frame.
#[derive(Clone, Debug)]
pub(super) struct Steady {
    /// Length of the frame [s].
    frame: f64,
    /// The substep is the frame over 2^halvings.
    halvings: u32,
    /// Substeps of this length that are done.
    done: u64,
    /// The longest substep that is allowed [s]; it may be longer than the frame.
    pub(super) allowed: f64,
    /// The longest substep that the method allowed last [s].
    longest: f64,
    pub(super) memory: SteadyMemory,
}

impl Steady {
    /// At the start of a frame, with substeps of no more than `allowed` [s].
    pub(super) fn new(frame: f64, allowed: f64, memory: SteadyMemory) -> Self {
        let mut steady = Steady { frame, halvings: 0, done: 0, allowed, longest: f64::INFINITY, memory };
        steady.fit(allowed);
        steady
    }

    /// The length of the next substep [s], at most `longest`, and the part of the frame that is then done [s].
    pub(super) fn propose(&mut self, longest: f64) -> (f64, f64) {
        self.longest = longest;
        if self.length() > longest {
            self.note_too_long();
            self.fit(longest);
            self.allowed = self.length();
        }
        (self.length(), self.frame * ((self.done + 1) as f64 * self.part()))
    }

    /// Halves the substep for good. Returns its length [s].
    pub(super) fn shorten(&mut self) -> f64 {
        self.note_too_long();
        self.halve();
        self.allowed = self.length();
        self.allowed
    }

    /// Goes on to the next substep; doubles its length after a long calm. `error` and `tolerance` are those of the
    /// substep that was accepted.
    pub(super) fn accept(&mut self, error: f64, tolerance: f64) {
        self.done += 1;
        let double = 2.0 * self.length();
        // A third of what would be accepted, so that the next fluctuation does not reject the longer substep.
        let is_calm = DOUBLED * error <= tolerance && double <= self.longest;
        self.memory.calm = if is_calm { self.memory.calm + 1 } else { 0 };
        // An error that does not fall with the length, as where an expression loses its value, ends the frame by the
        // number of its substeps.
        if error > tolerance && self.halvings < MOST_HALVINGS {
            self.shorten();
            return;
        }
        let is_aligned = self.halvings == 0 || self.done.is_multiple_of(2);
        if is_aligned && double > self.allowed && self.memory.calm >= self.calm_needed(double) {
            self.memory.calm = 0;
            self.allowed = double;
            if self.halvings > 0 {
                self.halvings -= 1;
                self.done /= 2;
            }
        }
    }

    fn part(&self) -> f64 {
        1.0 / (1_u64 << self.halvings) as f64
    }

    fn length(&self) -> f64 {
        self.frame * self.part()
    }

    fn halve(&mut self) {
        self.halvings += 1;
        self.done *= 2;
    }

    /// Halves the substep until it is no longer than `longest`.
    fn fit(&mut self, longest: f64) {
        while self.length() > longest && self.halvings < MOST_HALVINGS {
            self.halve();
        }
    }

    fn note_too_long(&mut self) {
        self.memory.calm = 0;
        let exponent = libm::ilogb(self.length());
        match self.memory.too_long.iter_mut().find(|(known, _)| *known == exponent) {
            Some((_, times)) => *times += 1,
            None => self.memory.too_long.push((exponent, 1)),
        }
    }

    /// Calm substeps that a length takes to be tried [s].
    fn calm_needed(&self, length: f64) -> u64 {
        let exponent = libm::ilogb(length);
        let times = self.memory.too_long.iter().find(|(known, _)| *known == exponent).map_or(0, |(_, times)| *times);
        CALM << times.saturating_sub(1).min(40)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goes through one frame with substeps of the same error; returns their lengths.
    fn run(steady: &mut Steady, error: f64) -> Vec<f64> {
        let (mut lengths, mut done) = (Vec::new(), 0.0);
        while done < steady.frame {
            let (length, end) = steady.propose(f64::INFINITY);
            assert!((done + length - end).abs() < 1e-12 * steady.frame, "substeps follow each other");
            (_, done) = (lengths.push(length), end);
            steady.accept(error, 1.0);
        }
        assert_eq!(done, steady.frame, "the last substep ends with the frame");
        lengths
    }

    fn next(steady: Steady, frame: f64) -> Steady {
        Steady::new(frame, steady.allowed, steady.memory)
    }

    #[test]
    fn a_rejected_substep_stays_short() {
        let mut steady = Steady::new(0.1, f64::INFINITY, SteadyMemory::default());
        steady.propose(f64::INFINITY);
        steady.shorten();
        for _ in 0..1000 {
            assert_eq!(run(&mut steady, 0.2), [0.05, 0.05]);
            steady = next(steady, 0.1);
        }
        // Frames of another length get substeps that are no longer, and do not shorten those that follow.
        for _ in 0..100 {
            let mut odd = next(steady, 0.07);
            assert_eq!(run(&mut odd, 0.2), [0.035, 0.035]);
            steady = next(odd, 0.1);
            assert_eq!(run(&mut steady, 0.2), [0.05, 0.05]);
        }
    }

    #[test]
    fn each_failure_doubles_the_calm_that_a_length_needs() {
        let mut steady = Steady::new(1.0, f64::INFINITY, SteadyMemory::default());
        let mut waited = Vec::new();
        for _ in 0..4 {
            steady.propose(f64::INFINITY);
            steady.shorten();
            let mut frames = 0;
            while steady.allowed < 1.0 {
                run(&mut steady, 0.01);
                steady = next(steady, 1.0);
                frames += 1;
            }
            waited.push(frames);
        }
        // Two substeps a frame: 128 calm ones for the first time are 64 frames.
        assert_eq!(waited, [64, 128, 256, 512]);
    }

    #[test]
    fn a_bound_of_the_method_is_kept() {
        let mut steady = Steady::new(1.0, f64::INFINITY, SteadyMemory::default());
        let (length, end) = steady.propose(0.3);
        assert_eq!((length, end), (0.25, 0.25));
        assert_eq!(steady.allowed, 0.25);
        // A bound that no length meets does not go on for ever.
        assert!(steady.propose(0.0).0 > 0.0);
    }
}

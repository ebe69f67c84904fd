//! Embedded Runge–Kutta pairs: substeps by the estimated error, each projected onto the constraints.

use super::acceptance::{BALANCE, Refusal, accepts_move};
use super::crossing::crossing;
use super::{Attempt, Outcome, Stepper, accepts};
use crate::chains::Projected;
use crate::drift::Drift;
use crate::integrate::field::Field;
use crate::integrate::runge_kutta::{Combination, Squares, Stages, Tableau, advance};
use crate::linalg::eight::{Largest, vector_unit};
use crate::number::larger;
use crate::settings::Settings;
use crate::state::State;
use crate::system::System;

/// Part of the extent of the system below which the way of the fastest particle in one h counts as rest. A way in one
/// substep would stand for another speed at each length: where substeps shrink, as at a force that jumps, every error
/// would pass.
const AT_REST: f64 = 1e-3;

/// Order from which on a pair crosses singular positions. Stages leave C = 0 by their own error, and the force that
/// takes that up grows with the third power of 1/σ: the stages of `dopri5` are of too low an order, so that shorter
/// substeps are no better there. One of 2000 random frameworks lost 13 % of its energy.
const CROSSES: u32 = 7;

/// Factor on the error estimate, which is a mean over all coordinates, while a large error may be in a few. With this
/// factor and a tolerance of 1e-4, `dop853` leaves energy errors of 2e-7 to 5e-5 after 2 s of chains of 100 and 1000
/// links. At a tolerance of 1e-3 its substeps run against the bound of stability: a chain of 1000 links takes
/// 1588 of them in place of 830 (`benches/results/workloads.csv`).
pub(crate) const ERROR_SCALE: f64 = 4.0;

/// The speed to which errors of velocities are relative [m/s]: that of the fastest particle, `fastest`, and at least
/// that of a way of `AT_REST` extents in a time of `long` \[s\].
pub(crate) fn reference_speed(system: &System, fastest: f64, long: f64) -> f64 {
    // A system at rest to roundoff has no speed to compare with.
    fastest.max(AT_REST * system.extent / long)
}

/// The norm of the error estimate: the root mean square over all coordinates, of positions relative to the extent or of
/// velocities relative to `speed`, whichever is larger. `squares` is Σ |Δ|² of positions and of velocities.
pub(crate) fn norm(system: &System, squares: [f64; 2], speed: f64) -> f64 {
    let coordinates = system.coordinate_count().max(1) as f64;
    let [q, qd] = squares.map(|sum| (sum / coordinates).sqrt());
    larger(q / system.extent, qd / speed)
}

/// A method with an error estimate.
#[derive(Debug)]
pub(crate) struct Pair {
    order: u32,
    tableau: Tableau,
    estimate: Combination,
    /// A second, coarser estimate, or the same: together |e|²/√(|e|² + 0.01 |e_coarse|²).
    coarse: Option<Combination>,
}

impl Pair {
    /// Number of solves of the equation in one substep.
    pub(crate) fn stages(&self) -> usize {
        self.tableau.stages
    }

    #[cfg(test)]
    pub(crate) fn tableau(&self) -> &Tableau {
        &self.tableau
    }

    pub(crate) const fn new(order: u32, tableau: Tableau, estimate: &[f64], coarse: Option<&[f64]>) -> Self {
        let coarse = match coarse {
            Some(weights) => Some(tableau.combination(weights)),
            None => None,
        };
        let estimate = tableau.combination(estimate);
        Pair { order, tableau, estimate, coarse }
    }
}

/// A pair under way over one frame.
pub(crate) struct PairStepper<'a, F> {
    pub(super) pair: &'a Pair,
    pub(crate) field: F,
    pub(crate) system: &'a System,
    pub(crate) settings: &'a Settings,
    pub(crate) stages: &'a mut Stages,
    /// Whether a singular position is ahead that this pair cannot cross.
    pub(crate) gives_up: bool,
}

impl<F: Field> Stepper for PairStepper<'_, F> {
    fn estimate_order(&self) -> f64 {
        f64::from(self.pair.order)
    }

    fn longest(&mut self, _: &State) -> f64 {
        f64::INFINITY
    }

    fn across(&mut self, state: &State, h: f64, remaining: f64) -> Option<f64> {
        let time = self.field.time_to_singular(&self.stages.q, &self.stages.qd, state.t, h.min(remaining))?;
        let across = crossing(time, h, remaining, self.pair.tableau.middle());
        self.gives_up = across.is_some() && self.pair.order < CROSSES;
        across
    }

    fn attempt(&mut self, state: &State, h: f64, end: f64) -> Outcome {
        if self.gives_up {
            return Outcome::Singular;
        }
        let Some(work) = advance(&self.pair.tableau, &mut self.field, self.stages, state.t, h) else {
            return if self.stages.overflow() { Outcome::NotMet } else { Outcome::Singular };
        };
        let (error, imbalance) = (self.error(h), self.field.imbalance());
        if error.is_nan() && self.stages.overflow() {
            return Outcome::NotMet;
        }
        let mut attempt = Attempt { h, error, iterations: 0, dissipation: work.dissipation, drives: work.drives };
        if !accepts(error, self.settings) {
            return Outcome::Met(attempt);
        }
        if imbalance > BALANCE {
            return Outcome::Refused(Refusal::Balance);
        }
        self.stages.remember();
        let Stages { q, qd, next_q, next_qd, .. } = self.stages;
        match self.field.project(next_q, next_qd, end, self.settings) {
            Projected::Met(_) if self.field.passes_an_edge(q, qd, state.t, end) => Outcome::Refused(Refusal::Edge),
            // Velocities that were not projected near a singular position are projected beyond it.
            Projected::Met(_) if !self.field.is_unprojected() && !accepts_move(self.moved(h), self.settings) => {
                self.stages.recall();
                Outcome::Refused(Refusal::Jump)
            }
            Projected::Met(iterations) => {
                attempt.iterations = iterations;
                Outcome::Met(attempt)
            }
            Projected::NotMet => Outcome::NotMet,
            Projected::Singular => Outcome::Singular,
        }
    }

    fn keep(&mut self, state: &mut State, h: f64) -> Drift {
        self.stages.accept();
        self.field.follow(state.t + h, &mut state.feet);
        self.field.drift(&self.stages.q, &self.stages.qd)
    }

    fn turn_back(&mut self, _: &State) {
        self.field.turn_back();
    }

    fn end(&mut self, state: &mut State) {
        self.field.end(&self.stages.q, &self.stages.qd, state);
    }

    fn write_tried(&self, state: &mut State) {
        self.field.end(&self.stages.next_q, &self.stages.next_qd, state);
    }
}

impl<F: Field> PairStepper<'_, F> {
    /// Takes the motion of a state.
    pub(super) fn begin(&mut self, state: &State) {
        self.stages.resize(self.field.blocks());
        self.field.begin(state, &mut self.stages.q, &mut self.stages.qd);
    }

    /// The speed to which errors of velocities are relative [m/s]. Near a singular position accelerations of stages are
    /// good to no digit across the motion, so shorter substeps are no better: there the way in the substep counts.
    pub(crate) fn speed(&self, h: f64) -> f64 {
        let long = if self.field.is_near_singular() { h.min(self.settings.h) } else { self.settings.h };
        reference_speed(self.system, vector_unit().dispatch(Largest(&self.stages.next_qd)), long)
    }

    /// The way that the projection moved the motion, in the norm of the error estimate.
    fn moved(&self, h: f64) -> f64 {
        norm(self.system, self.stages.moved(&self.field), self.speed(h))
    }

    /// The error estimate: that of positions relative to the extent, or of velocities relative to the fastest,
    /// whichever is larger.
    fn error(&self, h: f64) -> f64 {
        let speed = self.speed(h);
        let coarse = self.pair.coarse.as_ref().unwrap_or(&self.pair.estimate);
        let coordinates = self.system.coordinate_count().max(1) as f64;
        let estimates = [&self.pair.estimate, coarse];
        let squares = Squares { estimates, field: &self.field, stages: self.stages, h };
        let squares = vector_unit().dispatch(squares);
        let [q, qd, coarse_q, coarse_qd] = squares.map(|sum| (sum / coordinates).sqrt());
        let mut largest = 0.0_f64;
        for (fine, coarse, scale) in [(q, coarse_q, self.system.extent), (qd, coarse_qd, speed)] {
            let is_plain = self.pair.coarse.is_none() || fine == 0.0;
            let estimate = if is_plain { fine } else { fine * fine / (fine * fine + 0.01 * coarse * coarse).sqrt() };
            largest = larger(largest, ERROR_SCALE * h * estimate / scale);
        }
        largest
    }
}

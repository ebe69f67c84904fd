//! Runs a scene and returns the expectations that do not hold; docs/scene-file.md describes each expectation.

use qhat::{Event, EventKind, Simulation};
use qhat_scene::{AtEnd, Axis, Expect, Scene, SpeedAtEnd};
use std::collections::BTreeSet;

/// Largest number of particles of a scene whose lengths are checked over a long run. A larger scene takes tens of
/// milliseconds a frame and runs for its own duration.
const MOST_FOR_LONG: usize = 2000;

/// Every expectation that fails, in words.
pub(crate) fn failures(scene: &Scene, long: f64) -> Vec<String> {
    let expect = scene.expect.clone().unwrap_or_default();
    let mut simulation = match scene.simulation() {
        Ok(simulation) => simulation,
        Err(error) => return vec![error.to_string()],
    };
    let mut failures = Vec::new();
    check_rank(&mut simulation, &expect, &mut failures);

    let holds = expect.max_relative_length_error.is_some() && simulation.system().particle_count() <= MOST_FOR_LONG;
    let end = if holds { scene.duration.max(long) } else { scene.duration };
    let frames = |duration: f64| (duration / scene.settings.h).round() as usize;
    let mut course = Course::default();
    course.note(&simulation, &expect);
    let mut length_error = 0.0_f64;
    let mut broken = Vec::new();
    let mut residual = residual_now(&mut simulation, &expect);
    for frame in 1..=frames(end) {
        match simulation.step() {
            Ok(report) => {
                length_error = length_error.max(report.max_relative_length_error);
                broken.extend(report.events.into_iter().filter(|event| event.kind == EventKind::Broke));
            }
            Err(error) => {
                failures.push(error.to_string());
                return failures;
            }
        }
        if frame <= frames(scene.duration) {
            course.note(&simulation, &expect);
            residual = residual.max(residual_now(&mut simulation, &expect));
        }
        if frame == frames(scene.duration) {
            check_energy(&simulation, &expect, &mut failures);
            check_tension(&mut simulation, &expect, &mut failures);
            check_end(&simulation, &expect, &mut failures);
            check_broken(&broken, &expect, &mut failures);
        }
    }
    if let Some(most) = expect.max_relative_length_error
        && length_error > most
    {
        failures.push(format!("a rod was off its length by {length_error:e}, expected at most {most:e}"));
    }
    if expect.max_residual.is_some_and(|most| residual > most) {
        failures
            .push(format!("a row was off by {residual:e} of its scale, expected at most {:?}", expect.max_residual));
    }
    course.check(&expect, &mut failures);
    failures
}

fn check_rank(simulation: &mut Simulation, expect: &Expect, failures: &mut Vec<String>) {
    let terms = simulation.terms();
    let Some(rank) = terms.rank else {
        if expect.degrees_of_freedom.is_some() || expect.redundant_rows.is_some() {
            failures.push("the rank of A is not known".into());
        }
        return;
    };
    let system = simulation.system();
    let free = system.particles().filter(|&particle| !system.is_fixed(particle)).count();
    let freedom = free * system.dimension() - rank;
    let redundant = terms.is_open.iter().filter(|is_open| !**is_open).count() - rank;
    for (name, expected, found) in [
        ("degrees of freedom", expect.degrees_of_freedom, freedom),
        ("redundant rows", expect.redundant_rows, redundant),
    ] {
        if expected.is_some_and(|expected| expected != found) {
            failures.push(format!("{found} {name}, expected {expected:?}"));
        }
    }
}

fn check_energy(simulation: &Simulation, expect: &Expect, failures: &mut Vec<String>) {
    let error = simulation.energy_error_max();
    if expect.energy_error.is_some_and(|most| error > most) {
        failures.push(format!("energy error {error:e}, expected at most {:?}", expect.energy_error));
    }
}

fn check_tension(simulation: &mut Simulation, expect: &Expect, failures: &mut Vec<String>) {
    let tension = simulation.tension();
    for expected in &expect.tension {
        let found = simulation.system().links().zip(&tension).find(|(link, _)| link.name == expected.rod);
        match found {
            Some((_, found)) if (found - expected.value).abs() <= expected.tolerance => {}
            Some((_, found)) => {
                failures.push(format!("tension {found} N in {}, expected {}", expected.rod, expected.value))
            }
            None => failures.push(format!("{} is no rod", expected.rod)),
        }
    }
}

fn check_end(simulation: &Simulation, expect: &Expect, failures: &mut Vec<String>) {
    for AtEnd { particle, axis, value, tolerance } in &expect.at_end {
        let found = coordinate(simulation, particle, *axis);
        if (found - value).abs() > *tolerance {
            failures.push(format!("{particle} ended at {found} m along {axis:?}, expected {value}"));
        }
    }
    for SpeedAtEnd { particle, value, tolerance } in &expect.speed_at_end {
        let d = simulation.system().dimension();
        let velocity = &simulation.state().velocities()[index(simulation, particle) * d..][..d];
        let found = velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        if (found - value).abs() > *tolerance {
            failures.push(format!("{particle} ended at {found} m/s, expected {value}"));
        }
    }
}

fn check_broken(broken: &[Event], expect: &Expect, failures: &mut Vec<String>) {
    let Some(expected) = &expect.broken else { return };
    let names = |list: &mut dyn Iterator<Item = &String>| list.cloned().collect::<BTreeSet<String>>();
    let found = names(&mut broken.iter().map(|event| &event.constraint));
    if found != names(&mut expected.iter()) {
        failures.push(format!("broken at the end: {found:?}, expected {expected:?}"));
    }
}

/// The largest |C| of the rigid rows at this frame, each relative to the scale of its row; 0 without an expectation
/// about it, because it costs a solve.
fn residual_now(simulation: &mut Simulation, expect: &Expect) -> f64 {
    if expect.max_residual.is_none() {
        return 0.0;
    }
    let residual = simulation.terms().residual;
    let system = simulation.system();
    let rigid = (0..residual.len()).filter(|&row| system.is_rigid(row));
    rigid.map(|row| residual[row].abs() / system.row_scales()[row]).fold(0.0, f64::max)
}

/// Least rise of the energy that counts as an error, relative to the largest exchange between T and V. Rods are held to
/// 1e-10 of their length, so a projection may lift a weight by that much. Ten times as much has another cause.
const RISE: f64 = 1e-9;

/// The watched coordinates, frame by frame.
#[derive(Default)]
struct Course {
    times: Vec<f64>,
    swing: Vec<f64>,
    motions: Vec<Vec<f64>>,
    /// T and V [J].
    energies: Vec<(f64, f64)>,
}

impl Course {
    fn note(&mut self, simulation: &Simulation, expect: &Expect) {
        self.times.push(simulation.state().time());
        if let Some(period) = &expect.period {
            self.swing.push(coordinate(simulation, &period.particle, period.axis) - period.level);
        }
        if expect.energy_never_rises {
            let energy = simulation.energy();
            self.energies.push((energy.kinetic, energy.potential));
        }
        self.motions.resize(expect.motion.len(), Vec::new());
        for (course, motion) in self.motions.iter_mut().zip(&expect.motion) {
            course.push(coordinate(simulation, &motion.particle, motion.axis));
        }
    }

    fn check(&self, expect: &Expect, failures: &mut Vec<String>) {
        if let Some(period) = &expect.period {
            match self.period() {
                Some(found) if (found / period.value - 1.0).abs() <= period.tolerance => {}
                found => failures.push(format!("period {found:?} s, expected {} s", period.value)),
            }
        }
        if let Some((rise, time)) = self.largest_rise().filter(|(rise, _)| *rise > RISE) {
            failures.push(format!("the energy rose by {rise:e} of its scale before t = {time} s"));
        }
        for (course, motion) in self.motions.iter().zip(&expect.motion) {
            let low = course.iter().copied().fold(f64::INFINITY, f64::min);
            let high = course.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let left = motion.within.is_some_and(|[least, most]| low < least || high > most);
            let short = motion.covers.is_some_and(|[least, most]| low > least || high < most);
            if left || short {
                failures.push(format!("{} went from {low} to {high} along {:?}", motion.particle, motion.axis));
            }
        }
    }

    /// The largest rise of T + V from one frame to the next, relative to the largest T or change of V, and its time.
    fn largest_rise(&self) -> Option<(f64, f64)> {
        let bounds = |part: fn(&(f64, f64)) -> f64| {
            let values = self.energies.iter().map(part);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
        };
        let (kinetic, potential) = (bounds(|energy| energy.0), bounds(|energy| energy.1));
        let scale = kinetic.1.max(potential.1 - potential.0).max(f64::MIN_POSITIVE);
        let rise = |pair: &[(f64, f64)]| ((pair[1].0 + pair[1].1) - (pair[0].0 + pair[0].1)) / scale;
        let rises = self.energies.windows(2).map(rise).zip(&self.times[1..]);
        rises.map(|(rise, &time)| (rise, time)).max_by(|(a, _), (b, _)| a.total_cmp(b))
    }

    /// Mean time between upward crossings of the level, each found on the line between two frames.
    fn period(&self) -> Option<f64> {
        let crossing = |k: usize| {
            let (before, after) = (self.swing[k - 1], self.swing[k]);
            let part = before / (before - after);
            (before < 0.0 && after >= 0.0).then(|| self.times[k - 1] + part * (self.times[k] - self.times[k - 1]))
        };
        let crossings: Vec<f64> = (1..self.swing.len()).filter_map(crossing).collect();
        match crossings.as_slice() {
            [first, .., last] => Some((last - first) / (crossings.len() - 1) as f64),
            _ => None,
        }
    }
}

fn coordinate(simulation: &Simulation, particle: &str, axis: Axis) -> f64 {
    simulation.state().positions()[index(simulation, particle) * simulation.system().dimension() + axis.index()]
}

fn index(simulation: &Simulation, particle: &str) -> usize {
    let mut names = simulation.system().particle_names().iter();
    names.position(|name| name == particle).expect("load checks the names")
}

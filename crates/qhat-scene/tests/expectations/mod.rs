//! Runs a scene and tells which of its expectations do not hold; what each means is in docs/scene-file.md.

use qhat::{ParticleId, Simulation};
use qhat_scene::{Axis, Expect, Scene};

/// Particles up to which lengths are held for long; a larger scene, at tens of milliseconds a frame, for its own duration.
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
    for frame in 1..=frames(end) {
        match simulation.step() {
            Ok(report) => length_error = length_error.max(report.max_relative_length_error),
            Err(error) => {
                failures.push(error.to_string());
                return failures;
            }
        }
        if frame <= frames(scene.duration) {
            course.note(&simulation, &expect);
        }
        if frame == frames(scene.duration) {
            check_energy(&simulation, &expect, &mut failures);
            check_tension(&mut simulation, &expect, &mut failures);
        }
    }
    if let Some(most) = expect.max_relative_length_error
        && length_error > most
    {
        failures.push(format!("a rod was off its length by {length_error:e}, expected at most {most:e}"));
    }
    course.check(&expect, &mut failures);
    failures
}

fn check_rank(simulation: &mut Simulation, expect: &Expect, failures: &mut Vec<String>) {
    let Some(rank) = simulation.terms().rank else {
        if expect.degrees_of_freedom.is_some() || expect.redundant_rows.is_some() {
            failures.push("the rank of A is not known".into());
        }
        return;
    };
    let system = simulation.system();
    let free = (0..system.particle_count()).filter(|&i| !system.is_fixed(ParticleId(i))).count();
    let freedom = free * system.dimension() - rank;
    let redundant = system.row_count() - rank;
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
        let found = simulation.system().rods().zip(&tension).find(|(rod, _)| rod.name == expected.rod);
        match found {
            Some((_, found)) if (found - expected.value).abs() <= expected.tolerance => {}
            Some((_, found)) => {
                failures.push(format!("tension {found} N in {}, expected {}", expected.rod, expected.value))
            }
            None => failures.push(format!("{} is no rod", expected.rod)),
        }
    }
}

/// Where the watched coordinates were, frame by frame.
#[derive(Default)]
struct Course {
    times: Vec<f64>,
    swing: Vec<f64>,
    motions: Vec<Vec<f64>>,
}

impl Course {
    fn note(&mut self, simulation: &Simulation, expect: &Expect) {
        self.times.push(simulation.state().time());
        if let Some(period) = &expect.period {
            self.swing.push(coordinate(simulation, &period.particle, period.axis) - period.level);
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
    let system = simulation.system();
    let index = system.particle_names().iter().position(|name| name == particle).expect("load checks the names");
    simulation.state().positions()[index * system.dimension() + axis.index()]
}

//! qhat's answer beside the reference's: what is compared, and how far the two may differ.

use crate::dense::{largest, norm};
use crate::framework::Framework;
use crate::motion::{Moment, advance};
use crate::random::Random;
use crate::reference::Reference;
use crate::write::format_of;
use qhat::{Integrator, Settings, Simulation};
use qhat_scene::Format;

/// The relative error of q̈ and Q̂ at the start that needs no reason \[1\].
const FORCES: f64 = 1e-9;
/// Roundoff of a solve for each square of the condition of B \[1\]: qhat solves A = B Bᵀ, whose condition is that of B
/// squared, in numbers of 1.1e-16, and refines.
const ROUNDOFF: f64 = 1e-14;
/// The relative error of positions and velocities after the motion \[1\]: qhat is asked for 1e-10 a substep, and takes
/// thousands of substeps where a light particle swings on a stiff spring.
const MOTION: f64 = 1e-6;
/// The relative error that a constraint may keep \[1\]; the default of qhat is 1e-10 of the scale of its row.
const RESIDUAL: f64 = 1e-9;
/// The same of a joint that rods hold to second order only \[1\]: a residual of 1e-10 lets it aside by its root.
const SECOND_ORDER: f64 = 3e-5;
/// The perturbation of the velocities by which the growth of errors is measured \[1\].
const PERTURBATION: f64 = 1e-7;
/// The growth of a perturbation above which a motion says nothing about qhat \[1\].
const CHAOS: f64 = 1e3;

/// A number in which qhat and the reference differ.
#[derive(Clone, Debug)]
pub struct Finding {
    /// What was compared.
    pub what: String,
    /// qhat's number, or its error.
    pub qhat: String,
    /// The reference's number.
    pub reference: String,
    /// The difference, relative to the size of what was compared \[1\].
    pub off: f64,
    /// How far they may differ \[1\].
    pub allowed: f64,
}

/// The outcome of one seed.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// The differences that are too large; none if qhat and the reference agree.
    pub findings: Vec<Finding>,
    /// What was not compared, and why.
    pub skipped: Option<&'static str>,
    /// The largest difference relative to what is allowed, of everything compared \[1\].
    pub worst: f64,
}

impl Verdict {
    fn differ(&mut self, what: &str, qhat: impl ToString, reference: impl ToString) {
        let (qhat, reference) = (qhat.to_string(), reference.to_string());
        self.findings.push(Finding { what: what.to_owned(), qhat, reference, off: f64::INFINITY, allowed: 0.0 });
        self.worst = f64::INFINITY;
    }

    /// Compares two lists of numbers, relative to a size.
    fn compare(&mut self, what: &str, ours: &[f64], reference: &[f64], size: f64, allowed: f64) {
        let difference: Vec<f64> = ours.iter().zip(reference).map(|(a, b)| a - b).collect();
        let off = largest(&difference) / size.max(f64::MIN_POSITIVE);
        // A difference that is no number is the worst of all.
        let share = if off.is_nan() { f64::INFINITY } else { off / allowed };
        self.worst = self.worst.max(share);
        if off <= allowed {
            return;
        }
        let worst = |i: &usize| difference[*i].is_nan() || difference[*i].abs() == largest(&difference);
        let place = (0..difference.len()).find(worst).unwrap_or(0);
        self.findings.push(Finding {
            what: format!("{what}, number {place}"),
            qhat: format!("{:e}", ours[place]),
            reference: format!("{:e}", reference[place]),
            off,
            allowed,
        });
    }
}

/// What stands between the text of a scene and the numbers that are compared; a test of this test puts a fault here.
pub type Reader<'a> = &'a dyn Fn(&str, Format) -> Result<qhat_scene::Scene, String>;

/// Reads a scene as everybody does.
///
/// # Errors
/// The errors of the reader, as text.
pub fn read(text: &str, format: Format) -> Result<qhat_scene::Scene, String> {
    qhat_scene::load(text, "seed", format).map_err(|errors| errors.to_string())
}

/// Compares qhat with the reference on one framework.
pub fn compare(framework: &Framework, reader: Reader<'_>) -> Verdict {
    let mut verdict = Verdict::default();
    let Some(reference) = Reference::new(framework) else {
        verdict.skipped = Some("the rank at the start is not certain");
        return verdict;
    };
    let format = format_of(framework.seed);
    let scene = match reader(&framework.text(format), format) {
        Ok(scene) => scene,
        Err(errors) => {
            verdict.differ("the scene", errors, "valid");
            return verdict;
        }
    };
    let mut simulation = match scene.simulation() {
        Ok(simulation) => simulation,
        Err(error) => {
            verdict.differ("the start", error, "satisfies every constraint");
            return verdict;
        }
    };
    let (q, qd) = (framework.positions(), framework.velocities());
    let extent = largest(&q).max(0.1);
    let speed = largest(&qd).max(1e-3);
    verdict.compare("positions at the start", simulation.state().positions(), &q, extent, 1e-9);
    verdict.compare("velocities at the start", simulation.state().velocities(), &qd, speed, 1e-8);
    if !verdict.findings.is_empty() {
        return verdict;
    }
    if !framework.second_order {
        forces(&reference, &mut simulation, &mut verdict);
    }
    motion(framework, &reference, &mut simulation, &mut verdict);
    verdict
}

/// q̈, Q̂ and Q where the simulation is now.
fn forces(reference: &Reference, simulation: &mut Simulation, verdict: &mut Verdict) {
    let mut terms = simulation.terms();
    let d = terms.positions.len() / terms.inverse_masses.len();
    // What acts on a fixed particle moves nothing, and the reference leaves it out.
    for place in (0..terms.positions.len()).filter(|place| terms.inverse_masses[place / d] == 0.0) {
        (terms.applied_forces[place], terms.constraint_forces[place]) = (0.0, 0.0);
    }
    let evaluation = reference.evaluate(&terms.positions, &terms.velocities, terms.time);
    let applied = largest(&evaluation.applied_forces).max(largest(&evaluation.constraint_forces));
    verdict.compare("Q", &terms.applied_forces, &evaluation.applied_forces, applied, 1e-11);
    // Forces of stiff springs are differences of large numbers, and both sides round them.
    let rounded = evaluation.force_roundoff / applied.max(f64::MIN_POSITIVE);
    let allowed = (FORCES + ROUNDOFF * evaluation.condition * evaluation.condition + rounded).min(1e-2);
    // A framework in balance has forces without accelerations: its q̈ is roundoff of forces over the least mass.
    let size = largest(&evaluation.constraint_forces).max(applied);
    verdict.compare("Q̂ at the start", &terms.constraint_forces, &evaluation.constraint_forces, size, allowed);
    let masses = &terms.inverse_masses;
    let weight =
        |forces: &[f64]| forces.iter().enumerate().map(|(i, force)| (force * masses[i / d]).abs()).fold(0.0, f64::max);
    let size = largest(&evaluation.accelerations).max(weight(&evaluation.applied_forces));
    verdict.compare("q̈ at the start", &terms.accelerations, &evaluation.accelerations, size, allowed);
}

/// Positions, velocities, residuals and energies after the motion.
fn motion(framework: &Framework, reference: &Reference, simulation: &mut Simulation, verdict: &mut Verdict) {
    let mut random = Random::new(framework.seed ^ 0xd1ff);
    let start = Moment { q: framework.positions(), qd: framework.velocities(), t: 0.0 };
    let Some(end) = advance(reference, &start, framework.duration) else {
        verdict.skipped = Some("the motion is too fast for the reference");
        return;
    };
    // How fast errors grow: the same motion from velocities that differ a little.
    let speed = largest(&start.qd).max(largest(&end.qd)).max(1e-2);
    let mut other = start.clone();
    for velocity in &mut other.qd {
        *velocity += PERTURBATION * speed * random.between(-1.0, 1.0);
    }
    reference.project_velocities(&start.q, &mut other.qd, 0.0);
    let moved = |a: &[f64], b: &[f64]| norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>());
    let before = moved(&other.qd, &start.qd).max(1e-3 * PERTURBATION * speed);
    let Some(perturbed) = advance(reference, &other, framework.duration) else {
        verdict.skipped = Some("the motion is too fast for the reference");
        return;
    };
    let growth = (moved(&perturbed.qd, &end.qd) / before).max(1.0);
    if growth > CHAOS {
        verdict.skipped = Some("the motion is chaotic");
        return;
    }
    let extent = largest(&end.q).max(0.1);
    let sizes = [extent, speed];
    let energies = [reference.energies(&start.q, &start.qd, 0.0), reference.energies(&end.q, &end.qd, end.t)];
    let kinetic = energies[0][0].max(energies[1][0]);

    let before = simulation.energy();
    if !run(simulation, framework.duration, verdict) {
        return;
    }
    let least = if framework.second_order { SECOND_ORDER } else { 0.0 };
    let allowed = (MOTION * growth).max(least);
    let kept = RESIDUAL.max(least);
    after(reference, simulation, &end, sizes, [kept, allowed], verdict);
    let after = simulation.energy();
    let size = kinetic.max((energies[1][1] - energies[0][1]).abs()).max(1e-9);
    let kinds =
        [(after.kinetic, energies[1][0]), (after.potential - before.potential, energies[1][1] - energies[0][1])];
    for ((ours, theirs), what) in kinds.into_iter().zip(["T at the end", "V at the end less V at the start"]) {
        // Energies are of second degree, and a stiff spring multiplies a displacement.
        verdict.compare(what, &[ours], &[theirs], size, 100.0 * allowed);
    }

    // Another integrator, whose motion is less accurate and whose constraints hold as well.
    let (integrator, allowed) = *random.pick(&[
        (Integrator::Auto, 1e-4),
        (Integrator::Dopri5, 1e-4),
        (Integrator::Rattle, 1e-2),
        (Integrator::Implicit, f64::INFINITY),
        (Integrator::Bdf2, f64::INFINITY),
    ]);
    let tolerance = if integrator == Integrator::Rattle { 1e-6 } else { 1e-8 };
    let h = framework.duration / if integrator.is_implicit() { 20.0 } else { 4.0 };
    let settings = Settings { integrator, tolerance, h, ..*simulation.settings() };
    if let Err(error) = simulation.set_settings(settings).and_then(|()| simulation.reset()) {
        verdict.differ(&format!("the start with {integrator}"), error, "satisfies every constraint");
        return;
    }
    if run(simulation, framework.duration, verdict) {
        self::after(reference, simulation, &end, sizes, [kept, (allowed * growth).max(least)], verdict);
    }
}

/// Runs a simulation; false with a finding where it ends in an error.
fn run(simulation: &mut Simulation, duration: f64, verdict: &mut Verdict) -> bool {
    let settings = *simulation.settings();
    for _ in 0..(duration / settings.h).round() as usize {
        if let Err(error) = simulation.step() {
            verdict.differ(&format!("the run with {}", settings.integrator), error, "goes on");
            return false;
        }
    }
    true
}

/// The state at the end of a run.
fn after(
    reference: &Reference,
    simulation: &Simulation,
    end: &Moment,
    [extent, speed]: [f64; 2],
    [kept, allowed]: [f64; 2],
    verdict: &mut Verdict,
) {
    let integrator = simulation.settings().integrator;
    let state = simulation.state();
    let residuals = reference.residuals(state.positions(), state.time());
    let zeros = vec![0.0; residuals.len()];
    verdict.compare(&format!("C at the end with {integrator}"), &residuals, &zeros, extent, kept);
    verdict.compare(&format!("q at the end with {integrator}"), state.positions(), &end.q, extent, allowed);
    verdict.compare(&format!("q̇ at the end with {integrator}"), state.velocities(), &end.qd, speed, allowed);
}

//! The answer of qhat beside that of the reference: the numbers that are compared, and the bounds on their differences.

use crate::dense::{largest, norm};
use crate::framework::Framework;
use crate::motion::{Moment, advance};
use crate::random::Random;
use crate::reference::Reference;
use crate::write::format_of;
use qhat::{Integrator, Settings, Simulation};
use qhat_scene::Format;

// Each bound is relative, without a unit. In `qhat-differ seeds 0 2000` the largest difference was 0.29 of its bound,
// without the two shapes of `generate/singular.rs`.

/// The bound on positions at the start, of the extent: ten times the default tolerance of constraints, to which qhat
/// may move the start.
const START_POSITIONS: f64 = 1e-9;
/// The bound on velocities at the start, of the largest speed: that of positions times ten, because a position that is
/// off by δ turns a rod of length r, and the velocity with it, by δ/r.
const START_VELOCITIES: f64 = 1e-8;
/// The bound on Q, of the largest force: both sides evaluate the same formulas, so they differ by roundoff, 1e-16,
/// times the digits that cancel in the length of a stiff spring.
const APPLIED: f64 = 1e-11;
/// The bound on q̈ and Q̂ at the start where B = J M^(−1/2) has a condition of 1: a hundred times that on Q, because a
/// solve of many rows adds up their errors.
const FORCES: f64 = 1e-9;
/// The roundoff of a solve for each square of the condition of B: qhat solves A = B Bᵀ, whose condition is that of B
/// squared, in numbers of 1.1e-16. The rest is room for the number of rows.
const ROUNDOFF: f64 = 1e-14;
/// The largest bound on q̈ and Q̂, whatever the condition: a wrong formula is off by more.
const FORCES_MOST: f64 = 1e-2;
/// The bound on positions and velocities after the motion for each unit of growth: qhat is asked for 1e-10 a substep,
/// and takes thousands of substeps where a light particle swings on a stiff spring.
const MOTION: f64 = 1e-6;
/// The bound on T and V for each unit of that on positions: energies are of second degree, and a stiff spring
/// multiplies a displacement.
const ENERGIES: f64 = 100.0;
/// The bound on C after the motion, of the extent: ten times the default tolerance of qhat, which is measured by the
/// scale of each row instead.
const RESIDUAL: f64 = 1e-9;
/// The perturbation of the velocities by which the growth of errors is measured: far above the errors of the reference,
/// 1e-12, and small enough to grow in proportion.
const PERTURBATION: f64 = 1e-7;
/// The growth of a perturbation above which a motion says nothing about qhat: the bound on it would be above 1e-3.
const CHAOS: f64 = 1e3;

/// A number in which qhat and the reference differ.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The quantity that was compared.
    pub what: String,
    /// qhat's number, or its error.
    pub qhat: String,
    /// The reference's number.
    pub reference: String,
    /// The difference, relative to the size of the quantity \[1\].
    pub off: f64,
    /// The bound on the difference \[1\].
    pub allowed: f64,
}

/// The outcome of one seed.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// The differences that are too large; none if qhat and the reference agree.
    pub findings: Vec<Finding>,
    /// The reason why not all was compared, if so.
    pub skipped: Option<&'static str>,
    /// The largest difference as a part of its bound \[1\].
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

/// A function from the text of a scene to the scene. `tests/planted.rs` gives one that changes the text.
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
    // A framework at rest or near the origin has no size of its own: a millimetre a second, a tenth of a metre.
    let extent = largest(&q).max(0.1);
    let speed = largest(&qd).max(1e-3);
    verdict.compare("positions at the start", simulation.state().positions(), &q, extent, START_POSITIONS);
    verdict.compare("velocities at the start", simulation.state().velocities(), &qd, speed, START_VELOCITIES);
    if !verdict.findings.is_empty() {
        return verdict;
    }
    forces(&reference, &mut simulation, &mut verdict);
    motion(framework, &reference, &mut simulation, &mut verdict);
    verdict
}

/// q̈, Q̂ and Q where the simulation is now.
fn forces(reference: &Reference, simulation: &mut Simulation, verdict: &mut Verdict) {
    let mut terms = simulation.terms();
    let d = terms.positions.len() / terms.inverse_masses.len();
    // A force on a fixed particle moves nothing, and the reference leaves it out.
    for place in (0..terms.positions.len()).filter(|place| terms.inverse_masses[place / d] == 0.0) {
        (terms.applied_forces[place], terms.constraint_forces[place]) = (0.0, 0.0);
    }
    let evaluation = reference.evaluate(&terms.positions, &terms.velocities, terms.time);
    let applied = largest(&evaluation.applied_forces).max(largest(&evaluation.constraint_forces));
    verdict.compare("Q", &terms.applied_forces, &evaluation.applied_forces, applied, APPLIED);
    // Forces of stiff springs are differences of large numbers, and both sides round them.
    let rounded = evaluation.force_roundoff / applied.max(f64::MIN_POSITIVE);
    let allowed = (FORCES + ROUNDOFF * evaluation.condition * evaluation.condition + rounded).min(FORCES_MOST);
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
    // The growth of errors: the same motion from velocities that differ a little.
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
    let allowed = MOTION * growth;
    after(reference, simulation, &end, sizes, allowed, verdict);
    let after = simulation.energy();
    let size = kinetic.max((energies[1][1] - energies[0][1]).abs()).max(1e-9);
    let kinds =
        [(after.kinetic, energies[1][0]), (after.potential - before.potential, energies[1][1] - energies[0][1])];
    for ((ours, theirs), what) in kinds.into_iter().zip(["T at the end", "V at the end less V at the start"]) {
        verdict.compare(what, &[ours], &[theirs], size, ENERGIES * allowed);
    }

    // Another integrator, whose constraints hold as well. Its bound on the motion is 1e4 times its tolerance, as that
    // of dop853 is. `implicit` and `bdf2` take fixed steps, so their motion is not compared.
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
        self::after(reference, simulation, &end, sizes, allowed * growth, verdict);
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
    allowed: f64,
    verdict: &mut Verdict,
) {
    let integrator = simulation.settings().integrator;
    let state = simulation.state();
    let residuals = reference.residuals(state.positions(), state.time());
    let zeros = vec![0.0; residuals.len()];
    verdict.compare(&format!("C at the end with {integrator}"), &residuals, &zeros, extent, RESIDUAL);
    verdict.compare(&format!("q at the end with {integrator}"), state.positions(), &end.q, extent, allowed);
    verdict.compare(&format!("q̇ at the end with {integrator}"), state.velocities(), &end.qd, speed, allowed);
}

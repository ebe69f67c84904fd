//! Projection onto C(q, t) = 0 and Ċ = 0, in the mass metric.
//!
//! ```text
//! q ← q − W Jᵀ A⁻¹ C,  repeated until every |C| is within tolerance
//! q̇ ← q̇ − W Jᵀ A⁻¹ Ċ,  Ċ = J q̇ + C_t
//! ```
//!
//! Contacts that this violates, or lets approach, take part as `contact/nearest.rs` says.
//!
//! Newton's method, with the step halved while it does not bring the constraints nearer. It fails where no q satisfies
//! them, or where the start is too far away.

use super::Workspace;
use super::failure::{not_satisfied, unmet_rate};
use crate::contact::{NearestStart, TOUCH_DISTANCE};
use crate::drift::{attainable, worst_row};
use crate::error::StepError;
use crate::multiplier::Equation;
use crate::point::{Motion, block, dot, larger, largest};
use crate::report::Projection;
use crate::settings::Settings;
use crate::space::ParticleId;
use crate::state::State;
use crate::system::System;

/// Newton's method converges quadratically, in some five iterations; from far away it takes more.
const MAX_ITERATIONS: usize = 60;

/// Halvings of one Newton step.
const MAX_HALVINGS: usize = 12;

/// Part of the largest |Ċ| before a projection of velocities that it may leave: an A that is nearly singular leaves
/// 1e-6 of it.
const UNMET: f64 = 1e-3;

/// |Ċ|, relative to the speed of the fastest particle over the extent, that roundoff of an A that is nearly singular
/// may leave.
const ROUGH: f64 = 1e-6;

/// |Ċ|, relative to the speed of the fastest particle, below which it is roundoff.
const CONSISTENT_RATE: f64 = 1e-13;

/// Projects a state; a state that is consistent to tolerance does not move.
pub(super) fn project<const D: usize>(
    system: &System,
    state: &mut State,
    settings: &Settings,
    workspace: &mut Workspace,
) -> Result<Projection, StepError> {
    workspace.set_modes(system, state);
    let Workspace { equation, q, qd, .. } = workspace;
    q.copy_from_slice(&state.q);
    qd.copy_from_slice(&state.qd);
    let mut projector = Projector::<D> { system, settings, equation, t: state.t, q, qd };
    let (residual_before, mut iterations) = projector.positions()?;
    if !system.contacts.list.is_empty() {
        iterations += projector.contacts(state)?;
    }
    projector.velocities()?;
    if !system.contacts.list.is_empty() {
        projector.approaches(state)?;
    }
    let (moved, velocity_changed) = (farthest::<D>(q, &state.q), farthest::<D>(qd, &state.qd));
    let fastest = farthest::<D>(qd, &vec![0.0; qd.len()]);
    let report = Projection {
        moved,
        velocity_changed,
        is_moved: moved > settings.constraint_tolerance * system.extent,
        is_turned: velocity_changed > settings.tolerance * fastest,
        residual_before,
        iterations,
    };
    if report.moved > 0.0 || report.velocity_changed > 0.0 {
        state.q.copy_from_slice(q);
        state.qd.copy_from_slice(qd);
        state.carry = None;
    }
    let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
    workspace.equation.follow_feet(system, motion, &mut state.feet);
    Ok(report)
}

/// The equation that a Newton step solves.
#[derive(Clone, Copy)]
enum Step {
    /// J Δq = −C for rows that are independent of each other; the others follow.
    Independent,
    /// The least |J Δq + C|, rows scaled: where the rows contradict each other, all share what cannot be met.
    LeastSquares,
}

/// A motion on its way onto the constraints.
struct Projector<'a, const D: usize> {
    system: &'a System,
    settings: &'a Settings,
    equation: &'a mut Equation,
    t: f64,
    q: &'a mut [f64],
    qd: &'a mut [f64],
}

impl<const D: usize> Projector<'_, D> {
    /// Brings q onto C = 0; returns max |C| before and the number of iterations.
    fn positions(&mut self) -> Result<(f64, usize), StepError> {
        let system = self.system;
        self.constrain();
        let start = self.q.to_vec();
        let rigid = (0..system.row_count()).filter(|&row| system.softness[row].is_rigid());
        let before = rigid.fold(0.0, |most, row| larger(most, self.equation.rows.C[row].abs()));
        for step in [Step::Independent, Step::LeastSquares] {
            self.q.copy_from_slice(&start);
            self.constrain();
            if let Some(iterations) = self.newton(step) {
                return Ok((before, iterations));
            }
        }
        // The iteration goes on to half the tolerance, but what is within the tolerance is not off.
        if self.off() <= self.settings.constraint_tolerance {
            return Ok((before, MAX_ITERATIONS));
        }
        Err(not_satisfied(system, self.t, &self.equation.rows))
    }

    /// Newton's method on C = 0 from q; the number of its iterations if it gets there, else q is the nearest that it
    /// came to.
    fn newton(&mut self, step: Step) -> Option<usize> {
        let system = self.system;
        let mut delta = vec![0.0; system.all_row_count()];
        let (mut start, mut has_asked) = (self.q.to_vec(), false);
        for iteration in 0..MAX_ITERATIONS {
            let off = self.off();
            if self.is_met(off) {
                return Some(iteration);
            }
            match step {
                Step::Independent => self.equation.factor::<D>(system, 0.0),
                Step::LeastSquares => self.equation.factor_least_squares::<D>(system),
            }
            self.equation.solver.solve(&system.matrix, &self.equation.rows.C, &mut delta);
            let J = self.equation.rows.J.clone();
            start.copy_from_slice(self.q);
            let mut fraction = 1.0;
            for _ in 0..MAX_HALVINGS {
                self.q.copy_from_slice(&start);
                J.add_impulse::<D>(&system.inverse_mass, &delta, -fraction, self.q); // q − W Jᵀ A⁻¹ C
                self.constrain();
                if self.off() < off {
                    break;
                }
                fraction *= 0.5;
            }
            if self.off() >= off {
                let (worst, _) = worst_row(system, &self.equation.rows.C);
                if has_asked || !self.equation.follows(worst) {
                    break;
                }
                // The rows that were kept do not say what this one says.
                (self.equation.rank, has_asked) = (None, true);
            }
        }
        self.is_met(self.off()).then_some(MAX_ITERATIONS)
    }

    /// Where C = 0 violates a contact: brings q, from its start on, onto the nearest that satisfies the contacts, too.
    /// Returns the number of iterations.
    fn contacts(&mut self, state: &State) -> Result<usize, StepError> {
        let (mut nearest, q, qd) = self.nearest();
        if !nearest.is_violated::<D>(&state.modes, q, qd) {
            return Ok(0);
        }
        let deepest = nearest.deepest(&state.modes);
        let Ok(modes) = nearest.positions::<D>(&state.modes, &state.q, q, qd) else {
            let (row, residual) = deepest.unwrap_or_default();
            return Err(StepError::NotSatisfied { time: self.t, row: self.system.row_names[row].clone(), residual });
        };
        self.equation.set_modes(self.system, &modes);
        let (_, iterations) = self.positions()?;
        self.equation.set_modes(self.system, &state.modes);
        let (mut nearest, q, qd) = self.nearest();
        if nearest.is_violated::<D>(&state.modes, q, qd) {
            let deepest = nearest.deepest(&state.modes);
            return Err(self.violated(deepest.map_or(0, |(row, _)| row)));
        }
        Ok(iterations)
    }

    /// Where Ċ = 0 lets a touching contact approach: the nearest q̇, from that of the start on, that does not.
    fn approaches(&mut self, state: &State) -> Result<(), StepError> {
        let (mut nearest, q, qd) = self.nearest();
        if nearest.approaches::<D>(&state.modes, q, &state.qd, qd) {
            let outcome = nearest.velocities::<D>(&state.modes, q, &state.qd, qd);
            outcome.map_err(|failure| self.violated(self.system.contacts.list[failure.contact].normal))?;
            self.equation.set_modes(self.system, &state.modes);
        }
        Ok(())
    }

    /// The problem with contacts, and the motion on its way.
    fn nearest(&mut self) -> (NearestStart<'_>, &mut [f64], &mut [f64]) {
        let Projector { system, settings, equation, t, q, qd } = self;
        let tolerance = TOUCH_DISTANCE * settings.constraint_tolerance;
        (NearestStart { equation, system, t: *t, tolerance }, q, qd)
    }

    /// The error that names a row as it was evaluated last.
    fn violated(&self, row: usize) -> StepError {
        let residual = self.equation.rows.C[row];
        StepError::NotSatisfied { time: self.t, row: self.system.row_names[row].clone(), residual }
    }

    /// Takes Ċ out of q̇, unless it is roundoff.
    ///
    /// # Errors
    /// A row whose Ċ no velocities change: a drive of a fixed particle, or drives that contradict each other.
    fn velocities(&mut self) -> Result<(), StepError> {
        self.constrain();
        let Projector { system, equation, qd, .. } = self;
        let fastest = (0..system.particle_count()).map(|i| block::<D>(qd, ParticleId(i))).map(|v| dot(v, v));
        let fastest = fastest.fold(0.0, larger).sqrt();
        let rows = equation.rows.Cd.iter().zip(&system.row_scale);
        let rate = rows.map(|(Cd, scale)| Cd.abs() / scale).fold(0.0, larger);
        if rate * system.extent > CONSISTENT_RATE * fastest {
            equation.factor::<D>(system, 0.0);
            let mut nu = vec![0.0; equation.rows.Cd.len()];
            equation.solver.solve(&system.matrix, &equation.rows.Cd, &mut nu);
            equation.rows.J.add_impulse::<D>(&system.inverse_mass, &nu, -1.0, qd); // q̇ − W Jᵀ A⁻¹ Ċ
            self.constrain();
            let allowed = (UNMET * rate).max(ROUGH * fastest / self.system.extent);
            return match unmet_rate(self.system, self.t, &self.equation.rows, allowed) {
                Some(error) => Err(error),
                None => Ok(()),
            };
        }
        Ok(())
    }

    fn constrain(&mut self) {
        let Projector { system, equation, t, q, qd, .. } = self;
        equation.constrain(system, Motion::<D> { q, qd, t: *t });
    }

    /// The largest |C| of the rigid rows, over the row's scale.
    fn off(&self) -> f64 {
        worst_row(self.system, &self.equation.rows.C).1
    }

    fn is_met(&self, off: f64) -> bool {
        off <= attainable(self.system, self.settings, largest(self.q))
    }
}

/// The largest distance between two blocks of D numbers.
fn farthest<const D: usize>(a: &[f64], b: &[f64]) -> f64 {
    let distances = a.chunks_exact(D).zip(b.chunks_exact(D));
    distances.map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()).fold(0.0, larger).sqrt()
}

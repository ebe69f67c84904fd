//! Projection onto C(q, t) = 0 and Ċ = 0, in the mass metric.
//!
//! ```text
//! q ← q − W Jᵀ A⁻¹ C,  repeated until every |C| is within tolerance
//! q̇ ← q̇ − W Jᵀ A⁻¹ Ċ,  Ċ = J q̇ + C_t
//! ```
//!
//! Newton's method with the step halved while it does not bring the constraints nearer. Fails where no q satisfies them, or
//! where the start is too far away.

use super::Workspace;
use crate::drift::{attainable, worst_row};
use crate::error::StepError;
use crate::multiplier::{Equation, SolveFor};
use crate::point::{Motion, block, dot};
use crate::report::Projection;
use crate::settings::Settings;
use crate::space::ParticleId;
use crate::state::State;
use crate::system::System;

/// Newton converges quadratically, in some five iterations; from far away it takes more.
const MAX_ITERATIONS: usize = 60;

/// Halvings of one Newton step.
const MAX_HALVINGS: usize = 12;

/// |Ċ| below this times the fastest particle's speed is roundoff, not inconsistency.
const CONSISTENT_RATE: f64 = 1e-13;

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
    let (residual_before, iterations) = positions::<D>(system, state.t, settings, equation, q, qd)?;
    velocities::<D>(system, state.t, equation, q, qd);
    let report = Projection {
        moved: farthest::<D>(q, &state.q),
        velocity_changed: farthest::<D>(qd, &state.qd),
        residual_before,
        iterations,
    };
    if report.moved > 0.0 || report.velocity_changed > 0.0 {
        state.q.copy_from_slice(q);
        state.qd.copy_from_slice(qd);
        state.carry = None;
    }
    Ok(report)
}

/// Brings q onto C = 0; returns max |C| before and the number of iterations.
fn positions<const D: usize>(
    system: &System,
    t: f64,
    settings: &Settings,
    equation: &mut Equation,
    q: &mut [f64],
    qd: &[f64],
) -> Result<(f64, usize), StepError> {
    equation.constrain(system, Motion::<D> { q, qd, t });
    let before = (0..equation.rows.C.len())
        .filter(|&row| system.softness[row].is_rigid())
        .fold(0.0, |most: f64, row| most.max(equation.rows.C[row].abs()));
    let mut delta = vec![0.0; equation.rows.C.len()];
    let mut start = q.to_vec();
    for iteration in 0..MAX_ITERATIONS {
        let off = worst_row(system, &equation.rows.C).1;
        if off <= attainable(system, settings, largest(q)) {
            return Ok((before, iteration));
        }
        equation.factor::<D>(system, 0.0);
        equation.solver.solve(&system.matrix, &equation.rows.C, SolveFor::Correction, &mut delta);
        let J = equation.rows.J.clone();
        start.copy_from_slice(q);
        let mut fraction = 1.0;
        for _ in 0..MAX_HALVINGS {
            q.copy_from_slice(&start);
            J.add_impulse::<D>(&system.inverse_mass, &delta, -fraction, q);
            equation.constrain(system, Motion::<D> { q, qd, t });
            if worst_row(system, &equation.rows.C).1 < off {
                break;
            }
            fraction *= 0.5;
        }
        if worst_row(system, &equation.rows.C).1 >= off {
            break;
        }
    }
    let (row, _) = worst_row(system, &equation.rows.C);
    let residual = equation.rows.C.get(row).copied().unwrap_or(0.0);
    if worst_row(system, &equation.rows.C).1 <= attainable(system, settings, largest(q)) {
        return Ok((before, MAX_ITERATIONS));
    }
    Err(StepError::NotSatisfied { time: t, row: system.row_names[row].clone(), residual })
}

/// Takes out of q̇ what would violate Ċ = 0; nothing if it is roundoff.
fn velocities<const D: usize>(system: &System, t: f64, equation: &mut Equation, q: &[f64], qd: &mut [f64]) {
    equation.constrain(system, Motion::<D> { q, qd, t });
    let fastest = (0..system.particle_count()).map(|i| block::<D>(qd, ParticleId(i))).map(|v| dot(v, v));
    let fastest = fastest.fold(0.0, f64::max).sqrt();
    let rows = equation.rows.Cd.iter().zip(&system.row_scale);
    let rate = rows.map(|(Cd, scale)| Cd.abs() / scale).fold(0.0, f64::max);
    if rate * system.extent > CONSISTENT_RATE * fastest {
        equation.factor::<D>(system, 0.0);
        let mut nu = vec![0.0; equation.rows.Cd.len()];
        equation.solver.solve(&system.matrix, &equation.rows.Cd, SolveFor::Force, &mut nu);
        equation.rows.J.add_impulse::<D>(&system.inverse_mass, &nu, -1.0, qd);
    }
}

/// max |x|.
pub(super) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn farthest<const D: usize>(a: &[f64], b: &[f64]) -> f64 {
    let distances = a.chunks_exact(D).zip(b.chunks_exact(D));
    distances.map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()).fold(0.0, f64::max).sqrt()
}

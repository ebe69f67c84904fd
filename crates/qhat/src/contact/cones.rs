//! What touches as one linear complementarity problem, for where pivoting on modes goes round in circles.
//!
//! With the rows of everything else eliminated, w = S λ + p over the rows of what touch_distance, S = A_TT − A_TB A_BB⁻¹ A_BT. The cone of
//! friction becomes a pyramid with edges e_k, so that λ_t = Σ β_k e_k, β ≥ 0:
//!
//! ```text
//! normal      w_n ≥ 0                   ⟂   λ_n ≥ 0
//! edge k      e_k·w_t + σ ≥ 0           ⟂   β_k ≥ 0
//! pyramid     μ λ_n − Σ β_k ≥ 0         ⟂   σ ≥ 0            σ: the speed of slip
//! ```
//!
//! What slips and may not stick has one unknown, λ_n, with λ_t = −μ λ_n d. From the answer the modes are read, and judged with the round
//! cone like any others. In the plane the pyramid is the cone; in space it has eight edges, the first along the slip.
//! Source: Stewart, Trinkle, An Implicit Time-Stepping Scheme for Rigid Body Dynamics with Coulomb Friction (1996).

use super::Touching;
use super::lemke::lemke;
use crate::modes::{Mode, Modes};
use crate::multiplier::{Equation, SolveFor};
use crate::system::System;

/// cos 45°.
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Forces below this part of the largest are none.
const ROUNDOFF: f64 = 1e-12;

/// Friction within this part of its limit is at it: x is good to some 1e-12.
const AT_LIMIT: f64 = 1e-10;

/// One unknown but σ, in the normal and up to two tangential rows of a contact: where its row of the problem looks, and what one of it
/// pushes.
struct Unknown {
    touching: usize,
    looks: [f64; 3],
    pushes: [f64; 3],
}

/// Modes for what touch_distance, from Lemke's method; `None` if that finds none. The right side is that in `equation.b.sum`, the rows must
/// have been evaluated.
pub(super) fn propose<const D: usize>(
    equation: &mut Equation,
    system: &System,
    modes: &Modes,
    touching: &[Touching],
) -> Option<Modes> {
    let contacts: Vec<_> = touching.iter().map(|touching| &system.contacts.list[touching.contact]).collect();
    let rows: Vec<usize> =
        contacts.iter().flat_map(|contact| std::iter::once(contact.normal).chain(contact.tangents.clone())).collect();
    let mut first = vec![0];
    contacts.iter().for_each(|contact| first.push(first[first.len() - 1] + 1 + contact.tangents.len()));
    let mut proposed = modes.clone();
    touching.iter().for_each(|touching| proposed.contacts[touching.contact] = Mode::Open);
    equation.set_modes(system, &proposed);
    equation.factor::<D>(system, 0.0);
    let p = parting::<D>(equation, system, &rows);
    let S: Vec<Vec<f64>> = rows.iter().map(|&row| compliance::<D>(equation, system, row, &rows)).collect();

    let mut unknowns = Vec::new();
    let mut slips = Vec::new();
    for (k, (contact, &Touching { slip, may_stick, .. })) in contacts.iter().zip(touching).enumerate() {
        let normal = |[a, b]: [f64; 2]| Unknown { touching: k, looks: [1.0, 0.0, 0.0], pushes: [1.0, a, b] };
        if let Some(d) = slip.filter(|_| !may_stick) {
            unknowns.push(normal(d.map(|d| -contact.friction * d)));
            continue;
        }
        unknowns.push(normal([0.0; 2]));
        let edges = edges(contact.tangents.len(), slip.unwrap_or([1.0, 0.0]));
        if !edges.is_empty() {
            slips.push((k, unknowns.len() - 1, unknowns.len()..unknowns.len() + edges.len()));
        }
        let along = |[a, b]: [f64; 2]| Unknown { touching: k, looks: [0.0, a, b], pushes: [0.0, a, b] };
        unknowns.extend(edges.into_iter().map(along));
    }
    // Rows and unknowns of a contact are scaled alike, to a unit diagonal of its normal: what is heavy counts as what is light.
    let scale = |k: usize| 1.0 / S[first[k]][first[k]].sqrt();
    let n = unknowns.len() + slips.len();
    let (mut M, mut q) = (vec![0.0; n * n], vec![0.0; n]);
    for (i, unknown) in unknowns.iter().enumerate() {
        let a = unknown.touching;
        for row in 0..first[a + 1] - first[a] {
            let looks = scale(a) * unknown.looks[row];
            q[i] += looks * p[first[a] + row];
            for (j, other) in unknowns.iter().enumerate() {
                let b = other.touching;
                let pushed = (0..first[b + 1] - first[b])
                    .map(|column| S[first[b] + column][first[a] + row] * other.pushes[column]);
                M[i * n + j] += looks * scale(b) * pushed.sum::<f64>();
            }
        }
    }
    for (s, (k, normal, edges)) in slips.iter().enumerate() {
        let sigma = unknowns.len() + s;
        M[sigma * n + normal] = contacts[*k].friction;
        for edge in edges.clone() {
            M[edge * n + sigma] = 1.0;
            M[sigma * n + edge] = -1.0;
        }
    }
    let x = lemke(&M, &q)?;

    let none = ROUNDOFF * x[..unknowns.len()].iter().fold(0.0_f64, |most, force| most.max(*force));
    for (unknown, _) in unknowns.iter().zip(&x).filter(|&(unknown, force)| unknown.looks[0] > 0.0 && *force > none) {
        let Touching { contact, slip, may_stick } = touching[unknown.touching];
        proposed.contacts[contact] = match slip.filter(|_| !may_stick) {
            Some(d) => Mode::Sliding(d),
            None if contacts[unknown.touching].tangents.is_empty() => Mode::Smooth,
            None => Mode::Sticking,
        };
    }
    // Friction at its limit follows the normal force, even where nothing slips: so the rows that are left are independent, where many
    // contacts hold what few would.
    for (k, normal, edges) in slips {
        let push = x[edges.clone()].iter().zip(&unknowns[edges.clone()]);
        let push =
            push.fold([0.0; 2], |[a, b], (force, edge)| [a + force * edge.pushes[1], b + force * edge.pushes[2]]);
        let limit = contacts[k].friction * x[normal];
        let is_at_limit = x[edges].iter().sum::<f64>() >= (1.0 - AT_LIMIT) * limit;
        let size = super::complementarity::size(push);
        let mode = &mut proposed.contacts[touching[k].contact];
        if mode.is_closed() && is_at_limit && size > 0.0 {
            *mode = Mode::Sliding(push.map(|component| -component / size));
        }
    }
    Some(proposed)
}

/// The edges of the pyramid: two in the plane, eight in space, the first along d.
fn edges(tangents: usize, [a, b]: [f64; 2]) -> Vec<[f64; 2]> {
    match tangents {
        0 => Vec::new(),
        1 => vec![[1.0, 0.0], [-1.0, 0.0]],
        _ => {
            let turned = [HALF * (a - b), HALF * (a + b)];
            let quarter = |[a, b]: [f64; 2]| [[a, b], [-b, a], [-a, -b], [b, -a]];
            [quarter([a, b]), quarter(turned)].concat()
        }
    }
}

/// p: w of rows with nothing that touches.
fn parting<const D: usize>(equation: &mut Equation, system: &System, rows: &[usize]) -> Vec<f64> {
    equation.solve_multipliers::<D>(system, SolveFor::Force);
    equation.write_push::<D>(system);
    rows.iter().map(|&row| equation.push_along::<D>(row) - equation.b.sum[row]).collect()
}

/// A column of S: what a push of 1 in one row does to others, while all that does not touch holds.
fn compliance<const D: usize>(equation: &mut Equation, system: &System, row: usize, rows: &[usize]) -> Vec<f64> {
    equation.lambda.fill(0.0);
    equation.lambda[row] = 1.0;
    equation.write_impulse::<D>(system);
    let target: Vec<f64> = (0..system.row_count()).map(|row| -equation.push_along::<D>(row)).collect();
    let Equation { solver, lambda, .. } = &mut *equation;
    solver.solve(&system.matrix, &target, SolveFor::Force, lambda);
    lambda[row] += 1.0;
    equation.write_impulse::<D>(system);
    rows.iter().map(|&row| equation.push_along::<D>(row)).collect()
}

//! The touching contacts as one linear complementarity problem, for problems on which pivoting on modes goes in
//! circles.
//!
//! With all other rows eliminated, w = S λ + p over the rows of touching contacts, S = A_TT − A_TB A_BB⁻¹ A_BT. The
//! cone of friction becomes a pyramid with edges e_i, so that λ_t = Σ β_i e_i, β ≥ 0:
//!
//! ```text
//! normal      w_n ≥ 0                   ⟂   λ_n ≥ 0
//! edge i      e_i·w_t + σ ≥ 0           ⟂   β_i ≥ 0
//! pyramid     μ λ_n − Σ β_i ≥ 0         ⟂   σ ≥ 0            σ: the speed of slip
//! ```
//!
//! A contact that slips and may not stick has one unknown, λ_n, with λ_t = −μ λ_n d. The modes are read from the
//! solution, and then judged with the round cone like any others. In the plane the pyramid is the cone; in space it
//! has eight edges, the first along the slip.
//!
//! Letters: T touching rows, B all other active rows, k a touching contact, i and j unknowns of the problem M x + q.
//! Source: Stewart, Trinkle, An Implicit Time-Stepping Scheme for Rigid Body Dynamics with Coulomb Friction (1996).

use super::Touching;
use super::complementarity::{size, w};
use super::lemke::lemke;
use crate::modes::{Mode, Modes};
use crate::multiplier::Equation;
use crate::system::System;

/// cos 45°.
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Part of the largest force below which a force counts as zero.
const ROUNDOFF: f64 = 1e-12;

/// Part of the largest diagonal of S below which the diagonal is roundoff. The largest masses that are told apart are
/// 1e12 of the smallest.
const IMMOVABLE: f64 = 1e-14;

/// Friction within this part of its limit counts as at it: x is good to some 1e-12.
const AT_LIMIT: f64 = 1e-10;

/// An unknown of the problem other than σ, in the normal and up to two tangential rows of a contact.
struct Unknown {
    /// k, the number of its contact among those that touch.
    k: usize,
    /// The combination of w that is complementary to it.
    tests: [f64; 3],
    /// λ for one unit of it.
    lambda: [f64; 3],
}

/// Modes for the touching contacts, from Lemke's method; `None` if it finds none. The right-hand side is that in
/// `equation.b.sum`, the rows must have been evaluated.
pub(super) fn propose<const D: usize>(
    equation: &mut Equation,
    system: &System,
    modes: &Modes,
    touching: &[Touching],
) -> Option<Modes> {
    let contacts: Vec<_> = touching.iter().map(|touching| &system.contacts.list[touching.contact]).collect();
    let rows: Vec<usize> =
        contacts.iter().flat_map(|contact| std::iter::once(contact.normal).chain(contact.tangents.clone())).collect();
    let mut first = vec![0]; // of each contact, its first row in S
    contacts.iter().for_each(|contact| first.push(first[first.len() - 1] + 1 + contact.tangents.len()));
    let mut proposed = modes.clone();
    touching.iter().for_each(|touching| proposed.contacts[touching.contact] = Mode::Open);
    equation.set_modes(system, &proposed);
    equation.factor::<D>(system, 0.0); // A_BB
    let p = separation::<D>(equation, system, &rows);
    let S: Vec<Vec<f64>> = rows.iter().map(|&row| compliance::<D>(equation, system, row, &rows)).collect();

    // The unknowns: λ_n of each contact, then its β_i; and the σ of each pyramid with the places of its λ_n and β_i.
    let mut unknowns = Vec::new();
    let mut pyramids = Vec::new();
    for (k, (contact, &Touching { slip, may_stick, is_rough, .. })) in contacts.iter().zip(touching).enumerate() {
        let normal = |[a, b]: [f64; 2]| Unknown { k, tests: [1.0, 0.0, 0.0], lambda: [1.0, a, b] };
        if let Some(d) = slip.filter(|_| !may_stick) {
            unknowns.push(normal(d.map(|d| -contact.friction * d))); // λ_t = −μ λ_n d
            continue;
        }
        unknowns.push(normal([0.0; 2]));
        let edges = edges(if is_rough { contact.tangents.len() } else { 0 }, slip.unwrap_or([1.0, 0.0]));
        if !edges.is_empty() {
            pyramids.push((k, unknowns.len() - 1, unknowns.len()..unknowns.len() + edges.len()));
        }
        let edge = |[a, b]: [f64; 2]| Unknown { k, tests: [0.0, a, b], lambda: [0.0, a, b] };
        unknowns.extend(edges.into_iter().map(edge));
    }
    // Every unknown and its row are scaled alike, to a unit diagonal of M. So a chain of beads that can only move as a
    // whole, with its load, counts as the beads do across the chain; and heavy contacts count as light.
    let in_S = |a: usize, row: usize, b: usize, column: usize| S[first[b] + column][first[a] + row];
    let product = |of: &[f64; 3], a: usize, with: &[f64; 3], b: usize| -> f64 {
        let rows = (0..first[a + 1] - first[a]).filter(|&row| of[row] != 0.0);
        rows.map(|row| {
            let columns = (0..first[b + 1] - first[b]).map(|column| in_S(a, row, b, column) * with[column]);
            of[row] * columns.sum::<f64>()
        })
        .sum()
    };
    let mut scale: Vec<f64> = unknowns.iter().map(|it| product(&it.tests, it.k, &it.tests, it.k)).collect();
    let largest = scale.iter().fold(f64::MIN_POSITIVE, |most, diagonal| most.max(*diagonal));
    // A contact that cannot move at all is left as it is.
    let unit = |diagonal: f64| 1.0 / if diagonal > IMMOVABLE * largest { diagonal } else { largest }.sqrt();
    scale.iter_mut().for_each(|diagonal| *diagonal = unit(*diagonal));
    let n = unknowns.len() + pyramids.len();
    let (mut M, mut q) = (vec![0.0; n * n], vec![0.0; n]);
    for (i, unknown) in unknowns.iter().enumerate() {
        let rows = unknown.tests.iter().zip(&p[first[unknown.k]..]);
        q[i] = scale[i] * rows.map(|(tests, p)| tests * p).sum::<f64>(); // q = tests · p
        for (j, other) in unknowns.iter().enumerate() {
            let S_lambda = product(&unknown.tests, unknown.k, &other.lambda, other.k);
            M[i * n + j] = scale[i] * scale[j] * S_lambda; // M = tests · S λ
        }
    }
    for (number, (k, normal, edges)) in pyramids.iter().enumerate() {
        let sigma = unknowns.len() + number;
        let of_sigma = 1.0 / scale[edges.start];
        M[sigma * n + normal] = of_sigma * scale[*normal] * contacts[*k].friction; // μ λ_n
        for edge in edges.clone() {
            M[edge * n + sigma] = of_sigma * scale[edge]; // e_i·w_t + σ
            M[sigma * n + edge] = -of_sigma * scale[edge]; // − Σ β_i
        }
    }
    let (mut x, w) = lemke(&M, &q)?;
    x.iter_mut().zip(&scale).for_each(|(x, scale)| *x *= scale); // λ_n and β_i; σ stays scaled

    // λ_n > 0: the contact is closed.
    let zero = ROUNDOFF * x[..unknowns.len()].iter().fold(0.0_f64, |most, force| most.max(*force));
    for (unknown, _) in unknowns.iter().zip(&x).filter(|&(unknown, force)| unknown.tests[0] > 0.0 && *force > zero) {
        let Touching { contact, slip, may_stick, .. } = touching[unknown.k];
        proposed.contacts[contact] = match slip.filter(|_| !may_stick) {
            Some(d) => Mode::sliding(d),
            None if !touching[unknown.k].is_rough => Mode::Smooth,
            None => Mode::Sticking,
        };
    }
    // Σ β_i = μ λ_n: friction at its limit follows the normal force, even where there is no slip. So the remaining
    // rows are independent where many contacts hold what few would.
    for (number, (k, normal, edges)) in pyramids.into_iter().enumerate() {
        let beta = x[edges.clone()].iter().zip(&unknowns[edges.clone()]);
        let lambda_t =
            beta.fold([0.0; 2], |[a, b], (beta, edge)| [a + beta * edge.lambda[1], b + beta * edge.lambda[2]]);
        let limit = contacts[k].friction * x[normal];
        let is_at_limit = w[unknowns.len() + number] == 0.0 || x[edges].iter().sum::<f64>() >= (1.0 - AT_LIMIT) * limit;
        let size = size(lambda_t);
        let mode = &mut proposed.contacts[touching[k].contact];
        if mode.is_closed() && is_at_limit && size > 0.0 {
            *mode = Mode::sliding(lambda_t.map(|component| -component / size));
        }
    }
    Some(proposed)
}

/// e_i: two in the plane, eight in space, the first along d.
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

/// p: w of rows while every touching contact is open.
fn separation<const D: usize>(equation: &mut Equation, system: &System, rows: &[usize]) -> Vec<f64> {
    equation.solve_multipliers::<D>(system);
    equation.write_W_JT_lambda_F::<D>(system);
    rows.iter().map(|&row| w::<D>(equation, row)).collect()
}

/// A column of S: J W Jᵀλ in the given rows for λ = 1 in one row, while all rows of B hold.
fn compliance<const D: usize>(equation: &mut Equation, system: &System, row: usize, rows: &[usize]) -> Vec<f64> {
    equation.answer_to_row::<D>(system, row);
    equation.write_W_JT_lambda::<D>(system);
    rows.iter().map(|&row| equation.J_W_JT_lambda::<D>(row)).collect()
}

//! The softness dictionary: one step of each foreign scheme, written out plainly in its own letters, is one step with
//! the canonical row, to rounding.
//!
//! The foreign schemes are run on the smallest system that has a row: one mass on a line, C = x, J = 1, γ = 0, A = w,
//! stepped velocity first. The two menus of the source are settings of the engine and are checked on its terms.

use crate::systems;
use crate::systems::dense::{assert_all_close, assert_close, multiply, solve};
use qhat::{Feedback, Integrator, Simulation, SoftRow, Terms};

/// A mass [kg] at x [m] with v [m/s] under a force Q [N], and a step h [s].
#[derive(Clone, Copy)]
struct Start {
    m: f64,
    x: f64,
    v: f64,
    Q: f64,
    h: f64,
}

const STARTS: [Start; 3] = [
    Start { m: 1.0, x: 0.03, v: -0.4, Q: -9.81, h: 1.0 / 60.0 },
    Start { m: 1e-3, x: -2.0, v: 7.0, Q: 0.25, h: 1e-3 },
    Start { m: 2e4, x: 1e-5, v: 0.0, Q: 3e5, h: 0.05 },
];

/// x and v after a step with the canonical row.
fn canonical(Start { m, x, v, Q, h }: Start, row: SoftRow) -> [f64; 2] {
    let w = 1.0 / m;
    let lambda = row.multiplier(w, 0.0, w * Q, x, v);
    let v = v + h * w * (Q + lambda);
    [x + h * v, v]
}

/// Both steps agree to a few roundings of the terms that were summed.
fn check(what: &str, start: Start, foreign: [f64; 2], row: SoftRow) {
    let Start { m, x, v, Q, h } = start;
    let speed = v.abs() + h * Q.abs() / m + x.abs() / h;
    let ours = canonical(start, row);
    assert_close(&format!("{what}: x"), ours[0], foreign[0], 16.0 * f64::EPSILON * (x.abs() + h * speed));
    assert_close(&format!("{what}: v"), ours[1], foreign[1], 16.0 * f64::EPSILON * speed);
}

/// J v' + CFM λ = −(ERP/h) C, λ a force over the step (ODE's user guide, "soft constraint").
#[test]
fn erp_and_cfm() {
    for start @ Start { m, x, v, Q, h } in STARTS {
        for (erp, cfm) in [(0.2, 1e-5), (0.8, 0.0), (1.0, 2.0)] {
            let lambda = (-erp / h * x - (v + h * Q / m)) / (h / m + cfm);
            let after = v + h / m * (Q + lambda);
            let row = SoftRow::from_erp_cfm(erp, cfm, h);
            check("ODE", start, [x + h * after, after], row);
            assert_close("compliance", row.compliance(), cfm * h / erp, 4.0 * f64::EPSILON * cfm * h / erp);
        }
    }
}

/// v' = v + h w (Q − k x' − c v'), x' = x + h v'.
#[test]
fn implicit_spring() {
    for start @ Start { m, x, v, Q, h } in STARTS {
        for (k, c) in [(100.0, 1.0), (1e6, 0.0), (0.0, 3.0), (2.0, 500.0)] {
            let after = (v + h / m * (Q - k * x)) / (1.0 + h / m * (c + h * k));
            let row = SoftRow::from_implicit_spring(k, c, h);
            check("spring", start, [x + h * after, after], row);
            if k > 0.0 {
                assert_close("compliance", row.compliance(), 1.0 / k, 4.0 * f64::EPSILON / k);
            }
        }
    }
}

/// Box2D 3's `b2MakeSoft` and one pass of its solver, without warm starting.
#[test]
fn hertz_and_damping_ratio() {
    for start @ Start { m, x, v, Q, h } in STARTS {
        for (hertz, zeta) in [(2.0, 0.7), (30.0, 1.0), (60.0, 0.0), (0.5, 10.0)] {
            let omega = 2.0 * std::f64::consts::PI * hertz;
            let a1 = 2.0 * zeta + h * omega;
            let a2 = h * omega * a1;
            let a3 = 1.0 / (1.0 + a2);
            let (bias_rate, mass_scale) = (omega / a1, a2 * a3);
            let free = v + h * Q / m;
            let impulse = -m * mass_scale * (free + bias_rate * x);
            let after = free + impulse / m;
            check("Box2D", start, [x + h * after, after], SoftRow::from_hertz(hertz, zeta, 1.0 / m, h));
        }
    }
}

/// x* = x + h v + h² w Q, Δλ = −C(x*)/(w + α/h²), x' = x* + w Δλ, v' = (x' − x)/h.
#[test]
fn xpbd_compliance() {
    for start @ Start { m, x, v, Q, h } in STARTS {
        for compliance in [0.0, 1e-6, 0.3] {
            let predicted = x + h * v + h * h * Q / m;
            let lambda = -predicted / (1.0 / m + compliance / (h * h));
            let after = predicted + lambda / m;
            let row = SoftRow::from_xpbd(compliance, h);
            check("XPBD", start, [after, (after - x) / h], row);
            assert_close("compliance", row.compliance(), compliance, 4.0 * f64::EPSILON * compliance);
        }
    }
}

/// The terms of a moving pendulum or double pendulum, off its constraints, under feedback.
fn terms(is_double: bool, feedback: Feedback) -> Terms {
    let (system, state) = if is_double { systems::double_pendulum() } else { systems::pendulum(0.7) };
    let stretched = state.positions().iter().map(|x| 1.01 * x).collect();
    let turning = state.positions().iter().enumerate().map(|(k, x)| if k < 2 { 0.0 } else { 0.3 - 0.7 * x }).collect();
    let state = state.with_motion(stretched, turning);
    let settings = systems::settings(Integrator::Euler, 0.01);
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    simulation.set_feedback(feedback).unwrap();
    simulation.terms()
}

/// γ, J W Q, C and Ċ of a row.
fn inputs(terms: &Terms, row: usize) -> [f64; 4] {
    [terms.acceleration_bias[row], -terms.rhs_forces[row], terms.residual[row], terms.residual_rate[row]]
}

#[test]
fn diagonal_drag() {
    let feedback = Feedback { ks: 40.0, kd: 6.0, diagonal_drag: 0.25, elasticity: 0.0 };
    let terms = terms(false, feedback);
    let row = SoftRow::from_diagonal_drag(feedback.diagonal_drag, feedback.ks, feedback.kd);
    let [gamma, JWQ, C, Cd] = inputs(&terms, 0);
    let lambda = row.multiplier(terms.constraint_matrix.get(0, 0), gamma, JWQ, C, Cd);
    assert_close("λ", terms.multipliers[0], lambda, 16.0 * f64::EPSILON * lambda.abs());
}

#[test]
fn elasticity() {
    let feedback = Feedback { ks: 40.0, kd: 6.0, diagonal_drag: 0.0, elasticity: 0.3 };
    let s = 1.0 - feedback.elasticity;
    // On a row of its own.
    let single = terms(false, feedback);
    let diagonal = single.constraint_matrix.get(0, 0);
    let row = SoftRow::from_elasticity(feedback.elasticity, diagonal, feedback.ks, feedback.kd);
    let [gamma, JWQ, C, Cd] = inputs(&single, 0);
    let applied = row.multiplier(diagonal, gamma, JWQ, C, Cd);
    assert_close("s λ", s * single.multipliers[0], applied, 16.0 * f64::EPSILON * applied.abs());

    // On coupled rows R = (1/s − 1) A, the full matrix, and C̈ = (1 − s) a₀ − s (ks C + kd Ċ).
    let double = terms(true, feedback);
    let A = double.constraint_matrix.to_dense();
    let softened = A.iter().map(|a| a + (1.0 / s - 1.0) * a).collect();
    let applied = solve(softened, double.right_hand_side.clone()).unwrap();
    let scaled: Vec<f64> = double.multipliers.iter().map(|lambda| s * lambda).collect();
    // Two solves of a matrix of condition 10: some tens of roundings.
    let size = applied.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert_all_close("s λ", &scaled, &applied, 64.0 * f64::EPSILON * size);
    let Jqdd = multiply(&double.jacobian.to_dense(), &double.accelerations);
    for row in 0..2 {
        let [gamma, JWQ, C, Cd] = inputs(&double, row);
        let Cdd = Jqdd[row] + gamma;
        let said = (1.0 - s) * (gamma + JWQ) - s * (feedback.ks * C + feedback.kd * Cd);
        assert_close("C̈", Cdd, said, 256.0 * f64::EPSILON * (gamma.abs() + JWQ.abs() + size));
    }
}

//! `classic.toml`, the set-up of the source, computed a second time: the source's equations in a dense textbook
//! implementation that shares only the numbers of the scene with the engine. Every frame must agree.
//!
//! ```text
//! nail      C = |x − p|²        dC/dx = 2 (x − p)                  dĊ/dx = 2 v
//! distance  C = |x_a − x_b|² − r²   dC/dx_a = 2 (x_a − x_b) = −dC/dx_b   dĊ/dx_a = 2 (v_a − v_b) = −dĊ/dx_b
//! (J W Jᵀ + ε I) λ = −J̇ q̇ − J W Q − ks C − kd Ċ,   Q̂ = s Jᵀ λ
//! q ← q + h q̇,   q̇ ← q̇ + h W (Q + Q̂)
//! ```

#![allow(non_snake_case, reason = "the letters of the equations keep their case")]

use qhat::{Constraint, DistanceForm, Force, Integrator, NailForm, System};

type Matrix = Vec<Vec<f64>>;

/// The numbers of the scene: two dimensions, and only the constraints and forces of the source.
struct Source<'a> {
    system: &'a System,
}

/// C, Ċ, J and J̇ of all constraints.
#[derive(Default)]
struct Rows {
    C: Vec<f64>,
    Cd: Vec<f64>,
    J: Matrix,
    Jd: Matrix,
}

impl Source<'_> {
    fn rows(&self, q: &[f64], qd: &[f64]) -> Rows {
        let mut rows = Rows::default();
        for named in self.system.constraints() {
            let (mut J, mut Jd) = (vec![0.0; q.len()], vec![0.0; q.len()]);
            let mut C = 0.0;
            for k in 0..2 {
                match &named.constraint {
                    Constraint::Nail(nail) => {
                        assert_eq!(nail.form, NailForm::Scalar, "the source's nail");
                        let i = 2 * nail.particle.index() + k;
                        C += (q[i] - nail.at[k]) * (q[i] - nail.at[k]);
                        J[i] = 2.0 * (q[i] - nail.at[k]);
                        Jd[i] = 2.0 * qd[i];
                    }
                    Constraint::Distance(rod) => {
                        assert_eq!(rod.form, DistanceForm::Squared, "the source's distance");
                        let (a, b) = (2 * rod.a.index() + k, 2 * rod.b.index() + k);
                        C += (q[a] - q[b]) * (q[a] - q[b]);
                        (J[a], J[b]) = (2.0 * (q[a] - q[b]), -2.0 * (q[a] - q[b]));
                        (Jd[a], Jd[b]) = (2.0 * (qd[a] - qd[b]), -2.0 * (qd[a] - qd[b]));
                    }
                    other => panic!("not the source's: {other:?}"),
                }
            }
            if let Constraint::Distance(rod) = &named.constraint {
                C -= rod.length * rod.length;
            }
            rows.C.push(C);
            rows.Cd.push(product(&J, qd));
            rows.J.push(J);
            rows.Jd.push(Jd);
        }
        rows
    }

    fn forces(&self, q: &[f64], qd: &[f64]) -> Vec<f64> {
        let mut Q = vec![0.0; q.len()];
        for force in self.system.forces() {
            match force {
                Force::Gravity(gravity) => {
                    for i in 0..q.len() {
                        Q[i] += self.system.masses()[i / 2] * gravity.acceleration[i % 2];
                    }
                }
                Force::Drag(drag) => {
                    for i in 0..q.len() {
                        Q[i] -= drag.coefficient * qd[i];
                    }
                }
                Force::Spring(spring) => {
                    let (a, b) = (2 * spring.a.index(), 2 * spring.b.index());
                    let L = [q[a] - q[b], q[a + 1] - q[b + 1]];
                    let Ld = [qd[a] - qd[b], qd[a + 1] - qd[b + 1]];
                    let length = product(&L, &L).sqrt();
                    let pull = -spring.stiffness * (length - spring.rest) - spring.damping * product(&Ld, &L) / length;
                    for k in 0..2 {
                        Q[a + k] += pull * L[k] / length;
                        Q[b + k] -= pull * L[k] / length;
                    }
                }
                other => panic!("the source has no {other:?}"),
            }
        }
        Q
    }

    /// q̈, and λ.
    fn solve(&self, q: &[f64], qd: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let feedback = self.system.feedback();
        let W = |i: usize| self.system.inverse_masses()[i / 2];
        let Q = self.forces(q, qd);
        let Rows { C, Cd, J, Jd } = self.rows(q, qd);
        let m = C.len();
        let mut A = vec![vec![0.0; m]; m];
        let mut b = vec![0.0; m];
        for i in 0..m {
            for j in 0..m {
                A[i][j] = (0..q.len()).map(|k| J[i][k] * W(k) * J[j][k]).sum();
            }
            A[i][i] += feedback.diagonal_drag;
            let JWQ: f64 = (0..q.len()).map(|k| J[i][k] * W(k) * Q[k]).sum();
            b[i] = -product(&Jd[i], qd) - JWQ - feedback.ks * C[i] - feedback.kd * Cd[i];
        }
        let lambda = eliminate(A, b);
        let s = 1.0 - feedback.elasticity;
        let Q_hat = |k: usize| s * (0..m).map(|i| J[i][k] * lambda[i]).sum::<f64>();
        ((0..q.len()).map(|k| W(k) * (Q[k] + Q_hat(k))).collect(), lambda)
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Gaussian elimination with partial pivoting.
fn eliminate(mut A: Matrix, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| A[i][k].abs().total_cmp(&A[j][k].abs())).unwrap();
        A.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = A[i][k] / A[k][k];
            for j in k..n {
                A[i][j] -= factor * A[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        b[k] = (b[k] - (k + 1..n).map(|j| A[k][j] * b[j]).sum::<f64>()) / A[k][k];
    }
    b
}

/// 300 frames. Each has a roundoff of 1e-16. A factor of 1e6 is allowed for the sensitivity of the motion, which is far
/// smaller.
const FRAMES: usize = 300;
const TOLERANCE: f64 = 1e-9;

#[test]
fn engine_agrees_with_a_textbook_implementation_of_the_source() {
    let scene = qhat_scene::shipped().iter().find(|shipped| shipped.name == "classic").unwrap().load().unwrap();
    assert_eq!(scene.settings.integrator, Integrator::Euler, "the source's integrator");
    let feedback = *scene.system.feedback();
    assert!(feedback.ks > 0.0 && feedback.kd > 0.0 && feedback.diagonal_drag > 0.0 && feedback.elasticity > 0.0);
    let springs = scene.system.forces().iter().filter(|force| matches!(force, Force::Spring(_))).count();
    assert!(springs > 0 && scene.system.forces().len() >= springs + 2, "gravity, damping and springs");

    let source = Source { system: &scene.system };
    let (mut q, mut qd) = (scene.state.positions().to_vec(), scene.state.velocities().to_vec());
    let start = q.clone();
    let mut simulation = scene.simulation().unwrap();
    let h = scene.settings.h;
    for frame in 0..FRAMES {
        let (qdd, lambda) = source.solve(&q, &qd);
        let terms = simulation.terms();
        // λ of a loose nail is large, because its row of A is little more than ε: the error is relative to the largest
        // λ.
        let size = lambda.iter().fold(1.0, |most: f64, l| most.max(l.abs()));
        near(&terms.multipliers, &lambda, TOLERANCE * size, "λ", frame);
        for k in 0..q.len() {
            q[k] += h * qd[k];
            qd[k] += h * qdd[k];
        }
        simulation.step().unwrap();
        near(simulation.state().positions(), &q, TOLERANCE, "q", frame);
        near(simulation.state().velocities(), &qd, TOLERANCE, "q̇", frame);
    }
    let moved = q.iter().zip(&start).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(moved > 0.05, "something must have happened: {moved}");
}

#[track_caller]
fn near(engine: &[f64], textbook: &[f64], tolerance: f64, what: &str, frame: usize) {
    assert_eq!(engine.len(), textbook.len());
    for (k, (e, t)) in engine.iter().zip(textbook).enumerate() {
        assert!((e - t).abs() <= tolerance, "frame {frame}, {what}[{k}]: engine {e:e}, textbook {t:e}");
    }
}

//! Identities between the symbols of one evaluation, for every system: W, A, b, λ, Q̂ and q̈ against the dense
//! equations, the feedback C̈ + kd Ċ + ks C = 0, and the two menus of the source, diagonal drag and elasticity.
//! Work, momentum and signs are in `reactions.rs`.

use crate::systems;
use crate::systems::dense::{assert_all_close, assert_close, dot, largest, multiply, multiply_transposed, sandwich};
use crate::systems::random::{Random, web};
use qhat::{Feedback, Integrator, Simulation, State, System, Terms, evaluate};

/// Random systems off their constraints, small and beyond the dense limit of 24 rows, in 2D and 3D.
fn webs() -> Vec<(System, State)> {
    let mut random = Random::new(1);
    let sizes = [3, 4, 6, 10, 16, 30, 45];
    [2, 3].into_iter().flat_map(|d| sizes.map(|n| (d, n))).map(|(d, n)| web(&mut random, d, n)).collect()
}

/// W as one number for each coordinate.
fn weights(system: &System) -> Vec<f64> {
    system.inverse_masses().iter().flat_map(|w| vec![*w; system.dimension()]).collect()
}

/// The same system with other feedback, set through `Simulation`.
fn terms_with(system: &System, state: &State, feedback: Feedback) -> Terms {
    let settings = systems::settings(Integrator::Euler, 0.01);
    let mut simulation = Simulation::new(system.clone(), state.clone(), settings).unwrap();
    simulation.set_feedback(feedback).unwrap();
    simulation.terms()
}

/// C̈ = J q̈ + γ.
fn acceleration_of_C(terms: &Terms) -> Vec<f64> {
    let Jqdd = multiply(&terms.jacobian.to_dense(), &terms.accelerations);
    Jqdd.iter().zip(&terms.acceleration_bias).map(|(a, b)| a + b).collect()
}

/// The roundoff that is allowed in C̈: 1e-13 of the largest of its terms |b|, |A| |λ| and |J| |q̈|, each with some
/// dozens of roundings.
fn roundoff(terms: &Terms) -> f64 {
    let absolute = |x: &[f64]| x.iter().map(|x| x.abs()).collect::<Vec<_>>();
    let Al = multiply(&absolute(&terms.constraint_matrix.to_dense()), &absolute(&terms.multipliers));
    let Jqdd = multiply(&absolute(&terms.jacobian.to_dense()), &absolute(&terms.accelerations));
    1e-13 * (largest(&terms.right_hand_side) + largest(&Al) + largest(&Jqdd))
}

#[test]
fn inverse_masses_are_one_over_mass_and_zero_where_fixed() {
    for (system, state) in webs() {
        let W = evaluate(&system, &state).inverse_masses;
        assert_eq!(W[0], 0.0, "the root is fixed");
        assert!(W[1..].iter().zip(&system.masses()[1..]).all(|(w, m)| *w == 1.0 / m));
    }
}

#[test]
fn constraint_matrix_is_J_W_Jt() {
    for (system, state) in webs() {
        let terms = evaluate(&system, &state);
        let (A, m) = (terms.constraint_matrix.to_dense(), system.row_count());
        let expected = sandwich(&terms.jacobian.to_dense(), &weights(&system));
        assert_all_close("A", &A, &expected, 1e-14 * largest(&expected)); // roundoff of sums of a few products
        for i in 0..m {
            for j in 0..m {
                assert_eq!(terms.constraint_matrix.get(i, j), A[i * m + j]);
                assert_eq!(A[i * m + j], A[j * m + i]);
            }
        }
        let x: Vec<f64> = (0..m).map(|i| (i as f64 * 0.7).fract() - 0.4).collect();
        let mut Ax = vec![0.0; m];
        terms.constraint_matrix.multiply(&x, &mut Ax);
        assert_all_close("A x", &Ax, &multiply(&A, &x), 1e-13 * largest(&A));
    }
}

#[test]
fn right_hand_side_is_the_sum_of_its_four_terms() {
    for (system, state) in webs() {
        let terms = evaluate(&system, &state);
        let Feedback { ks, kd, .. } = *system.feedback();
        let WQ: Vec<f64> = terms.applied_forces.iter().zip(weights(&system)).map(|(Q, w)| w * Q).collect();
        let JWQ = multiply(&terms.jacobian.to_dense(), &WQ);
        for i in 0..system.row_count() {
            assert_eq!(terms.rhs_bias[i], -terms.acceleration_bias[i]);
            assert_close("−J W Q", terms.rhs_forces[i], -JWQ[i], 1e-13 * largest(&JWQ)); // roundoff of a short sum
            assert_eq!(terms.rhs_stiffness[i], -ks * terms.residual[i]);
            assert_eq!(terms.rhs_damping[i], -kd * terms.residual_rate[i]);
            let sum = terms.rhs_bias[i] + terms.rhs_forces[i] + terms.rhs_stiffness[i] + terms.rhs_damping[i];
            assert_eq!(terms.right_hand_side[i], sum);
        }
    }
}

#[test]
fn multipliers_solve_A_lambda_equals_b() {
    for (system, state) in webs() {
        let terms = evaluate(&system, &state);
        let Al = multiply(&terms.constraint_matrix.to_dense(), &terms.multipliers);
        assert_all_close("A λ", &Al, &terms.right_hand_side, roundoff(&terms));
        assert_eq!(terms.rank, Some(system.row_count()));
        assert_eq!(terms.warnings, []);
    }
}

#[test]
fn constraint_force_is_Jt_lambda_and_accelerations_follow() {
    for (system, state) in webs() {
        let terms = evaluate(&system, &state);
        let N = system.coordinate_count();
        let Q_hat = multiply_transposed(&terms.jacobian.to_dense(), N, &terms.multipliers);
        assert_all_close("Q̂", &terms.constraint_forces, &Q_hat, 1e-13 * largest(&Q_hat)); // roundoff of a short sum
        for (k, w) in weights(&system).iter().enumerate() {
            assert_eq!(terms.accelerations[k], w * (terms.applied_forces[k] + terms.constraint_forces[k]));
        }
    }
}

/// The residual behaves as a damped oscillator: C̈ + kd Ċ + ks C = 0.
#[test]
fn feedback_makes_the_residual_a_damped_oscillator() {
    for (system, state) in webs() {
        let terms = evaluate(&system, &state);
        let Feedback { ks, kd, .. } = *system.feedback();
        for (i, Cdd) in acceleration_of_C(&terms).iter().enumerate() {
            let sum = Cdd + kd * terms.residual_rate[i] + ks * terms.residual[i];
            assert_close("C̈ + kd Ċ + ks C", sum, 0.0, roundoff(&terms));
        }
    }
}

/// C follows e^(−ωt)(1 + ωt) when it starts at rest off the constraint, under critical feedback.
#[test]
fn residual_decays_as_the_closed_form_says() {
    let mut builder = System::builder(qhat::Dimension::Two);
    let a = builder.particle(qhat::Particle::at("a", [0.0, 0.0]));
    let b = builder.particle(qhat::Particle::at("b", [1.1, 0.0]).with_mass(3.0));
    builder.with_constraint("rod", qhat::Distance::new(a, b, 1.0)).feedback(systems::critical(5.0));
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Rk4, 1e-3)).unwrap();
    for frame in 1..=1000 {
        simulation.step().unwrap();
        let x = 5.0 * 1e-3 * f64::from(frame);
        let C = 0.1 * (1.0 + x) * libm::exp(-x);
        // RK4's error, (hω)⁴ = 6e-10 of 0.1 over a few 1/ω.
        assert_close("C(t)", simulation.terms().residual[0], C, 1e-10);
    }
}

#[test]
fn diagonal_drag_is_added_to_the_diagonal_of_A() {
    for (system, state) in webs() {
        for epsilon in [1e-6, 0.1, 30.0] {
            let feedback = Feedback { diagonal_drag: epsilon, ..*system.feedback() };
            let terms = terms_with(&system, &state, feedback);
            let Al = multiply(&terms.constraint_matrix.to_dense(), &terms.multipliers);
            let sum: Vec<f64> = Al.iter().zip(&terms.multipliers).map(|(Al, l)| Al + epsilon * l).collect();
            assert_all_close("(A + ε I) λ", &sum, &terms.right_hand_side, roundoff(&terms));
            let Feedback { ks, kd, .. } = feedback;
            for (i, Cdd) in acceleration_of_C(&terms).iter().enumerate() {
                let softened = Cdd + kd * terms.residual_rate[i] + ks * terms.residual[i];
                assert_close("C̈ + kd Ċ + ks C = −ελ", softened, -epsilon * terms.multipliers[i], roundoff(&terms));
            }
            assert_eq!(
                terms.constraint_matrix,
                terms_with(&system, &state, Feedback::NONE).constraint_matrix,
                "A itself is shown without ε"
            );
        }
    }
}

#[test]
fn elasticity_scales_the_constraint_force() {
    for (system, state) in webs() {
        let rigid = terms_with(&system, &state, *system.feedback());
        let Feedback { ks, kd, .. } = *system.feedback();
        for elasticity in [0.0, 0.1, 0.5, 0.95] {
            let s = 1.0 - elasticity;
            let soft = terms_with(&system, &state, Feedback { elasticity, ..*system.feedback() });
            assert_eq!(soft.multipliers, rigid.multipliers);
            for (soft, rigid) in soft.constraint_forces.iter().zip(&rigid.constraint_forces) {
                assert_eq!(*soft, s * rigid);
            }
            let tension: Vec<f64> = rigid.tension.iter().map(|T| s * T).collect();
            assert_all_close("tension", &soft.tension, &tension, 1e-14 * largest(&tension)); // order of two products
            for (i, Cdd) in acceleration_of_C(&soft).iter().enumerate() {
                let free = soft.acceleration_bias[i] - soft.rhs_forces[i]; // a₀ = γ + J W Q
                let expected = (1.0 - s) * free - s * (ks * soft.residual[i] + kd * soft.residual_rate[i]);
                assert_close("C̈ = (1−s) a₀ − s (ks C + kd Ċ)", *Cdd, expected, roundoff(&rigid));
            }
        }
    }
}

/// Every symbol scales with its unit: four times the masses and forces give four times λ and the same q̈.
#[test]
fn units_are_kept() {
    let (system, state) = systems::truss(4, false);
    let terms = evaluate(&system, &state);
    let mut builder = System::builder(qhat::Dimension::Two);
    for (i, x) in state.positions().chunks(2).enumerate() {
        let particle = qhat::Particle::at(format!("n{i}"), x).with_mass(4.0 * system.masses()[i]);
        builder.particle(if system.inverse_masses()[i] == 0.0 { particle.fixed() } else { particle });
    }
    for named in system.constraints() {
        builder.constraint(named.name.clone(), named.constraint.clone());
    }
    builder.force(systems::gravity());
    let (heavy, state) = builder.build().unwrap();
    let fourfold = evaluate(&heavy, &state);
    // Powers of four change no rounding, not even in a square root.
    assert_eq!(fourfold.tension, terms.tension.iter().map(|T| 4.0 * T).collect::<Vec<_>>());
    assert_eq!(fourfold.accelerations, terms.accelerations);
    assert!(dot(&fourfold.tension, &fourfold.tension) > 0.0);
}

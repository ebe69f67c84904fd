//! Every kind against its twin, the same typed as expressions: the same rows, and the same motion.

use super::case::{Case, LATER, P, slopes_in_time, twin};
use super::cases::{CASES, KINDS};
use crate::systems::dense::{assert_all_close, assert_close};
use crate::systems::random::{Random, dimension};
use qhat::{
    Constraint, Distance, ExpressionConstraint, Gravity, Integrator, Nail, NailForm, Settings, Simulation, Spring,
    evaluate,
};

/// Random states tried for every case.
const STATES: usize = 40;

#[test]
fn every_kind_has_the_rows_of_its_expressions() {
    // Roundoff of some dozens of operations on numbers below 100.
    let roundoff = 1e-12;
    for case in CASES.iter().filter(|case| case.same_rows && !case.one_sided) {
        let (system, start) = case.system(LATER);
        let twins = case.typed();
        for (q, v) in case.states(&mut Random::new(5), STATES) {
            let terms = evaluate(&system, &start.with_motion(q.clone(), v.clone()));
            let (J, Ct) = (terms.jacobian.to_dense(), slopes_in_time(&terms));
            assert_eq!(terms.residual.len(), twins.len(), "{}", case.name);
            for (row, twin) in twins.iter().enumerate() {
                let mut blocks = vec![0.0; twin.gradient_len()];
                let (jet, slope) = twin.jet_and_gradient(&q, &v, LATER, &mut blocks);
                let turn = std::f64::consts::TAU;
                let whole = if case.turns { ((jet.value - terms.residual[row]) / turn).round() * turn } else { 0.0 };
                for (symbol, actual, typed) in [
                    ("C", terms.residual[row], jet.value - whole),
                    ("Ċ", terms.residual_rate[row], jet.first),
                    ("γ", terms.acceleration_bias[row], jet.second),
                    ("C_t", Ct[row], slope),
                ] {
                    assert_close(&format!("{}: {symbol} typed", case.name), actual, typed, roundoff);
                }
                let mut dense = vec![0.0; q.len()];
                for (particle, block) in twin.particles().iter().zip(blocks.chunks(case.d)) {
                    dense[particle.index() * case.d..][..case.d].copy_from_slice(block);
                }
                let name = format!("{}: J typed", case.name);
                assert_all_close(&name, &J[row * q.len()..][..q.len()], &dense, roundoff);
            }
        }
    }
}

/// C alone: what else their rows hold is put to the test where contacts close, in contacts.rs and tension.rs.
#[test]
fn one_sided_kinds_have_the_margins_of_their_expressions() {
    for case in CASES.iter().filter(|case| case.one_sided) {
        let [constraint] = &case.constraints(0.0)[..] else { panic!("{}: one constraint", case.name) };
        let twins = case.typed();
        for (q, v) in case.states(&mut Random::new(5), STATES) {
            let typed: Vec<f64> = twins.iter().map(|twin| twin.jet(&q, &v, 0.0).value).collect();
            // Roundoff of some operations on numbers below 10.
            assert_all_close(case.name, &constraint.residual(dimension(case.d), &q), &typed, 1e-14);
        }
    }
}

/// Particles that springs keep apart and together, thrown into the air, beside a rod that gives both systems one length
/// to measure in.
fn thrown(case: &Case, constraints: Vec<Constraint>, integrator: Integrator) -> Simulation {
    let (d, q) = (case.d, case.positions());
    // Any that differ.
    let v = |i: usize| (0..d).map(|k| 0.2 * ((3 * i + 5 * k + 1) % 7) as f64 - 0.6).collect::<Vec<f64>>();
    let mut builder = case.particles(|i, particle| particle.with_velocity(v(i)));
    for (i, a) in P[..5].iter().enumerate() {
        for b in &P[..i] {
            let square = |k: usize| {
                let along = q[a.index() * d + k] - q[b.index() * d + k];
                along * along
            };
            let rest = 0.9 * (0..d).map(square).sum::<f64>().sqrt();
            if rest > 0.0 {
                builder.force(Spring { a: *a, b: *b, stiffness: 20.0, damping: 0.1, rest });
            }
        }
    }
    builder.force(Gravity { acceleration: [0.3, -9.81, 0.2] });
    builder.constraint("beside", Distance::new(crate::systems::id(5), crate::systems::id(6), 1.0));
    for (k, constraint) in constraints.into_iter().enumerate() {
        builder.constraint(format!("c{k}"), constraint);
    }
    let (system, state) = builder.build().unwrap_or_else(|error| panic!("{}: {error}", case.name));
    let (tolerance, h) = (1e-12, 0.02);
    let settings = Settings { integrator, tolerance, h, constraint_tolerance: 1e-13, ..Settings::default() };
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    for _ in 0..50 {
        simulation.step().unwrap_or_else(|error| panic!("{}: {error}", case.name));
    }
    simulation
}

/// The kind, and its twin.
fn both(case: &Case) -> [Vec<Constraint>; 2] {
    let q = case.positions();
    let typed = case.typed().into_iter().map(|expression| ExpressionConstraint::new(expression, &q).into());
    [case.constraints(0.0), typed.collect()]
}

fn apart(one: &Simulation, other: &Simulation) -> f64 {
    let pairs = one.state().positions().iter().zip(other.state().positions());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn every_kind_moves_as_its_expressions() {
    for case in CASES.iter().filter(|case| case.moves) {
        let [one, other] = both(case).map(|constraints| thrown(case, constraints, Integrator::Dop853));
        let free = thrown(case, Vec::new(), Integrator::Dop853);
        // dop853 at 1e-12 a substep follows the motion itself.
        let apart_by = apart(&one, &other);
        println!("{}: {apart_by:e} of {:e}", case.name, apart(&one, &free));
        assert!(apart_by < 1e-10, "{}: {apart_by:e} m apart", case.name);
        assert!(apart(&one, &free) > 0.01, "{} is not put to the test", case.name);
    }
}

/// A gradient that vanishes exactly where it must hold is held by feedback alone, as the source does: no motion that a
/// tolerance could follow, but the same arithmetic, over 50 steps of roundoff.
#[test]
fn the_scalar_nail_moves_as_its_expression() {
    let make = |_: &_| vec![Nail { form: NailForm::Scalar, ..Nail::new(P[0], [0.0; 3]) }.into()];
    let case = twin("scalar nail", 2, &[], make, &["dot(p0, p0)"]);
    let [one, other] = both(&case).map(|constraints| thrown(&case, constraints, Integrator::Euler));
    assert!(apart(&one, &other) < 1e-11);
}

/// In the plane and in space, where it can be, and over a motion where it is an equality.
#[test]
fn every_kind_has_its_cases() {
    for (name, dimensions, moves) in KINDS {
        for d in *dimensions {
            let is_it = |case: &&Case| case.d == *d && case.constraints(0.0).iter().any(|it| it.kind() == *name);
            let mut cases = CASES.iter().filter(is_it).peekable();
            assert!(cases.peek().is_some(), "{name} has no case in {d} dimensions: add one to tests/kinds/cases.rs");
            assert!(!moves || cases.any(|case| case.moves), "no case moves {name} in {d} dimensions");
        }
    }
}

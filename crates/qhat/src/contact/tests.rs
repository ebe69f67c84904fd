//! `settle` against all sets of modes, one after the other.

use super::pyramids::propose;
use super::{Touching, settle};
use crate::modes::{Mode, Modes, Slip};
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::{Dimension, Distance, Limits, Obstacle, Particle, ParticleId, State, Surface, System};

/// SplitMix64 (Steele, Lea, Flood 2014), in [−1, 1).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// An equation with its rows evaluated at a state.
fn at<const D: usize>(system: &System, state: &State) -> Equation {
    let mut equation = Equation::new(system);
    equation.constrain_all(system, Motion::<D> { q: &state.q, qd: &state.qd, t: 0.0 });
    equation
}

fn all(contacts: usize) -> Vec<Touching> {
    (0..contacts).map(|contact| Touching { contact, slip: None, may_stick: true, is_rough: false }).collect()
}

/// A x = b by elimination with pivoting on rows.
fn solved(mut A: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
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

/// λ of w = A λ − b ≥ 0, λ ≥ 0, λ w = 0, by trying every set of rows that are on; one for a positive definite A.
fn by_trying(A: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let m = b.len();
    for set in 0..1_usize << m {
        let on: Vec<usize> = (0..m).filter(|row| set >> row & 1 == 1).collect();
        let part = solved(
            on.iter().map(|&i| on.iter().map(|&j| A[i][j]).collect()).collect(),
            on.iter().map(|&i| b[i]).collect(),
        );
        let mut lambda = vec![0.0; m];
        on.iter().zip(&part).for_each(|(&row, &force)| lambda[row] = force);
        let opens = |i: usize| A[i].iter().zip(&lambda).map(|(a, force)| a * force).sum::<f64>() - b[i] >= -1e-12;
        if part.iter().all(|&force| force >= 0.0) && (0..m).all(opens) {
            return lambda;
        }
    }
    panic!("a positive definite problem has a solution");
}

/// Ropes between random points under random forces.
#[test]
fn it_finds_what_trying_all_sets_finds() {
    let mut random = Random(7);
    for round in 0..300 {
        let mut builder = System::builder(Dimension::Three);
        for i in 0..5 {
            let place = vec![random.number(), random.number(), random.number()];
            builder.particle(Particle::at(format!("p{i}"), place).with_mass(1.5 + random.number()));
        }
        // At most 8 of the 10 distances of 5 points in space, so that A is positive definite.
        let pairs: Vec<(usize, usize)> = (0..5).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
        let m = 1 + round % 8;
        for &(i, j) in pairs.iter().cycle().skip(round).take(m) {
            builder.constraint(format!("{i}-{j}"), Limits::rope(ParticleId(i), ParticleId(j), 10.0));
        }
        let (system, state) = builder.build().unwrap();
        let mut equation = at::<3>(&system, &state);
        equation.b.sum = (0..m).map(|_| random.number()).collect();
        let J = equation.rows.J.to_dense();
        let columns = 15;
        let A: Vec<Vec<f64>> = (0..m)
            .map(|i| {
                let entry = |j: usize| {
                    (0..columns).map(|k| J[i * columns + k] * system.inverse_mass[k / 3] * J[j * columns + k]).sum()
                };
                (0..m).map(entry).collect()
            })
            .collect();
        let expected = by_trying(&A, &equation.b.sum);
        let mut modes = Modes::at_first(&system.contacts);
        settle::<3>(&mut equation, &system, &mut modes, &all(m)).unwrap();
        let largest = expected.iter().fold(1.0_f64, |most, force| most.max(force.abs()));
        for (row, (found, expected)) in equation.lambda.iter().zip(&expected).enumerate() {
            assert!(
                (found - expected).abs() < 1e-9 * largest,
                "round {round}, row {row}: {found}, expected {expected}"
            );
            assert_eq!(modes.contacts[row].is_closed(), *expected > 0.0, "round {round}, row {row}");
        }
        // Lemke's method finds the same by another way.
        let proposed = propose::<3>(&mut equation, &system, &Modes::at_first(&system.contacts), &all(m)).unwrap();
        assert_eq!(proposed, modes, "round {round}");
    }
}

/// A particle at rest on rough ground under a random force: it lifts off, sticks, or slips in the direction of the
/// force.
#[test]
fn friction_sticks_slips_or_lifts_off() {
    let mut random = Random(11);
    let mut seen = [0; 3];
    for _ in 0..300 {
        let friction = 0.1 + random.number().abs();
        let mut builder = System::builder(Dimension::Three);
        let mass = 1.5 + random.number();
        let body = builder.particle(Particle::at("body", [0.0; 3]).with_mass(mass));
        let ground = Surface::HalfSpace { normal: [0.0, 1.0, 0.0], offset: 0.0 };
        builder.constraint("ground", Obstacle { friction, ..Obstacle::new(body, ground) });
        let (system, state) = builder.build().unwrap();
        let mut equation = at::<3>(&system, &state);
        let force = [random.number(), random.number(), random.number()];
        // b = −J W Q.
        let mut b = vec![0.0; 3];
        equation.rows.J.multiply::<3>(&force.map(|component| component / mass), &mut b);
        equation.b.sum = b.iter().map(|rate| -rate).collect();
        let mut modes = Modes::at_first(&system.contacts);
        let rough = Touching { is_rough: true, ..all(1)[0] };
        settle::<3>(&mut equation, &system, &mut modes, &[rough]).unwrap();
        let across = [b[1], b[2]];
        let size = (across[0] * across[0] + across[1] * across[1]).sqrt();
        match modes.contacts[0] {
            Mode::Open => {
                assert!(force[1] >= 0.0);
                seen[0] += 1;
            }
            Mode::Sticking => {
                assert!(force[1] < 0.0 && size * mass <= -friction * force[1]);
                assert!((equation.lambda[0] + force[1]).abs() < 1e-12);
                seen[1] += 1;
            }
            Mode::Sliding(Slip { direction, .. }) => {
                assert!(force[1] < 0.0 && size * mass > -friction * force[1]);
                let along = (direction[0] * across[0] + direction[1] * across[1]) / size;
                assert!((along - 1.0).abs() < 1e-12, "{direction:?} against {across:?}");
                seen[2] += 1;
            }
            Mode::Smooth => panic!("the ground is rough"),
        }
    }
    assert!(seen.iter().all(|&count| count > 5), "{seen:?}");
}

/// Whether λ and the modes at hand solve the problem, to 1e-9 of the right-hand side.
fn assert_solved(equation: &Equation, system: &System, modes: &Modes, what: &str) {
    let small = 1e-9 * equation.b.sum.iter().fold(0.0_f64, |most, b| most.max(b.abs()));
    let w = |row: usize| equation.J_W_JT_lambda::<2>(row) - equation.b.sum[row];
    for (contact, mode) in system.contacts.list.iter().zip(&modes.contacts) {
        let (normal, lambda) = (w(contact.normal), equation.lambda[contact.normal]);
        match mode {
            Mode::Open => assert!(normal >= -small && lambda == 0.0, "{what}: {modes:?}, w {normal}"),
            _ => assert!(normal.abs() <= small && lambda >= 0.0, "{what}: {modes:?}, w {normal}, λ {lambda}"),
        }
        for row in contact.tangents.clone() {
            match mode {
                Mode::Sticking => assert!(w(row).abs() <= small, "{what}: {modes:?}, slip {}", w(row)),
                Mode::Sliding(slip) => assert!(w(row) * slip.direction[0] >= -small, "{what}: {modes:?}, {}", w(row)),
                Mode::Open | Mode::Smooth => {}
            }
        }
    }
}

/// Three feet of a rigid body in one line, A and B at its ends and C in the middle, on a floor with friction.
fn three_feet(friction: f64) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let places = [[-1.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0]];
    let ids: Vec<ParticleId> =
        places.iter().enumerate().map(|(i, &place)| builder.particle(Particle::at(format!("p{i}"), place))).collect();
    for (i, j) in [(0, 2), (1, 2), (0, 3), (1, 3), (2, 3)] {
        let (a, b) = (places[i], places[j]);
        let length = ((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])).sqrt();
        builder.constraint(format!("{i}-{j}"), Distance::new(ids[i], ids[j], length));
    }
    let floor = Surface::HalfSpace { normal: [0.0, 1.0, 0.0], offset: 0.0 };
    for &id in &ids[..3] {
        builder.constraint(format!("foot {}", id.0), Obstacle { friction, ..Obstacle::new(id, floor.clone()) });
    }
    builder.build().unwrap()
}

/// The middle foot follows from the others, which leave it out of A. It opens where the others lift it, and the others
/// open where it lifts them, whatever modes the search begins with.
#[test]
fn a_foot_that_follows_from_others_opens_where_they_lift_it() {
    let (system, state) = three_feet(0.0);
    for (middle, expected) in [(0.5, [true, true, false]), (1.5, [false, false, true])] {
        for start in 0..8 {
            let mut equation = at::<2>(&system, &state);
            equation.b.sum = vec![0.0; system.all_row_count()];
            for (contact, b) in system.contacts.list.iter().zip([1.0, 1.0, middle]) {
                equation.b.sum[contact.normal] = b;
            }
            let mut modes = Modes::at_first(&system.contacts);
            for k in (0..3).filter(|k| start >> k & 1 == 1) {
                modes.contacts[k] = Mode::Smooth;
            }
            settle::<2>(&mut equation, &system, &mut modes, &all(3)).unwrap();
            let closed: Vec<bool> = modes.contacts.iter().map(|mode| mode.is_closed()).collect();
            assert_eq!(closed, expected, "from {start}");
            assert_solved(&equation, &system, &modes, &format!("from {start}"));
        }
    }
}

/// Ropes between random points as above, beside others with right-hand sides of a billion times as much: each is
/// decided by the forces on its own particles, and the search ends.
#[test]
fn contacts_beside_large_impulses_are_decided_by_their_own_forces() {
    let mut random = Random(23);
    for round in 0..100 {
        let mut builder = System::builder(Dimension::Two);
        for i in 0..8 {
            builder.particle(Particle::at(format!("p{i}"), vec![random.number(), random.number()]));
        }
        // At most 4 of the 5 distances of 4 points in the plane that are independent.
        let pairs = [(0, 1), (1, 2), (2, 3), (0, 3)];
        for (i, j) in pairs.into_iter().chain(pairs.map(|(i, j)| (i + 4, j + 4))) {
            builder.constraint(format!("{i}-{j}"), Limits::rope(ParticleId(i), ParticleId(j), 10.0));
        }
        let (system, state) = builder.build().unwrap();
        let b: Vec<f64> = (0..8).map(|_| random.number()).collect();
        let settled = |scale: f64| {
            let mut equation = at::<2>(&system, &state);
            equation.b.sum = b.iter().enumerate().map(|(row, b)| if row < 4 { *b } else { scale * b }).collect();
            let mut modes = Modes::at_first(&system.contacts);
            settle::<2>(&mut equation, &system, &mut modes, &all(8)).unwrap();
            (modes, equation.lambda)
        };
        let ((modes, lambda), (beside, lambda_beside)) = (settled(1.0), settled(1e9));
        assert_eq!(modes, beside, "round {round}");
        for row in 0..4 {
            let off = (lambda[row] - lambda_beside[row]).abs();
            // 1e-15 of a billion.
            assert!(off <= 1e-6 * (1.0 + lambda[row]), "round {round}, row {row}: {off}");
        }
    }
}

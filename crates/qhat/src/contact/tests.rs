//! `settle` against all sets of modes, one after the other.

use super::cones::propose;
use super::{Touching, settle};
use crate::modes::{Mode, Modes, Slip};
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::{Dimension, Limits, Obstacle, Particle, ParticleId, State, Surface, System};

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

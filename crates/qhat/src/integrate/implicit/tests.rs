//! The matrix of a Newton iteration against a dense one made by differences, for trees, nets and mixtures of both.

use super::matrix::{Linearization, Matrix};
use crate::force::Acts;
use crate::linalg::block::{Block, transposed};
use crate::point::Motion;
use crate::stiffness::Stiffness;
use crate::{
    Dimension, Distance, DistanceForm, Drag, MouseSpring, Nail, NailForm, Particle, ParticleId, Spring, System,
};

const D: usize = 3;
const H_E: f64 = 0.02;

/// Numbers in [−1, 1) that look random and are the same everywhere.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Twelve points about the lattice 3 × 4, connected as said; rods as long as they are.
fn system(rods: &[(usize, usize)], more: impl FnOnce(&mut crate::SystemBuilder)) -> (System, Vec<f64>) {
    let mut numbers = Numbers(3);
    let mut builder = System::builder(Dimension::Three);
    for i in 0..12 {
        let place = [(i % 3) as f64, (i / 3) as f64, 0.0].map(|x| x + 0.2 * numbers.next());
        let particle = Particle::at(format!("p{i}"), place).with_mass(0.3 + 0.2 * numbers.next());
        builder.particle(if i == 0 { particle.fixed() } else { particle });
    }
    for (k, &(a, b)) in rods.iter().enumerate() {
        let rod = Distance::new(ParticleId(a), ParticleId(b), 1.0);
        // Some squared, some soft, some rigid.
        builder.constraint(
            format!("r{k}"),
            match k % 4 {
                1 => Distance { form: DistanceForm::Squared, ..rod },
                2 => rod.with_compliance(1e-3, 2.0),
                _ => rod,
            },
        );
    }
    builder.force(Drag { coefficient: 0.7 });
    builder.force(MouseSpring { particle: ParticleId(5), target: [0.3; 3], stiffness: 80.0, damping: 3.0 });
    more(&mut builder);
    let (system, state) = builder.build().unwrap();
    (system, state.positions().to_vec())
}

const TREE: [(usize, usize); 11] =
    [(0, 1), (1, 2), (3, 0), (3, 4), (4, 5), (4, 7), (6, 7), (7, 8), (9, 7), (7, 10), (10, 11)];

/// Gaussian elimination with partial pivoting.
fn solve_dense(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            for j in k..n {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}

/// h_e² Q + Jᵀ μ at q, with q̇ = q/h_e.
fn forces(system: &System, mu: &[f64], q: &[f64]) -> Vec<f64> {
    let qd: Vec<f64> = q.iter().map(|x| x / H_E).collect();
    let motion = Motion::<D> { q, qd: &qd, t: 0.0 };
    let mut rows = system.empty_rows();
    system.evaluate_rows(motion, &mut rows);
    let mut sum = vec![0.0; q.len()];
    for force in &system.forces {
        force.add(motion, &system.mass, &mut sum);
    }
    sum.iter_mut().for_each(|force| *force *= H_E * H_E);
    rows.J.add_transposed::<D>(mu, &mut sum);
    sum
}

/// `Matrix` and the dense matrix with differences for K have the same solution.
fn check(what: &str, system: &System, q: &[f64]) {
    let (n, m) = (q.len(), system.all_row_count());
    // In tension, the more the farther down the list: K is positive then, and nothing needs mending.
    let mu: Vec<f64> = (0..m).map(|row| -0.02 * (1.0 + row as f64)).collect();
    let qd: Vec<f64> = q.iter().map(|x| x / H_E).collect();
    let motion = Motion::<D> { q, qd: &qd, t: 0.0 };
    let mut rows = system.empty_rows();
    system.evaluate_rows(motion, &mut rows);

    let J = rows.J.to_dense();
    let mut dense = vec![vec![0.0; n + m]; n + m];
    for j in 0..n {
        // Central differences: third derivatives of order one leave 1e-10, roundoff 1e-11.
        const STEP: f64 = 1e-5;
        let moved = |by: f64| {
            forces(
                system,
                &mu,
                &q.iter().enumerate().map(|(k, x)| if k == j { x + by } else { *x }).collect::<Vec<_>>(),
            )
        };
        let (ahead, behind) = (moved(STEP), moved(-STEP));
        for i in 0..n {
            dense[i][j] -= (ahead[i] - behind[i]) / (2.0 * STEP);
        }
        dense[j][j] += system.mass[j / D];
        for row in 0..m {
            (dense[n + row][j], dense[j][n + row]) = (J[row * n + j], J[row * n + j]);
        }
    }
    for row in 0..m {
        let soft = &system.softness[row];
        dense[n + row][n + row] = -soft.compliance / (H_E * H_E * soft.lag(H_E));
    }
    // Fixed particles do not move.
    for i in (0..n).filter(|i| system.inverse_mass[i / D] == 0.0) {
        for j in 0..n + m {
            (dense[i][j], dense[j][i]) = (0.0, 0.0);
        }
        dense[i][i] = 1.0;
    }
    let mut numbers = Numbers(11);
    let b: Vec<f64> =
        (0..n + m).map(|i| if i < n && system.inverse_mass[i / D] == 0.0 { 0.0 } else { numbers.next() }).collect();
    let expected = solve_dense(dense, b.clone());

    let mut matrix = Matrix::new(system);
    assert!(matrix.factor(&Linearization { system, rows: &rows, motion, mu: &mu, h_e: H_E, dependent: &[] }), "{what}");
    let mut r: Vec<f64> = matrix.graph.particle.iter().flat_map(|id| b[id.0 * D..][..D].to_vec()).collect();
    let mut s = b[n..].to_vec();
    matrix.solve::<D>(system, &mut r, &mut s);
    let size = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    // The differences' own error times the condition of the system, some 1e3.
    for (node, id) in matrix.graph.particle.iter().enumerate() {
        for k in 0..D {
            let error = (r[node * D + k] - expected[id.0 * D + k]).abs();
            assert!(error < 1e-6 * size, "{what}: Δq of particle {} is off by {error:e} of {size:e}", id.0);
        }
    }
    for row in 0..m {
        let error = (s[row] - expected[n + row]).abs();
        assert!(error < 1e-6 * size, "{what}: Δμ of row {row} is off by {error:e} of {size:e}");
    }
}

#[test]
fn a_tree_is_eliminated_from_its_leaves() {
    let (system, q) = system(&TREE, |_| {});
    let matrix = Matrix::new(&system);
    assert!(!matrix.graph.has_cycles && matrix.graph.forest.links.len() == 11);
    // Both of the rods on the pin are at roots of components of their own.
    assert!(matrix.graph.penalties.is_empty(), "{:?}", matrix.graph.penalties);
    check("tree", &system, &q);
}

#[test]
fn springs_are_edges_without_a_row() {
    let (system, q) = system(&TREE[..8], |builder| {
        for (a, b) in [(8, 9), (9, 10)] {
            builder.force(Spring { a: ParticleId(a), b: ParticleId(b), stiffness: 300.0, damping: 0.0, rest: 0.4 });
        }
    });
    assert!(!Matrix::new(&system).graph.has_cycles);
    check("springs", &system, &q);
}

#[test]
fn rows_left_over_on_a_tree_act_through_a_penalty() {
    let (system, q) = system(&TREE, |builder| {
        builder.constraint("nail", Nail::new(ParticleId(11), [2.0, 3.0, 0.0]));
        builder.constraint("scalar", Nail { form: NailForm::Scalar, ..Nail::new(ParticleId(2), [1.0, 0.5, 0.5]) });
    });
    let matrix = Matrix::new(&system);
    assert!(!matrix.graph.has_cycles && matrix.graph.penalties.len() == 4, "{:?}", matrix.graph.penalties);
    check("penalties", &system, &q);
}

#[test]
fn a_net_is_factored_in_blocks() {
    let mut rods = TREE.to_vec();
    rods.extend([(2, 5), (5, 8), (6, 9), (10, 8)]);
    let (system, q) = system(&rods, |builder| {
        builder.force(Spring { a: ParticleId(2), b: ParticleId(11), stiffness: 50.0, damping: 0.0, rest: 0.1 });
    });
    let matrix = Matrix::new(&system);
    assert!(matrix.graph.has_cycles && !matrix.graph.penalties.is_empty());
    check("net", &system, &q);
}

/// A chain under so much compression that M + h² K is not positive definite: the factor is made all the same, and leads
/// somewhere finite.
#[test]
fn a_compressed_chain_is_mended() {
    let (system, q) = system(&TREE, |_| {});
    let qd = vec![0.0; q.len()];
    let motion = Motion::<D> { q: &q, qd: &qd, t: 0.0 };
    let mut rows = system.empty_rows();
    system.evaluate_rows(motion, &mut rows);
    let mu = vec![5.0; system.all_row_count()];
    let mut matrix = Matrix::new(&system);
    assert!(matrix.factor(&Linearization { system: &system, rows: &rows, motion, mu: &mu, h_e: H_E, dependent: &[] }));
    let (mut r, mut s) = (vec![1.0; matrix.graph.particle.len() * D], vec![0.0; system.all_row_count()]);
    let force = r.clone();
    matrix.solve::<D>(&system, &mut r, &mut s);
    // A positive definite matrix leads along the force, not against it.
    let along: f64 = r.iter().zip(&force).map(|(x, f)| x * f).sum();
    assert!(along.is_finite() && along > 0.0, "{along}");
}

/// B on two particles and −B between them is the same in one piece and in three, for either order of the two particles.
#[test]
fn a_difference_is_three_blocks() {
    let mut rods = TREE.to_vec();
    rods.extend([(2, 5), (5, 8), (6, 9), (10, 8)]);
    let (system, _) = system(&rods, |_| {});
    let id = ParticleId;
    let add = |pieces: &[(usize, usize, Stiffness<D>)], signed: bool| {
        let mut matrix = Matrix::new(&system);
        for &(a, b, piece) in pieces {
            matrix.add(matrix.graph.place(id(a), id(b)), &piece, signed);
        }
        (matrix.diagonal, matrix.coupling)
    };
    let mut numbers = Numbers(5);
    for (a, b) in [(4, 5), (5, 2), (8, 5), (0, 1)] {
        let any: Block<D> = [[numbers.next(); D]; D].map(|row| row.map(|x| x * numbers.next()));
        let symmetric: Block<D> = std::array::from_fn(|i| std::array::from_fn(|j| -any[i][j].abs() - any[j][i].abs()));
        let minus = symmetric.map(|row| row.map(|x| -x));
        let difference = add(&[(a, b, Stiffness::Difference(symmetric))], true);
        assert!(difference.0.iter().any(|&x| x != 0.0));
        for piece in [Stiffness::Definite, Stiffness::Indefinite] {
            let three = add(&[(a, a, piece(symmetric)), (b, b, piece(symmetric)), (a, b, piece(minus))], true);
            assert_eq!(three, difference, "{a}, {b}");
            assert_eq!(add(&[(a, b, piece(any))], true), add(&[(b, a, piece(transposed(&any)))], true), "{a}, {b}");
        }
        // Without `signed`, blocks with a negative trace and blocks of unknown sign are left out.
        let nothing = add(&[], false);
        assert_eq!(add(&[(a, b, Stiffness::Difference(symmetric))], false), nothing);
        assert_eq!(add(&[(b, b, Stiffness::Indefinite(minus))], false), nothing);
        let definite = [(b, b, Stiffness::Definite(minus))];
        assert_eq!(add(&definite, false), add(&definite, true));
    }
}

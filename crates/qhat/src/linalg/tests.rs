//! Compares the factorizations with each other, with their residuals, and with matrices whose answer is known.

use super::bisection::{Graph, bisect};
use super::dissection::nested_dissection;
use super::elimination::Elimination;
use super::{
    ComponentKind, DenseLdl, EliminationPlan, Factor, Incidence, OuterProducts, Pattern, SmallPivots, SparseLdl,
    Symbolic, SymmetricMatrix, ordering,
};
use proptest::prelude::*;
use std::collections::BTreeSet;

/// A factorization that ends at a pivot that is not positive.
fn plain<'a>(shift: f64, met: &'a mut Vec<(usize, f64)>) -> SmallPivots<'a> {
    SmallPivots { shift, below: 0.0, instead: None, met }
}

/// A symmetric matrix with the given pairs as couplings and values from a seed. Its diagonal dominates, so the matrix
/// is positive definite.
fn matrix(n: usize, pairs: &[(usize, usize)], seed: u64) -> (Pattern, Vec<f64>) {
    let mut rows = vec![Vec::new(); n];
    for &(i, j) in pairs {
        let (i, j) = (i % n, j % n);
        rows[i.max(j)].push(i.min(j));
    }
    let pattern = Pattern::from_rows(rows);
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut values: Vec<f64> = (0..pattern.len()).map(|_| random()).collect();
    let mut sums = vec![0.1; n];
    for i in 0..n {
        for slot in pattern.start[i]..pattern.diagonal(i) {
            sums[i] += values[slot].abs();
            sums[pattern.column[slot]] += values[slot].abs();
        }
    }
    for i in 0..n {
        values[pattern.diagonal(i)] = sums[i];
    }
    (pattern, values)
}

fn any_matrix() -> impl Strategy<Value = (Pattern, Vec<f64>)> {
    let pairs = proptest::collection::vec((0_usize..1000, 0_usize..1000), 0..160);
    (1_usize..70, pairs, any::<u64>()).prop_map(|(n, pairs, seed)| matrix(n, &pairs, seed))
}

/// Row i + 1 is coupled to one row before it: a tree (or a forest, where `parents` says so).
fn tree(parents: &[usize]) -> (Pattern, Vec<f64>) {
    let pairs: Vec<(usize, usize)> = parents.iter().enumerate().map(|(i, parent)| (i + 1, parent % (i + 1))).collect();
    matrix(parents.len() + 1, &pairs, 1)
}

/// A net of k × k points, every edge an unknown.
fn net(k: usize) -> Incidence {
    let at = |i: usize, j: usize| (i * k + j) as u32;
    let along = (0..k * (k - 1)).map(|e| (e / (k - 1), e % (k - 1)));
    let edges =
        along.clone().map(|(i, j)| [at(i, j), at(i, j + 1)]).chain(along.map(|(i, j)| [at(j, i), at(j + 1, i)]));
    Incidence::new(k * k, edges)
}

/// The textbook's elimination in a given order, where the neighbours of an eliminated unknown become a clique. Returns
/// the number of couplings added, and for each step the number of neighbours of the eliminated unknown with the least
/// number of neighbours at that step.
fn eliminate(pattern: &Pattern, order: &[usize]) -> (usize, Vec<(usize, usize)>) {
    let mut neighbours = vec![BTreeSet::new(); pattern.order()];
    for i in 0..pattern.order() {
        for slot in pattern.start[i]..pattern.diagonal(i) {
            neighbours[i].insert(pattern.column[slot]);
            neighbours[pattern.column[slot]].insert(i);
        }
    }
    let (mut added, mut degrees) = (0, Vec::new());
    for (step, &gone) in order.iter().enumerate() {
        let least = order[step..].iter().map(|&i| neighbours[i].len()).min().unwrap();
        degrees.push((neighbours[gone].len(), least));
        let clique: Vec<usize> = std::mem::take(&mut neighbours[gone]).into_iter().collect();
        for (k, &i) in clique.iter().enumerate() {
            neighbours[i].remove(&gone);
            for &j in &clique[k + 1..] {
                added += usize::from(neighbours[i].insert(j));
                neighbours[j].insert(i);
            }
        }
    }
    (added, degrees)
}

fn minimum_degree(pattern: &Pattern) -> Vec<usize> {
    let order = ordering::minimum_degree(&Incidence::of_pattern(pattern), pattern.order(), usize::MAX).unwrap();
    order.into_iter().map(|i| i as usize).collect()
}

fn fill(pattern: &Pattern, order: &[usize]) -> usize {
    eliminate(pattern, order).0
}

fn sparse(pattern: &Pattern) -> SparseLdl {
    let plan = EliminationPlan::new(&Incidence::of_pattern(pattern));
    SparseLdl::new(Symbolic::new(pattern, &plan, Some(plan.order.clone()), vec![false; pattern.order()]).into())
}

fn right_side(n: usize) -> Vec<f64> {
    (0..n).map(|i| (i as f64 * 0.618).fract() - 0.4).collect()
}

fn residual(pattern: &Pattern, values: &[f64], shift: f64, x: &[f64], b: &[f64]) -> f64 {
    let mut Ax = vec![0.0; b.len()];
    pattern.multiply(values, x, &mut Ax);
    (0..b.len()).map(|i| (Ax[i] + shift * x[i] - b[i]).abs()).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn minimum_degree_is_a_permutation((pattern, _) in any_matrix()) {
        let mut order = minimum_degree(&pattern);
        order.sort_unstable();
        prop_assert_eq!(order, (0..pattern.order()).collect::<Vec<_>>());
    }

    #[test]
    fn minimum_degree_is_perfect_on_trees(parents in proptest::collection::vec(0_usize..1000, 0..80)) {
        let (pattern, _) = tree(&parents);
        prop_assert_eq!(fill(&pattern, &minimum_degree(&pattern)), 0);
    }

    #[test]
    fn minimum_degree_takes_the_least_coupled_each_time((pattern, _) in any_matrix()) {
        let (_, degrees) = eliminate(&pattern, &minimum_degree(&pattern));
        for (step, (taken, least)) in degrees.iter().enumerate() {
            prop_assert_eq!(taken, least, "step {}", step);
        }
    }

    #[test]
    fn nested_dissection_is_a_permutation((pattern, _) in any_matrix()) {
        let mut order = nested_dissection(&Incidence::of_pattern(&pattern));
        order.sort_unstable();
        prop_assert_eq!(order, (0..pattern.order() as u32).collect::<Vec<_>>());
    }

    /// The symbolic elimination predicts the same L as the textbook, for every order of elimination.
    #[test]
    fn entries_are_foretold((pattern, _) in any_matrix()) {
        let incidence = Incidence::of_pattern(&pattern);
        let plan = EliminationPlan::new(&incidence);
        let order: Vec<usize> = plan.order.iter().map(|&i| i as usize).collect();
        let (_, degrees) = eliminate(&pattern, &order);
        let elimination = Elimination::new(&incidence.permuted(&plan.order));
        let below: Vec<usize> = elimination.below.iter().map(|&c| c as usize).collect();
        prop_assert_eq!(below, degrees.iter().map(|&(degree, _)| degree).collect::<Vec<_>>());
        let entries: u64 = plan.components.iter().map(|component| component.entries).sum();
        prop_assert_eq!(entries, elimination.entries());
    }

    /// The multifrontal factor of a matrix with any couplings agrees with the simplicial factor.
    #[test]
    fn fronts_solve_like_single_columns((pattern, values) in any_matrix(), shift in 0.0_f64..1.0) {
        let incidence = Incidence::of_pattern(&pattern);
        let (order, widths) = Elimination::new(&incidence).fronts();
        let n = pattern.order();
        let blocked = EliminationPlan { order: order.clone(), simplicial: 0, widths, ..EliminationPlan::default() };
        let single = EliminationPlan { order, simplicial: n, ..EliminationPlan::default() };
        let b = right_side(n);
        let solve = |plan: &EliminationPlan| {
            let negative = vec![false; pattern.order()];
            let mut ldl = SparseLdl::new(Symbolic::new(&pattern, plan, Some(plan.order.clone()), negative).into());
            let pivot = ldl.factor(&values, &mut plain(shift, &mut Vec::new()));
            let mut x = b.clone();
            ldl.solve(&mut x);
            (pivot, x)
        };
        let (one, other) = (solve(&blocked), solve(&single));
        // The reason for the bounds is in `sparse_and_dense_solve_alike`.
        prop_assert!((one.0 - other.0).abs() < 1e-13 * one.0, "{} {}", one.0, other.0);
        for i in 0..n {
            prop_assert!((one.1[i] - other.1[i]).abs() < 1e-12, "x[{i}]: {} and {}", one.1[i], other.1[i]);
        }
    }

    #[test]
    fn sparse_and_dense_solve_alike((pattern, values) in any_matrix(), shift in 0.0_f64..1.0) {
        let n = pattern.order();
        let (mut dense, mut sparse) = (DenseLdl::new(n), sparse(&pattern));
        let pivots = (dense.factor(&pattern, &values, &mut plain(shift, &mut Vec::new())), sparse.factor(&values, &mut plain(shift, &mut Vec::new())));
        prop_assert!(pivots.0 > 0.0 && pivots.1 > 0.0, "{pivots:?} of a positive definite matrix");
        let b = right_side(n);
        let (mut x, mut y) = (b.clone(), b.clone());
        dense.solve(&mut x);
        sparse.solve(&mut y);
        // Dominant diagonals of at least 0.1 bound x by 4 and the roundoff of 70 unknowns by 1e-13.
        for i in 0..n {
            prop_assert!((x[i] - y[i]).abs() < 1e-12, "x[{i}]: {} and {}", x[i], y[i]);
        }
        prop_assert!(residual(&pattern, &values, shift, &x, &b) < 1e-13);
        prop_assert!(residual(&pattern, &values, shift, &y, &b) < 1e-13);
    }

    /// A second factorization does not depend on the first, even if the first failed.
    #[test]
    fn factors_can_be_made_again((pattern, values) in any_matrix(), spoil in 0_usize..70) {
        let mut bad = values.clone();
        bad[pattern.diagonal(spoil % pattern.order())] = -1.0;
        let b = right_side(pattern.order());
        let mut fresh = Factor::new(&pattern);
        let mut used = Factor::new(&pattern);
        prop_assert!(used.factor(&pattern, &bad, 0.0) <= 0.0, "an indefinite matrix has a pivot that is not positive");
        prop_assert_eq!(used.factor(&pattern, &values, 0.0), fresh.factor(&pattern, &values, 0.0));
        let (mut x, mut y) = (b.clone(), b);
        fresh.solve(&mut x);
        used.solve(&mut y);
        prop_assert_eq!(x, y);
    }
}

#[test]
fn a_star_is_eliminated_from_its_tips() {
    let (pattern, _) = tree(&[0; 50]);
    let order = minimum_degree(&pattern);
    assert!(order.iter().position(|&i| i == 0).unwrap() >= 49, "the hub last or next to last: {order:?}");
    assert_eq!(fill(&pattern, &(0..51).collect::<Vec<_>>()), 50 * 49 / 2, "hub first fills everything");
}

/// A straight cut through a net of k × k points cuts k edges.
#[test]
fn nets_are_cut_straight() {
    for k in [20, 41] {
        let net = net(k);
        let mut graph = Graph { start: vec![0], to: Vec::new() };
        for p in 0..net.points() as u32 {
            let others = net.unknowns_at(p).iter().map(|&u| net.points_of(u).iter().sum::<u32>() - p);
            graph.to.extend(others);
            graph.start.push(graph.to.len() as u32);
        }
        let low = bisect(&graph);
        let is_cut = |u: &u32| net.points_of(*u).iter().filter(|&&p| low[p as usize]).count() == 1;
        let cut = (0..net.unknowns() as u32).filter(is_cut).count();
        let count = low.iter().filter(|&&is_low| is_low).count();
        assert!(cut <= k + 1, "{cut} edges of a net of {k} × {k} cut"); // one more where a line has a step
        assert!(5 * count >= 2 * k * k && 5 * count <= 3 * k * k, "{count} of {} points on one side", k * k);
    }
}

/// The work of a dissected net grows with the cube of its side: 20 k³ operations were measured at k = 100 and 316.
#[test]
fn work_on_nets_is_bounded() {
    for k in [20, 40, 80] {
        let net = net(k);
        let work = Elimination::new(&net.permuted(&nested_dissection(&net))).factor_flops();
        assert!(work < 22 * (k * k * k) as u64, "{work} operations for a net of {k} × {k}");
    }
}

#[test]
fn shuffled_nets_are_cut_as_well() {
    let k = 40;
    let (straight, n) = (net(k), 2 * k * (k - 1));
    // Any two primes that divide neither count give permutations.
    let order: Vec<u32> = (0..n).map(|i| (i * 1009 % n) as u32).collect();
    let points = |u: &u32| straight.points_of(*u).iter().map(|&p| p * 1013 % (k * k) as u32).collect::<Vec<_>>();
    let shuffled = Incidence::new(k * k, order.iter().map(points));
    let flops = |net: &Incidence| Elimination::new(&net.permuted(&nested_dissection(net))).factor_flops() as f64;
    let (a, b) = (flops(&straight), flops(&shuffled));
    assert!(b < 1.15 * a, "{a} operations, shuffled {b}"); // ties between cuts of the same size go another way
}

#[test]
fn components_are_told_apart() {
    // A path of three, a star with an anchor, a triangle, and an unknown that touches nothing.
    let lists: [&[u32]; 11] = [&[0, 1], &[1, 2], &[2], &[3, 4], &[3, 5], &[3, 6], &[4], &[7, 8], &[8, 9], &[9, 7], &[]];
    let plan = EliminationPlan::new(&Incidence::new(10, lists.iter().map(|list| list.iter().copied())));
    let found: Vec<(ComponentKind, usize)> =
        plan.components.iter().map(|component| (component.kind, component.rows)).collect();
    assert_eq!(
        found,
        [(ComponentKind::Path, 3), (ComponentKind::Tree, 4), (ComponentKind::Cyclic, 3), (ComponentKind::Path, 1)]
    );
    let entries: Vec<u64> = plan.components.iter().map(|component| component.entries).collect();
    assert_eq!(entries, [5, 8, 6, 1], "no fill in the first two, and a full triangle");
}

#[test]
fn matrices_read_back_what_was_put_in() {
    let pattern = Pattern::from_rows(vec![vec![], vec![0, 0, 5], vec![1]]);
    assert_eq!((pattern.order(), pattern.len()), (3, 5), "no entry twice, and none above the diagonal");
    let (values, outer) = (vec![1.0, 2.0, 3.0, 4.0, 5.0], OuterProducts::default());
    let matrix = SymmetricMatrix { pattern, values, outer };
    assert_eq!(matrix.to_dense(), [1.0, 2.0, 0.0, 2.0, 3.0, 4.0, 0.0, 4.0, 5.0]);
    assert_eq!((matrix.get(0, 2), matrix.get(1, 2), matrix.get(2, 1)), (0.0, 4.0, 4.0));
    let mut out = [0.0; 3];
    matrix.multiply(&[1.0, 10.0, 100.0], &mut out);
    assert_eq!(out, [21.0, 432.0, 540.0]);
    assert_eq!((matrix.order(), matrix.stored()), (3, 5));
}

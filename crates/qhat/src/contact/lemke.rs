//! Lemke's method for the linear complementarity problem: x with
//!
//! ```text
//! w = M x + q ≥ 0,   x ≥ 0,   xᵀ w = 0
//! ```
//!
//! One more unknown, x₀, is added to every row, large enough that w ≥ 0 with x = 0. From there the method goes along
//! edges on which one pair (w_i, x_i) has both numbers zero: the partner of the variable that left the basis enters
//! it. If x₀ leaves, x is a solution. If no variable can leave, there is none, for every M that is copositive plus
//! (impulses of contacts with Coulomb friction give such an M). Ties are broken by the lexicographic rule, so no
//! vertex is met twice.
//!
//! The table holds w − M x − x₀ = q: columns 0..n are w, n..2n are x, then x₀ and the right-hand side.
//! Sources: Lemke, Bimatrix Equilibrium Points and Mathematical Programming (1965); Anitescu, Potra, Formulating
//! Dynamic Multi-Rigid-Body Contact Problems (1997).

use std::cmp::Ordering;

/// Number of unknowns above which the method is not tried: the table has 2 n² numbers, and about n pivots are made.
const LARGEST: usize = 600;

/// Part of the largest number of its column below which a pivot counts as roundoff.
const TINY: f64 = 1e-10;

/// Part of the largest of q below which a right-hand side counts as zero.
const ROUNDOFF: f64 = 1e-12;

/// Pivots for each unknown: problems that end at all take about one.
const PIVOTS: usize = 20;

/// x and w for M, row after row, and q; of each pair at least one number is exactly zero. `None` if no solution was
/// found.
pub(super) fn lemke(M: &[f64], q: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = q.len();
    if q.iter().all(|&q| q >= 0.0) {
        return Some((vec![0.0; n], q.to_vec()));
    }
    if n > LARGEST {
        return None;
    }
    let size = q.iter().fold(0.0_f64, |most, q| most.max(q.abs()));
    let (extra, right) = (2 * n, 2 * n + 1);
    let mut table: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            let mut row = vec![0.0; 2 * n + 2];
            row[i] = 1.0; // w
            (0..n).for_each(|j| row[n + j] = -M[i * n + j]); // − M x
            (row[extra], row[right]) = (-1.0, snapped(q[i] / size)); // − x₀ = q
            row
        })
        .collect();
    let mut basis: Vec<usize> = (0..n).collect();
    let mut row = (0..n).fold(0, |least, i| if q[i] < q[least] { i } else { least });
    let mut entering = extra; // x₀, in the row of the least q
    for _ in 0..PIVOTS * (n + 1) {
        pivot(&mut table, row, entering);
        let left = std::mem::replace(&mut basis[row], entering);
        if left == extra {
            let mut w_x = vec![0.0; 2 * n];
            for (&variable, row) in basis.iter().zip(&table).filter(|&(&variable, _)| variable < 2 * n) {
                w_x[variable] = size * row[right].max(0.0);
            }
            let x = w_x.split_off(n);
            return Some((x, w_x));
        }
        entering = (left + n) % (2 * n); // its partner: x_i of w_i, w_i of x_i
        row = leaving(&table, &basis, entering)?;
    }
    None
}

/// The row whose ratio of right-hand side to entering column is least; of equal ones that of x₀, then the
/// lexicographically least.
fn leaving(table: &[Vec<f64>], basis: &[usize], entering: usize) -> Option<usize> {
    let n = table.len();
    let (extra, right) = (2 * n, 2 * n + 1);
    let largest = table.iter().fold(0.0_f64, |most, row| most.max(row[entering].abs()));
    let candidates = (0..n).filter(|&i| table[i][entering] > TINY * largest);
    candidates.reduce(|best, i| {
        let ratio = |row: usize, column: usize| table[row][column] / table[row][entering];
        let (a, b) = (ratio(best, right), ratio(i, right));
        let order = if (a - b).abs() > TINY * a.abs().max(b.abs()) {
            a.total_cmp(&b)
        } else if basis[best] == extra || basis[i] == extra {
            (basis[i] == extra).cmp(&(basis[best] == extra))
        } else {
            let mut orders = (0..n).map(|column| ratio(best, column).total_cmp(&ratio(i, column)));
            orders.find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
        };
        if order.is_gt() { i } else { best }
    })
}

/// Makes `entering` basic in `row`.
fn pivot(table: &mut [Vec<f64>], row: usize, entering: usize) {
    let mut chosen = std::mem::take(&mut table[row]);
    let scale = 1.0 / chosen[entering];
    chosen.iter_mut().for_each(|entry| *entry *= scale);
    chosen[entering] = 1.0;
    for other in table.iter_mut().filter(|other| !other.is_empty()) {
        let factor = other[entering];
        if factor != 0.0 {
            other.iter_mut().zip(&chosen).for_each(|(entry, chosen)| *entry -= factor * chosen);
            other[entering] = 0.0;
            if let Some(right) = other.last_mut() {
                *right = snapped(*right);
            }
        }
    }
    table[row] = chosen;
}

/// A right-hand side that is zero to roundoff becomes zero, so that ties are ties.
fn snapped(right: f64) -> f64 {
    if right.abs() < ROUNDOFF { 0.0 } else { right }
}

#[cfg(test)]
mod tests {
    use super::super::tests::Random;
    use super::lemke;

    /// M = Bᵀ B of rank r: every such problem has a solution for q = Bᵀ y + s, s ≥ 0.
    #[test]
    fn solutions_are_complementary_also_for_singular_matrices() {
        for seed in 0..500 {
            let n = 1 + seed as usize % 12;
            let r = n - seed as usize % 3 % n;
            let mut random = Random(seed);
            let mut numbers = |count: usize| -> Vec<f64> { (0..count).map(|_| random.number()).collect() };
            let (B, y, s) = (numbers(r * n), numbers(r), numbers(n));
            let column = |i: usize| (0..r).map(move |k| k * n + i);
            let M: Vec<f64> =
                (0..n * n).map(|e| column(e / n).zip(column(e % n)).map(|(a, b)| B[a] * B[b]).sum()).collect();
            let q: Vec<f64> =
                (0..n).map(|i| column(i).zip(&y).map(|(a, y)| B[a] * y).sum::<f64>() + s[i].max(0.0)).collect();
            let (x, _) = lemke(&M, &q).unwrap_or_else(|| panic!("seed {seed}"));
            let largest = x.iter().fold(1.0_f64, |most, x| most.max(*x));
            for i in 0..n {
                let w = q[i] + (0..n).map(|j| M[i * n + j] * x[j]).sum::<f64>();
                // Some pivots of roundoff each.
                assert!(
                    w > -1e-9 * largest && x[i] >= 0.0 && (w * x[i]).abs() < 1e-9 * largest * largest,
                    "seed {seed}"
                );
            }
        }
    }

    /// w = −x − 1 is never positive.
    #[test]
    fn a_problem_without_a_solution_ends() {
        assert_eq!(lemke(&[-1.0], &[-1.0]), None);
        assert_eq!(lemke(&[0.0, 1.0, -1.0, 0.0], &[-1.0, -1.0]), None);
    }
}

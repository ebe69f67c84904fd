//! LU factorization of a sparse matrix whose pattern is symmetric and whose numbers need not be, in a given order
//! without exchanges.
//!
//! ```text
//! row k of P A Pᵀ:   x ← a_k;   for the columns j < k of the pattern, ascending:  l_kj = x_j/u_jj,  x ← x − l_kj u_j
//!                    row k of U is then x from column k on
//! ```
//!
//! The order must be one in which pivots cannot vanish. For a saddle system [S, Jᵀ; J, 0] whose S is positive definite
//! that is any order in which every row of J comes after all of its columns: its pivot is then −J S⁻¹ Jᵀ, less what
//! earlier rows explain. A pivot that consists of rounding says that the row depends on earlier ones. Such a row is
//! left out, together with its unknown, which is taken as zero.

use super::scalar::Scalar;

/// A pivot of a row that may depend on others, over the sum of the sizes of its terms, below which it is taken for
/// rounding. Dependent rows leave some 1e-16 times the number of terms; independent rows of trusses of 1000 bays 1e-3
/// and more, and 1e-9 in an order that does not follow the structure.
const DEPENDENT: f64 = 1e-11;

/// The knowledge of a pivot before the factorization.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unknown {
    /// The pivot does not vanish.
    Kept,
    /// The pivot may consist of rounding; the unknown is then left out.
    MayDepend,
    /// The unknown is left out in any case.
    LeftOut,
}

/// The part of a factorization that depends on pattern and order alone.
#[derive(Clone, Debug, Default)]
pub(crate) struct LuPlan {
    /// The unknown that is eliminated k-th, and its inverse.
    pub(crate) order: Vec<u32>,
    pub(crate) place: Vec<u32>,
    lower_start: Vec<u32>,
    lower_column: Vec<u32>,
    /// For each entry l_kj the slot of u_jk.
    mirror: Vec<u32>,
    upper_start: Vec<u32>,
    upper_column: Vec<u32>,
}

impl LuPlan {
    /// `order[k]` is the unknown that is eliminated k-th; `couplings` are the pairs of different unknowns that have an
    /// entry. `None` if U would have more than `most` entries.
    pub(crate) fn new(order: Vec<u32>, couplings: impl Iterator<Item = (u32, u32)>, most: usize) -> Option<Self> {
        let n = order.len();
        let mut place = vec![0; n];
        for (k, &unknown) in order.iter().enumerate() {
            place[unknown as usize] = k as u32;
        }
        // The columns right of the diagonal of each row of A, then of U: those of A, and those of every earlier row
        // whose first column right of the diagonal is this one.
        let mut above: Vec<Vec<u32>> = vec![Vec::new(); n];
        for (a, b) in couplings {
            let (k, l) = (place[a as usize], place[b as usize]);
            above[k.min(l) as usize].push(k.max(l));
        }
        let mut entries = 0;
        for k in 0..n {
            let mut columns = std::mem::take(&mut above[k]);
            columns.sort_unstable();
            columns.dedup();
            entries += columns.len();
            if entries > most {
                return None;
            }
            if let Some((&first, rest)) = columns.split_first() {
                above[first as usize].extend(rest);
            }
            above[k] = columns;
        }
        let mut plan = LuPlan { order, place, ..LuPlan::default() };
        plan.lower_start = vec![0; n + 1];
        plan.upper_start = vec![0; n + 1];
        for (k, columns) in above.iter().enumerate() {
            plan.upper_start[k + 1] = plan.upper_start[k] + columns.len() as u32;
            columns.iter().for_each(|&column| plan.lower_start[column as usize + 1] += 1);
        }
        for k in 0..n {
            plan.lower_start[k + 1] += plan.lower_start[k];
        }
        plan.lower_column = vec![0; entries];
        plan.mirror = vec![0; entries];
        let mut next = plan.lower_start.clone();
        for (k, columns) in above.iter().enumerate() {
            for &column in columns {
                let slot = next[column as usize] as usize;
                plan.lower_column[slot] = k as u32;
                plan.mirror[slot] = plan.upper_column.len() as u32;
                plan.upper_column.push(column);
                next[column as usize] += 1;
            }
        }
        Some(plan)
    }

    /// Number of unknowns.
    pub(crate) fn unknowns(&self) -> usize {
        self.order.len()
    }

    fn lower(&self, k: usize) -> std::ops::Range<usize> {
        self.lower_start[k] as usize..self.lower_start[k + 1] as usize
    }

    fn upper(&self, k: usize) -> std::ops::Range<usize> {
        self.upper_start[k] as usize..self.upper_start[k + 1] as usize
    }
}

/// The numbers of L and U.
#[derive(Clone, Debug)]
pub(crate) struct Lu<T> {
    lower: Vec<T>,
    upper: Vec<T>,
    /// 1/u_kk; zero for an unknown that is left out.
    inverse: Vec<T>,
    row: Vec<T>,
}

impl<T: Scalar> Lu<T> {
    pub(crate) fn new(plan: &LuPlan) -> Self {
        let zeros = |n: usize| vec![T::default(); n];
        let n = plan.unknowns();
        let entries = plan.upper_column.len();
        Lu { lower: zeros(entries), upper: zeros(entries), inverse: zeros(n), row: zeros(n) }
    }

    /// Factors the matrix whose k-th row, in the order of elimination, `write(k, x)` adds to x, which is zero before.
    /// `unknown(k)` is the knowledge of the k-th pivot. Returns whether every pivot of an unknown that is not left out
    /// is a number that can be divided by.
    pub(crate) fn factor(
        &mut self,
        plan: &LuPlan,
        write: impl Fn(usize, &mut [T]),
        unknown: impl Fn(usize) -> Unknown,
    ) -> bool {
        let Lu { lower, upper, inverse, row: x } = self;
        for k in 0..plan.unknowns() {
            x[k] = T::default();
            plan.lower(k).for_each(|slot| x[plan.lower_column[slot] as usize] = T::default());
            plan.upper(k).for_each(|slot| x[plan.upper_column[slot] as usize] = T::default());
            write(k, x);
            for slot in plan.lower(k) {
                let j = plan.lower_column[slot] as usize;
                let l = x[j] * inverse[j];
                lower[slot] = l;
                let range = plan.upper(j);
                for (&column, &u) in plan.upper_column[range.clone()].iter().zip(&upper[range]) {
                    x[column as usize] -= l * u;
                }
            }
            for slot in plan.upper(k) {
                upper[slot] = x[plan.upper_column[slot] as usize];
            }
            let pivot = x[k];
            let unknown = unknown(k);
            if unknown == Unknown::LeftOut {
                inverse[k] = T::default();
                continue;
            }
            if unknown == Unknown::MayDepend {
                let terms = plan.lower(k).map(|slot| (lower[slot] * upper[plan.mirror[slot] as usize]).size());
                let size: f64 = terms.sum();
                if !size.is_finite() {
                    return false;
                }
                if pivot.size() <= DEPENDENT * size {
                    inverse[k] = T::default();
                    continue;
                }
            }
            inverse[k] = pivot.reciprocal();
            if !(inverse[k].size().is_finite() && pivot.size().is_finite()) {
                return false;
            }
        }
        true
    }

    /// Whether the unknown that is eliminated k-th was left out.
    pub(crate) fn is_left_out(&self, k: usize) -> bool {
        self.inverse[k] == T::default()
    }

    /// x ← (L U)⁻¹ x, in the order of elimination.
    pub(crate) fn solve(&self, plan: &LuPlan, x: &mut [T]) {
        for k in 0..plan.unknowns() {
            let mut sum = x[k];
            for slot in plan.lower(k) {
                sum -= self.lower[slot] * x[plan.lower_column[slot] as usize];
            }
            x[k] = sum;
        }
        for k in (0..plan.unknowns()).rev() {
            let mut sum = x[k];
            for slot in plan.upper(k) {
                sum -= self.upper[slot] * x[plan.upper_column[slot] as usize];
            }
            x[k] = sum * self.inverse[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::scalar::Complex;
    use super::*;

    /// Pseudo-random numbers in [−1, 1), the same on every machine.
    fn numbers(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    const N: usize = 12;

    /// A grid of 3 × 4 unknowns, eliminated from both ends.
    fn plan() -> (LuPlan, Vec<(u32, u32)>) {
        let mut couplings = Vec::new();
        for i in 0..N as u32 {
            if i % 4 != 3 {
                couplings.push((i, i + 1));
            }
            if i + 4 < N as u32 {
                couplings.push((i + 4, i));
            }
        }
        let order = (0..N as u32 / 2).flat_map(|i| [i, N as u32 - 1 - i]).collect();
        (LuPlan::new(order, couplings.iter().copied(), 1000).unwrap(), couplings)
    }

    fn dense<T: Scalar>(couplings: &[(u32, u32)], mut entry: impl FnMut() -> T) -> Vec<Vec<T>> {
        let mut matrix = vec![vec![T::default(); N]; N];
        for i in 0..N {
            matrix[i][i] = T::real(4.0);
            matrix[i][i] += entry();
        }
        for &(a, b) in couplings {
            matrix[a as usize][b as usize] = entry();
            matrix[b as usize][a as usize] = entry();
        }
        matrix
    }

    fn check<T: Scalar>(mut entry: impl FnMut() -> T) {
        let (plan, couplings) = plan();
        let matrix = dense(&couplings, &mut entry);
        let mut lu = Lu::new(&plan);
        let write = |k: usize, x: &mut [T]| {
            for (j, &value) in matrix[plan.order[k] as usize].iter().enumerate() {
                if value != T::default() {
                    x[plan.place[j] as usize] += value;
                }
            }
        };
        assert!(lu.factor(&plan, write, |_| Unknown::Kept));
        let wanted: Vec<T> = (0..N).map(|_| entry()).collect();
        let mut x = vec![T::default(); N];
        for i in 0..N {
            for j in 0..N {
                x[plan.place[i] as usize] += matrix[i][j] * wanted[j];
            }
        }
        lu.solve(&plan, &mut x);
        for (j, &wanted) in wanted.iter().enumerate() {
            let mut off = x[plan.place[j] as usize];
            off -= wanted;
            // A dominant diagonal: roundoff is multiplied by less than ten.
            assert!(off.size() < 1e-14, "unknown {j} is off by {}", off.size());
        }
    }

    #[test]
    fn it_solves_real_and_complex_systems() {
        let mut next = numbers(5);
        check(&mut next);
        check(|| Complex { re: next(), im: next() });
    }

    /// [1 0 1 1; 0 1 1 1; 1 1 0 0; 1 1 0 0]: the second row of J repeats the first.
    #[test]
    fn a_row_that_repeats_another_is_left_out() {
        let couplings = [(0, 2), (1, 2), (0, 3), (1, 3)];
        let plan = LuPlan::new(vec![0, 1, 2, 3], couplings.into_iter(), 100).unwrap();
        let rows = [[1.0, 0.0, 1.0, 1.0], [0.0, 1.0, 1.0, 1.0], [1.0, 1.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0]];
        let mut lu = Lu::<f64>::new(&plan);
        assert!(lu.factor(
            &plan,
            |k, x| x.iter_mut().zip(rows[k]).for_each(|(x, a)| *x += a),
            |k| if k >= 2 { Unknown::MayDepend } else { Unknown::Kept }
        ));
        assert_eq!([0, 1, 2, 3].map(|k| lu.is_left_out(k)), [false, false, false, true]);
        let mut x = [1.0, 2.0, 1.0, 1.0];
        lu.solve(&plan, &mut x);
        assert_eq!(x, [0.0, 1.0, 1.0, 0.0]);
    }

    #[test]
    fn a_factor_that_would_be_too_large_is_refused() {
        let pairs = (0..20_u32).flat_map(|i| (0..i).map(move |j| (i, j)));
        assert!(LuPlan::new((0..20).collect(), pairs.clone(), 189).is_none());
        assert_eq!(LuPlan::new((0..20).collect(), pairs, 190).unwrap().upper_column.len(), 190);
    }

    #[test]
    fn a_pivot_of_zero_is_no_factor() {
        let plan = LuPlan::new(vec![0, 1], [(0, 1)].into_iter(), 100).unwrap();
        let rows = [[0.0, 1.0], [1.0, 0.0]];
        let write = |k: usize, x: &mut [f64]| x.iter_mut().zip(rows[k]).for_each(|(x, a)| *x += a);
        assert!(!Lu::<f64>::new(&plan).factor(&plan, write, |_| Unknown::Kept));
    }
}

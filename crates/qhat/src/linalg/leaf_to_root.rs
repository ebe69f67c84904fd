//! Elimination from the leaves to the root: linear time for saddle systems whose graph is a forest.
//!
//! ```text
//! H  Gᵀ   x     r
//! G −E    ν  =  s        H: D × D blocks, on the diagonal and on the edges of the forest; E ≥ 0 diagonal
//! ```
//!
//! Each row of G belongs to one edge of the forest (or to a root) and is eliminated together with the child below it.
//! With H, g on the child, O = H_cp and w = g_p on its parent, n = g/|g|, γ = |g|:
//!
//! ```text
//! T = Z (ZᵀHZ)⁻¹ Zᵀ = Bᵀ P⁻¹ B    the child's response across the row, Z ⊥ n; P diagonal, B = L⁻¹ Zᵀ by LDLᵀ
//! v = n − T H n,   â = nᵀ H v     the child's response along the row, with the directions across following
//! S = (â γ; γ −E),  S⁻¹ = (E γ; γ −â)/(γ² + âE)
//! u = Oᵀ v
//! H_pp ← H_pp − Oᵀ T O − (u w) S⁻¹ (u w)ᵀ
//! r_p  ← r_p − Oᵀ T r − (u w) S⁻¹ (v·r, s)
//! and back:  (y, ν) = S⁻¹ (v·(r − O x_p), s − w·x_p),   x = T (r − O x_p) + v y
//! ```
//!
//! An edge without a row has T = H⁻¹ and no S. The recurrence squares no number and divides by no entry of E, so mass
//! ratios of 1e9 cost no digits. T is kept in factors, because a stiff spring or a penalty in H would cost an inverse
//! its digits. A hub of any degree costs no more than its edges.
//!
//! H need not be definite. A pivot across the row that is not positive is repaired in two steps: first the indefinite
//! part of its edge is removed (`retreat`), then a positive number is added to its diagonal. Both steps change the
//! matrix and not the right-hand side, so the solution that Newton's method converges to stays the same. Source:
//! Baraff, Linear-Time Dynamics using Lagrange Multipliers (1996), extended by geometric stiffness.

use super::block::{
    Block, accumulate, diagonal, divide, forward, ldl, load, outer, plus, product, store, times, transposed,
    transposed_times, vector, zero,
};
use crate::number::{dot, norm};

/// Stands for no parent, no row and no edge.
pub(crate) const NONE: usize = usize::MAX;

/// A pivot across the row must exceed this part of the node's floor. Below it the matrix is about to lose its
/// definiteness, and the step that it gives is no descent direction.
const LEAST_PIVOT: f64 = 1e-3;

/// Added to the diagonal where `retreat` did not repair a pivot [floors of the node]; larger at each attempt.
const MENDING: [f64; 4] = [1.0, 1e3, 1e6, 1e9];

/// One unknown block with the edge to its parent, in the order of elimination.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ForestEdge {
    /// The block of the unknown.
    pub(crate) node: usize,
    /// The block of its parent, or [`NONE`].
    pub(crate) parent: usize,
    /// The edge to the parent, whose block is H_cp, or [`NONE`].
    pub(crate) edge: usize,
    /// The row of G that is eliminated with the block, or [`NONE`].
    pub(crate) row: usize,
    /// The positions in `Saddle::rows` of the row's numbers on the node and on the parent.
    pub(crate) own: usize,
    pub(crate) above: usize,
}

/// The saddle system before it is factored.
pub(crate) struct Saddle<'a> {
    /// Diagonal blocks of H; overwritten.
    pub(crate) diagonal: &'a mut [f64],
    /// H_cp, one block for each edge.
    pub(crate) coupling: &'a [f64],
    /// −B for each edge, its indefinite part. `factor` may add B to the diagonal blocks of both ends and subtract it
    /// from the coupling.
    pub(crate) retreat: &'a [f64],
    /// The floor of each node: the size that its pivots are expected to exceed.
    pub(crate) floor: &'a [f64],
    /// The blocks of G, D numbers each.
    pub(crate) rows: &'a [f64],
    /// E, one number for each row.
    pub(crate) softness: &'a [f64],
}

/// The factors, one set for each link.
#[derive(Clone, Debug, Default)]
pub(crate) struct LeafToRoot {
    pub(crate) links: Vec<ForestEdge>,
    /// B and P⁻¹.
    across: Vec<f64>,
    weight: Vec<f64>,
    /// O.
    coupling: Vec<f64>,
    /// v, u and w.
    along: Vec<f64>,
    lifted: Vec<f64>,
    above: Vec<f64>,
    /// The entries 11, 12 and 22 of S⁻¹.
    pivot: Vec<[f64; 3]>,
}

impl LeafToRoot {
    pub(crate) fn new(links: Vec<ForestEdge>, dimension: usize) -> Self {
        let vectors = || vec![0.0; links.len() * dimension];
        let blocks = || vec![0.0; links.len() * dimension * dimension];
        LeafToRoot {
            across: blocks(),
            weight: vectors(),
            coupling: blocks(),
            along: vectors(),
            lifted: vectors(),
            above: vectors(),
            pivot: vec![[0.0; 3]; links.len()],
            links,
        }
    }

    /// Factors the system that has been assembled.
    pub(crate) fn factor<const D: usize>(&mut self, saddle: Saddle<'_>) {
        for (k, link) in self.links.iter().enumerate() {
            let hangs = link.parent != NONE;
            let mut H = load::<D>(saddle.diagonal, link.node);
            let mut O = if hangs { load::<D>(saddle.coupling, link.edge) } else { [[0.0; D]; D] };
            let g = if link.row != NONE { vector::<D>(saddle.rows, link.own) } else { [0.0; D] };
            let length = norm(g);
            let n = g.map(|component| component / length);
            let least = LEAST_PIVOT * saddle.floor[link.node];
            let across = |H: &Block<D>| if length > 0.0 { factor_across(H, n, least) } else { factor_whole(H, least) };

            let mut T = across(&H);
            if T.is_none() {
                if hangs {
                    let retreat = load::<D>(saddle.retreat, link.edge);
                    H = plus(H, -1.0, retreat);
                    O = plus(O, 1.0, retreat);
                    accumulate(saddle.diagonal, link.parent, -1.0, &retreat);
                    T = across(&H);
                }
                for floors in MENDING {
                    if T.is_none() {
                        H = plus(H, 1.0, diagonal(floors * saddle.floor[link.node]));
                        T = across(&H);
                    }
                }
            }
            // A pivot that is still NaN shows in the solution, which the caller checks.
            let T = T.unwrap_or(Across { B: [[f64::NAN; D]; D], weight: [f64::NAN; D] });

            let mut v = [0.0; D];
            let mut pivot = [0.0; 3];
            if length > 0.0 {
                let Hn = times(&H, n);
                let THn = T.times(Hn);
                v = std::array::from_fn(|i| n[i] - THn[i]);
                // Compression can make â negative. The bound keeps γ² + âE of a soft row positive.
                let a = dot(Hn, v).max(-0.5 * length * length / saddle.softness[link.row]);
                let E = saddle.softness[link.row];
                let determinant = length * length + a * E;
                pivot = [E / determinant, length / determinant, -a / determinant];
            }
            store(&mut self.across, k, T.B);
            put(&mut self.weight, k, T.weight);
            put(&mut self.along, k, v);
            self.pivot[k] = pivot;
            if hangs {
                let w = if link.row != NONE { vector::<D>(saddle.rows, link.above) } else { [0.0; D] };
                let u = transposed_times(&O, v);
                let BO = product(&T.B, &O);
                let mut lifted = zero();
                for (weight, row) in T.weight.into_iter().zip(BO) {
                    lifted = plus(lifted, 1.0, outer(weight, row, row));
                }
                let [p, q, r] = pivot;
                let rank_two = plus(outer(p, u, u), 1.0, outer(r, w, w));
                let mixed = plus(outer(q, u, w), 1.0, outer(q, w, u));
                let change = plus(plus(lifted, 1.0, rank_two), 1.0, mixed);
                accumulate(saddle.diagonal, link.parent, -1.0, &change);
                store(&mut self.coupling, k, O);
                put(&mut self.lifted, k, u);
                put(&mut self.above, k, w);
            }
        }
    }

    #[inline(always)]
    fn across<const D: usize>(&self, k: usize) -> Across<D> {
        Across { B: load(&self.across, k), weight: vector(&self.weight, k) }
    }

    /// r ← x and s ← ν, for the blocks and rows of the forest.
    pub(crate) fn solve<const D: usize>(&self, r: &mut [f64], s: &mut [f64]) {
        for (k, link) in self.links.iter().enumerate() {
            if link.parent == NONE {
                continue;
            }
            let own = vector::<D>(r, link.node);
            let (v, u, w) = (vector(&self.along, k), vector::<D>(&self.lifted, k), vector::<D>(&self.above, k));
            let t = transposed_times(&load::<D>(&self.coupling, k), self.across(k).times(own));
            let second = if link.row == NONE { 0.0 } else { s[link.row] };
            let [a, b] = apply(self.pivot[k], [dot(v, own), second]);
            let parent = &mut r[link.parent * D..][..D];
            for i in 0..D {
                parent[i] -= t[i] + u[i] * a + w[i] * b;
            }
        }
        for (k, link) in self.links.iter().enumerate().rev() {
            let mut own = vector::<D>(r, link.node);
            let mut second = if link.row == NONE { 0.0 } else { s[link.row] };
            if link.parent != NONE {
                let x = vector::<D>(r, link.parent);
                let pulled = times(&load::<D>(&self.coupling, k), x);
                own = std::array::from_fn(|i| own[i] - pulled[i]);
                second -= dot(vector::<D>(&self.above, k), x);
            }
            let v = vector::<D>(&self.along, k);
            let [y, nu] = apply(self.pivot[k], [dot(v, own), second]);
            let t = self.across(k).times(own);
            put::<D>(r, link.node, std::array::from_fn(|i| t[i] + v[i] * y));
            if link.row != NONE {
                s[link.row] = nu;
            }
        }
    }
}

/// S⁻¹ x.
#[inline(always)]
fn apply([p, q, r]: [f64; 3], [x, y]: [f64; 2]) -> [f64; 2] {
    [p * x + q * y, q * x + r * y]
}

/// T = Bᵀ P⁻¹ B.
struct Across<const D: usize> {
    B: Block<D>,
    /// The diagonal of P⁻¹.
    weight: [f64; D],
}

impl<const D: usize> Across<D> {
    /// T x.
    #[inline(always)]
    fn times(&self, x: [f64; D]) -> [f64; D] {
        let Bx = times(&self.B, x);
        transposed_times(&self.B, std::array::from_fn(|k| self.weight[k] * Bx[k]))
    }
}

/// H⁻¹ in factors; `None` if a pivot does not exceed `least`.
#[inline(always)]
fn factor_whole<const D: usize>(H: &Block<D>, least: f64) -> Option<Across<D>> {
    let factor = ldl(H, least)?;
    let columns = diagonal::<D>(1.0).map(|unit| forward(&factor, unit));
    Some(Across { B: transposed(&columns), weight: divide(&factor, [1.0; D]) })
}

/// Z (ZᵀHZ)⁻¹ Zᵀ in factors, for the D − 1 directions Z across the unit vector n; `None` if a pivot does not exceed
/// `least`.
#[inline(always)]
fn factor_across<const D: usize>(H: &Block<D>, n: [f64; D], least: f64) -> Option<Across<D>> {
    let (mut B, mut weight) = (zero(), [0.0; D]);
    if D == 2 {
        B[0] = std::array::from_fn(|i| if i == 0 { -n[1] } else { n[0] });
        let pivot = dot(B[0], times(H, B[0]));
        weight[0] = 1.0 / pivot;
        return (pivot > least).then_some(Across { B, weight });
    }
    // Two vectors across n without a branch that could divide by zero: Duff et al., Building an orthonormal basis,
    // revisited, J. Computer Graphics Techniques 6 (2017).
    let sign = 1.0_f64.copysign(n[2]);
    let a = -1.0 / (sign + n[2]);
    let b = n[0] * n[1] * a;
    let first = [1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]];
    let second = [b, sign + n[1] * n[1] * a, -n[1]];
    let (s, t): ([f64; D], [f64; D]) = (std::array::from_fn(|i| first[i]), std::array::from_fn(|i| second[i]));
    let (Hs, Ht) = (times(H, s), times(H, t));
    let factor = ldl::<2>(&[[dot(s, Hs), 0.0], [dot(s, Ht), dot(t, Ht)]], least)?;
    (B[0], B[1]) = (s, std::array::from_fn(|i| t[i] - factor[1][0] * s[i]));
    (weight[0], weight[1]) = (factor[0][0], factor[1][1]);
    Some(Across { B, weight })
}

#[inline(always)]
fn put<const D: usize>(flat: &mut [f64], i: usize, x: [f64; D]) {
    flat[i * D..][..D].copy_from_slice(&x);
}

//! Multifrontal LDLᵀ: the columns of a front are eliminated as one dense block, and its Schur complement goes to its
//! parent.
//!
//! Source: Duff and Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM TOMS 9 (1983).

use super::eight::{Eight, across};
use super::fronts::{Front, FrontPlan};
use super::kernel::{COLUMNS, H, columns, minus_scaled, outer, rows, scaled, subtract};
use super::small_pivots::SmallPivots;
use pulp::{Arch, NullaryFnOnce};

/// L D Lᵀ of some rows.
#[derive(Clone, Debug)]
pub(crate) struct Multifrontal {
    arch: Arch,
    /// L, front after front.
    l: Vec<Eight>,
    d: Vec<f64>,
    inverse_d: Vec<f64>,
    stacks: [Vec<Eight>; 2],
    scratch: Scratch,
}

#[derive(Clone, Debug)]
struct Scratch {
    /// D Lᵀ for a block of eight rows.
    w: Vec<Eight>,
    /// The positions of the rows of a child in its parent's L.
    offset: Vec<usize>,
    /// Eight partial sums for each column.
    sums: Vec<Eight>,
}

impl Multifrontal {
    pub(crate) fn new(plan: &FrontPlan) -> Self {
        Multifrontal {
            arch: Arch::new(),
            l: vec![[0.0; H]; plan.l_len],
            d: vec![0.0; plan.range.len()],
            inverse_d: vec![0.0; plan.range.len()],
            stacks: plan.stack_len.map(|len| vec![[0.0; H]; len]),
            scratch: Scratch {
                w: vec![[0.0; H]; plan.most_columns],
                offset: vec![0; plan.most_rows],
                sums: vec![[0.0; H]; plan.most_columns],
            },
        }
    }

    pub(crate) fn factor(
        &mut self,
        plan: &FrontPlan,
        negative: &[bool],
        values: &[f64],
        small: &mut SmallPivots<'_>,
    ) -> f64 {
        self.arch.dispatch(Factorization { ldl: self, plan, negative: &negative[plan.range.clone()], values, small })
    }

    /// Factors one front: from the entries of A and the updates of its children to its columns of L and its own update.
    #[inline(always)]
    fn eliminate(
        &mut self,
        plan: &FrontPlan,
        front: &Front,
        negative: &[bool],
        values: &[f64],
        small: &mut SmallPivots<'_>,
    ) -> f64 {
        let negative = &negative[front.first..][..front.columns];
        let l = &mut self.l[front.l.clone()];
        let [even, odd] = &mut self.stacks;
        let (own, others) = if front.stack == 0 { (even, odd) } else { (odd, even) };
        let update = &mut own[front.update.clone()];
        let blocks = front.row_blocks();
        l.fill([0.0; H]);
        for j in 0..front.rows.len() {
            update[j * blocks + j / H..(j + 1) * blocks].fill([0.0; H]);
        }
        let numbers = l.as_flattened_mut();
        for &(slot, place) in &plan.entries[front.entries.clone()] {
            numbers[place as usize] += values[slot as usize];
        }
        for c in 0..front.columns {
            if !negative[c] {
                numbers[front.row_in_l(c) + c * H] += small.shift;
            }
        }
        for &child in &plan.children[front.children.clone()] {
            let child = &plan.fronts[child as usize];
            let from = others[child.update.clone()].as_flattened();
            take(plan, front, child, from, numbers, update.as_flattened_mut(), &mut self.scratch.offset);
        }
        let d = &mut self.d[front.first..][..front.columns];
        let inverse_d = &mut self.inverse_d[front.first..][..front.columns];
        let first = plan.range.start + front.first;
        let smallest = factor_columns(l, negative, d, inverse_d, &mut self.scratch.w, first, small);
        if smallest > 0.0 {
            subtract_update(front, l, d, update, &mut self.scratch.w);
        }
        smallest
    }

    /// x ← (L D Lᵀ)⁻¹ x for the whole x, of which only these rows change.
    pub(crate) fn solve(&mut self, plan: &FrontPlan, x: &mut [f64]) {
        self.arch.dispatch(Solve { ldl: self, plan, x: &mut x[plan.range.clone()] });
    }
}

/// The factorization as a task for the widest registers of the machine. It is a type and not a closure, so that the
/// whole task is compiled for these registers.
struct Factorization<'a, 'b> {
    ldl: &'a mut Multifrontal,
    plan: &'a FrontPlan,
    negative: &'a [bool],
    values: &'a [f64],
    small: &'a mut SmallPivots<'b>,
}

impl NullaryFnOnce for Factorization<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let mut smallest = f64::INFINITY;
        for front in &self.plan.fronts {
            let pivot = self.ldl.eliminate(self.plan, front, self.negative, self.values, self.small);
            if pivot.is_nan() || pivot <= 0.0 {
                return pivot;
            }
            smallest = smallest.min(pivot);
        }
        smallest
    }
}

struct Solve<'a> {
    ldl: &'a mut Multifrontal,
    plan: &'a FrontPlan,
    x: &'a mut [f64],
}

impl NullaryFnOnce for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Solve { ldl, plan, x } = self;
        for front in &plan.fronts {
            forward(plan, front, &ldl.l[front.l.clone()], x);
        }
        for (x, inverse) in x.iter_mut().zip(&ldl.inverse_d) {
            *x *= inverse;
        }
        for front in plan.fronts.iter().rev() {
            backward(plan, front, &ldl.l[front.l.clone()], x, &mut ldl.scratch.sums);
        }
    }
}

/// Adds a child's update to its parent: rows of the parent's columns into L, the other rows into the parent's update.
#[inline(always)]
fn take(
    plan: &FrontPlan,
    front: &Front,
    child: &Front,
    from: &[f64],
    l: &mut [f64],
    update: &mut [f64],
    offset: &mut [usize],
) {
    let places = &plan.places[child.rows.clone()];
    let (r, stride, own) = (places.len(), child.row_blocks() * H, front.row_blocks() * H);
    let base = front.pivot_blocks() * H;
    let pivots = places.partition_point(|&place| (place as usize) < base);
    let offset = &mut offset[..r];
    for (offset, &place) in offset.iter_mut().zip(places) {
        *offset = front.row_in_l(place as usize);
    }
    for j in 0..pivots {
        let column = &mut l[places[j] as usize * H..];
        for (value, &offset) in from[j * stride + j..j * stride + r].iter().zip(&offset[j..]) {
            column[offset] += value;
        }
    }
    for j in pivots..r {
        let column = &mut update[(places[j] as usize - base) * own..][..own];
        for (value, &place) in from[j * stride + j..j * stride + r].iter().zip(&places[j..]) {
            column[place as usize - base] += value;
        }
    }
}

/// Eliminates eight columns at a time: first the columns before are subtracted from the eight, then the eight are
/// eliminated in all rows.
#[inline(always)]
fn factor_columns(
    l: &mut [Eight],
    negative: &[bool],
    d: &mut [f64],
    inverse_d: &mut [f64],
    w: &mut [Eight],
    first: usize,
    small: &mut SmallPivots<'_>,
) -> f64 {
    let k = d.len();
    let mut smallest = f64::INFINITY;
    for begin in (0..k).step_by(H) {
        // The blocks of rows from the first of these columns on.
        let l = &mut l[begin / H * k..];
        let (before, d) = d.split_at_mut(begin);
        let inverse_d = &mut inverse_d[begin..];
        let negative = &negative[begin..];
        let (w, first) = (&mut w[..begin], first + begin);
        scale(&l[..begin], before, w);
        let pivots = [&mut *d, &mut *inverse_d];
        let pivot = match k - begin {
            1 => factor_tiles::<1>(k, l, negative, pivots, w, first, small),
            2 => factor_tiles::<2>(k, l, negative, pivots, w, first, small),
            3 => factor_tiles::<3>(k, l, negative, pivots, w, first, small),
            4 => factor_tiles::<4>(k, l, negative, pivots, w, first, small),
            5 => factor_tiles::<5>(k, l, negative, pivots, w, first, small),
            6 => factor_tiles::<6>(k, l, negative, pivots, w, first, small),
            7 => factor_tiles::<7>(k, l, negative, pivots, w, first, small),
            _ => factor_tiles::<8>(k, l, negative, pivots, w, first, small),
        };
        if pivot.is_nan() || pivot <= 0.0 {
            return pivot;
        }
        smallest = smallest.min(pivot);
    }
    smallest
}

/// Eliminates N columns in all blocks of rows; the first block holds their pivots. w is D Lᵀ of the columns before.
#[inline(always)]
fn factor_tiles<const N: usize>(
    k: usize,
    l: &mut [Eight],
    negative: &[bool],
    [d, inverse_d]: [&mut [f64]; 2],
    w: &[Eight],
    first: usize,
    small: &mut SmallPivots<'_>,
) -> f64 {
    let mut smallest = f64::INFINITY;
    let (mut y, mut inverse) = ([[0.0; H]; N], [0.0; N]);
    for (b, block) in l.chunks_exact_mut(k).enumerate() {
        let (done, rest) = block.split_at_mut(w.len());
        let Some(tile) = rest.first_chunk_mut::<N>() else { break };
        let mut own = *tile;
        if !done.is_empty() {
            let first = outer::<0>(done, w);
            for j in 0..N.min(COLUMNS) {
                subtract(&mut own[j], &first[j]);
            }
            if N > COLUMNS {
                let second = outer::<COLUMNS>(done, w);
                for j in COLUMNS..N {
                    subtract(&mut own[j], &second[j - COLUMNS]);
                }
            }
        }
        if b == 0 {
            for c in 0..N {
                d[c] = own[c][c];
                let pivot = if negative[c] { -d[c] } else { d[c] };
                if pivot.is_nan() || pivot <= small.below {
                    match small.pivot_instead(first + c, pivot) {
                        // A column of zeros times an infinite d would not be a number.
                        Some(instead) if instead.is_infinite() => (d[c], inverse[c]) = (0.0, 0.0),
                        Some(instead) => (d[c], inverse[c]) = (instead, 1.0 / instead),
                        None => return pivot,
                    }
                } else {
                    if !negative[c] {
                        smallest = smallest.min(pivot);
                    }
                    inverse[c] = 1.0 / d[c];
                }
                inverse_d[c] = inverse[c];
                y[c] = own[c];
                own[c] = scaled(&y[c], inverse[c]);
                for next in c + 1..N {
                    own[next] = minus_scaled(&own[next], &own[c], y[c][next]);
                }
            }
        } else {
            for c in 0..N {
                own[c] = scaled(&own[c], inverse[c]);
                for next in c + 1..N {
                    own[next] = minus_scaled(&own[next], &own[c], y[c][next]);
                }
            }
        }
        *tile = own;
    }
    smallest
}

/// w = D Lᵀ for a block of rows.
#[inline(always)]
fn scale(l: &[Eight], d: &[f64], w: &mut [Eight]) {
    for ((l, w), &d) in l.iter().zip(w).zip(d) {
        *w = scaled(l, d);
    }
}

/// update ← update − L D Lᵀ of the rows below.
#[inline(always)]
fn subtract_update(front: &Front, l: &[Eight], d: &[f64], update: &mut [Eight], w: &mut [Eight]) {
    let (k, blocks) = (front.columns, front.row_blocks());
    let below = &l[front.pivot_blocks() * k..];
    let w = &mut w[..k];
    for b in 0..blocks {
        scale(&below[b * k..][..k], d, w);
        let columns = &mut update[b * H * blocks..][..H * blocks];
        let (first, second) = columns.split_at_mut(COLUMNS * blocks);
        let has_second = front.rows.len() > b * H + COLUMNS;
        for (block, i) in below[b * k..].chunks_exact(k).zip(b..blocks) {
            for (column, sum) in first.chunks_exact_mut(blocks).zip(&outer::<0>(block, w)) {
                subtract(&mut column[i], sum);
            }
            if has_second {
                for (column, sum) in second.chunks_exact_mut(blocks).zip(&outer::<COLUMNS>(block, w)) {
                    subtract(&mut column[i], sum);
                }
            }
        }
    }
}

/// x ← L⁻¹ x, for the columns of one front.
#[inline(always)]
fn forward(plan: &FrontPlan, front: &Front, l: &[Eight], x: &mut [f64]) {
    let k = front.columns;
    let (own, later) = x[front.first..].split_at_mut(k);
    let (pivots, below) = l.split_at(front.pivot_blocks() * k);
    for (block, begin) in pivots.chunks_exact(k).zip((0..k).step_by(H)) {
        let count = H.min(k - begin);
        let sum = rows(&block[..begin], own);
        let tile = &block[begin..][..count];
        let own = &mut own[begin..][..count];
        for (own, sum) in own.iter_mut().zip(&sum) {
            *own -= sum;
        }
        for c in 0..count {
            for i in c + 1..count {
                own[i] -= tile[c][i] * own[c];
            }
        }
    }
    let base = front.first + k;
    for (block, places) in below.chunks_exact(k).zip(plan.rows[front.rows.clone()].chunks(H)) {
        let sum = rows(block, own);
        for (&row, sum) in places.iter().zip(&sum) {
            later[row as usize - base] -= sum;
        }
    }
}

/// x ← L⁻ᵀ x, for the columns of one front.
#[inline(always)]
fn backward(plan: &FrontPlan, front: &Front, l: &[Eight], x: &mut [f64], sums: &mut [Eight]) {
    let k = front.columns;
    let (own, later) = x[front.first..].split_at_mut(k);
    let (pivots, below) = l.split_at(front.pivot_blocks() * k);
    let sums = &mut sums[..k];
    sums.fill([0.0; H]);
    let base = front.first + k;
    for (block, places) in below.chunks_exact(k).zip(plan.rows[front.rows.clone()].chunks(H)) {
        let mut known = [0.0; H];
        for (known, &row) in known.iter_mut().zip(places) {
            *known = later[row as usize - base];
        }
        columns(block, &known, sums);
    }
    for (b, block) in pivots.chunks_exact(k).enumerate().rev() {
        let begin = b * H;
        let count = H.min(k - begin);
        let tile = &block[begin..][..count];
        let mut known = [0.0; H];
        for c in (0..count).rev() {
            let mut value = own[begin + c] - across(&sums[begin + c]);
            for i in c + 1..count {
                value -= tile[c][i] * known[i];
            }
            known[c] = value;
            own[begin + c] = value;
        }
        columns(&block[..begin], &known, sums);
    }
}

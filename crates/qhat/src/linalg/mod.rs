//! Symmetric matrices and their LDLᵀ factorization, and LU of others (`lu.rs`). Nothing here refers to physics, and
//! code that is less readable for the sake of speed stays in this folder.
//!
//! Every operation is a plain f64 operation in a fixed order, so native and wasm results agree bit for bit.

mod bisection;
pub(crate) mod block;
mod block_ldl;
mod dense;
mod dissection;
pub(crate) mod eight;
mod elimination;
mod fronts;
mod hubs;
mod incidence;
mod kernel;
mod leaf_to_root;
mod lu;
mod multifrontal;
mod ordering;
mod plan;
mod scalar;
mod simplicial;
mod small_pivots;
mod symmetric;
#[cfg(test)]
mod tests;

pub(crate) use block_ldl::BlockLdl;
pub(crate) use hubs::Hubs;
pub(crate) use incidence::Incidence;
pub(crate) use leaf_to_root::{ForestEdge, LeafToRoot, NONE, Saddle};
pub(crate) use lu::{Lu, LuPlan, Unknown};
pub use plan::{Component, ComponentKind, FactorMethod};
pub(crate) use plan::{EliminationPlan, components};
pub(crate) use scalar::{Complex, Scalar};
pub(crate) use small_pivots::SmallPivots;
pub use symmetric::SymmetricMatrix;
pub(crate) use symmetric::{Lower, OuterProducts, Pattern};

use dense::DenseLdl;
use fronts::FrontPlan;
use multifrontal::Multifrontal;
use simplicial::{Simplicial, SimplicialPlan};
use std::sync::Arc;

/// Largest order of a matrix that is factored densely: up to this order the dense factorization is at least as fast as
/// the sparse factorization, for every pattern.
pub(crate) const DENSE_UP_TO: usize = 24;

/// The LDLᵀ factorization of a symmetric positive definite matrix, dense up to order [`DENSE_UP_TO`] and sparse beyond.
#[derive(Clone, Debug)]
pub(crate) enum Factor {
    Dense(DenseLdl),
    Sparse(Box<SparseLdl>),
}

impl Factor {
    /// Chooses the method and the order and prepares everything that depends on the pattern alone.
    #[cfg(test)]
    pub(crate) fn new(pattern: &Pattern) -> Self {
        if pattern.order() <= DENSE_UP_TO {
            return Factor::Dense(DenseLdl::new(pattern.order()));
        }
        let plan = EliminationPlan::new(&Incidence::of_pattern(pattern));
        let order = plan.order.clone();
        Factor::with(&Arc::new(Symbolic::new(pattern, &plan, Some(order), vec![false; pattern.order()])))
    }

    /// The factor of a matrix whose plan was made with its structure.
    pub(crate) fn with(symbolic: &Arc<Symbolic>) -> Self {
        if symbolic.unknowns <= DENSE_UP_TO {
            Factor::Dense(DenseLdl::new(symbolic.unknowns))
        } else {
            Factor::Sparse(Box::new(SparseLdl::new(symbolic.clone())))
        }
    }

    /// Factors A + shift·I and returns the smallest pivot. If this pivot is not positive, no factor was made. Unknowns
    /// of hubs are not shifted. Their pivots must be negative, and a pivot of theirs is returned only if it is not.
    pub(crate) fn factor(&mut self, pattern: &Pattern, values: &[f64], shift: f64) -> f64 {
        let met = &mut Vec::new();
        self.factor_with(pattern, values, &mut SmallPivots { shift, below: 0.0, instead: None, met })
    }

    /// The same with an answer to small pivots. Returns the smallest of the other pivots, infinity if there is none.
    pub(crate) fn factor_with(&mut self, pattern: &Pattern, values: &[f64], small: &mut SmallPivots<'_>) -> f64 {
        match self {
            Factor::Dense(ldl) => ldl.factor(pattern, values, small),
            Factor::Sparse(ldl) => ldl.factor(values, small),
        }
    }

    /// Memory of the numbers of L and their positions [bytes].
    #[cfg(test)]
    pub(crate) fn memory(&self) -> usize {
        match self {
            Factor::Dense(_) => 0,
            Factor::Sparse(ldl) => {
                let (simplicial, fronts) = (&ldl.symbolic.simplicial, &ldl.symbolic.fronts);
                simplicial.memory() + fronts.memory()
            }
        }
    }

    /// x ← (L D Lᵀ)⁻¹ x.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        match self {
            Factor::Dense(ldl) => ldl.solve(x),
            Factor::Sparse(ldl) => ldl.solve(x),
        }
    }
}

/// The part of a sparse factorization that depends on the pattern alone.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symbolic {
    unknowns: usize,
    /// `order[k]` is the unknown that is eliminated k-th; `None` if unknown k is.
    order: Option<Vec<u32>>,
    a: Lower,
    /// Unknowns of hubs, in the order of elimination: their pivots are negative, and no shift is added to them.
    negative: Vec<bool>,
    simplicial: SimplicialPlan,
    fronts: FrontPlan,
}

impl Symbolic {
    pub(crate) fn new(pattern: &Pattern, plan: &EliminationPlan, order: Option<Vec<u32>>, negative: Vec<bool>) -> Self {
        let n = pattern.order();
        let a = Lower::new(pattern, order.as_deref());
        let simplicial = SimplicialPlan::new(&a, 0..plan.simplicial);
        let fronts = FrontPlan::new(&a, plan.simplicial..n, &plan.widths);
        Symbolic { unknowns: n, order, a, negative, simplicial, fronts }
    }
}

/// P A Pᵀ = L D Lᵀ, each connected component by the method that suits it.
#[derive(Clone, Debug)]
pub(crate) struct SparseLdl {
    symbolic: Arc<Symbolic>,
    simplicial: Simplicial,
    fronts: Multifrontal,
    /// x in the order of elimination.
    x: Vec<f64>,
}

impl SparseLdl {
    fn new(symbolic: Arc<Symbolic>) -> Self {
        let x = symbolic.order.as_ref().map_or(Vec::new(), |order| vec![0.0; order.len()]);
        SparseLdl {
            simplicial: Simplicial::new(&symbolic.simplicial),
            fronts: Multifrontal::new(&symbolic.fronts),
            symbolic,
            x,
        }
    }

    fn factor(&mut self, values: &[f64], small: &mut SmallPivots<'_>) -> f64 {
        let symbolic = &*self.symbolic;
        let negative = &symbolic.negative;
        let smallest = self.simplicial.factor(&symbolic.simplicial, &symbolic.a, negative, values, small);
        if smallest.is_nan() || smallest <= 0.0 {
            return smallest;
        }
        let other = self.fronts.factor(&symbolic.fronts, negative, values, small);
        if other.is_nan() { other } else { smallest.min(other) }
    }

    fn solve(&mut self, x: &mut [f64]) {
        let symbolic = &*self.symbolic;
        let Some(order) = &symbolic.order else {
            self.simplicial.solve(&symbolic.simplicial, x);
            return self.fronts.solve(&symbolic.fronts, x);
        };
        for (y, &i) in self.x.iter_mut().zip(order) {
            *y = x[i as usize];
        }
        self.simplicial.solve(&symbolic.simplicial, &mut self.x);
        self.fronts.solve(&symbolic.fronts, &mut self.x);
        for (y, &i) in self.x.iter().zip(order) {
            x[i as usize] = *y;
        }
    }
}

//! The plan of a factorization, made once from the couplings: the connected components, the order of elimination of
//! each, and the method of each.

use super::Incidence;
use super::dissection::nested_dissection;
use super::elimination::Elimination;
use super::hubs::Hubs;
use super::ordering::minimum_degree;

/// Shape of the graph of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ComponentKind {
    /// A chain.
    Path,
    /// A graph without a cycle.
    Tree,
    /// A graph with cycles.
    Cyclic,
}

/// The method by which a component is factored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FactorMethod {
    /// The whole matrix as a dense matrix, in the order given.
    Dense,
    /// Sparse, entry after entry.
    Simplicial,
    /// Sparse, in dense blocks.
    Multifrontal,
}

impl ComponentKind {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            ComponentKind::Path => "path",
            ComponentKind::Tree => "tree",
            ComponentKind::Cyclic => "cyclic",
        }
    }
}

impl FactorMethod {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            FactorMethod::Dense => "dense",
            FactorMethod::Simplicial => "simplicial",
            FactorMethod::Multifrontal => "multifrontal",
        }
    }
}

/// One connected component of the matrix, with the method and the cost of its factorization.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Component {
    /// Shape of its graph.
    pub kind: ComponentKind,
    /// Number of rows of A.
    pub rows: usize,
    /// Number of hubs: points with so many rows that their accelerations stay in the matrix as unknowns.
    pub hubs: usize,
    /// The method by which it is factored.
    pub method: FactorMethod,
    /// Entries of L, its diagonal among them.
    pub entries: u64,
    /// Floating point operations of one factorization.
    pub factor_flops: u64,
    /// Floating point operations of one solve.
    pub solve_flops: u64,
    /// Memory of its factor, approximately \[bytes\].
    pub memory: u64,
}

/// Least number of unknowns at a point that makes it a hub. A point that is eliminated into A couples all its unknowns
/// with each other. A star of 30 spokes takes 3.6 µs with this clique and 1.3 µs with a hub (star30 of `timed_solves`
/// in `multiplier/tests.rs`). Matrices with fewer unknowns at each point are mostly small and factored densely.
pub(crate) const HUB_FROM: usize = 32;

/// Least number of operations for each entry of L with which the multifrontal method is chosen. A net of 10 × 10 (9
/// operations) is as fast either way, a net of 32 × 32 (21) takes 0.14 ms in place of 0.24 ms, and a truss (4) would
/// take 1.6 times as long.
const BLOCKED_FROM: u64 = 12;

/// The order of elimination: first the unknowns that are factored entry by entry, then those that are factored in
/// fronts.
#[derive(Clone, Debug, Default)]
pub(crate) struct EliminationPlan {
    pub(crate) order: Vec<u32>,
    /// Number of unknowns before the first front.
    pub(crate) simplicial: usize,
    /// Columns of each front.
    pub(crate) widths: Vec<u32>,
    pub(crate) components: Vec<Component>,
    /// The unknown from which each component was found.
    pub(crate) found_from: Vec<u32>,
}

impl EliminationPlan {
    pub(crate) fn new(incidence: &Incidence) -> Self {
        EliminationPlan::with_hubs(incidence, &Hubs::default())
    }

    /// The plan for all unknowns. The unknowns of the hubs are numbered after the others.
    pub(crate) fn with_hubs(incidence: &Incidence, hubs: &Hubs) -> Self {
        let mut plan = EliminationPlan::default();
        let mut blocked = Vec::new();
        let extended = (!hubs.is_empty()).then(|| hubs.extended(incidence));
        let points = extended.as_ref().map_or(incidence.points(), Incidence::points);
        let mut scratch = vec![u32::MAX; points];
        for (kind, mut unknowns) in components(incidence) {
            let rows = unknowns.len();
            plan.found_from.push(unknowns[0]);
            let inside = hubs.among(incidence, &unknowns);
            let (order, elimination) = match &extended {
                Some(extended) if !inside.is_empty() => {
                    let first = unknowns.len() as u32;
                    let order = hubs.order(incidence, &unknowns, first..first + (inside.len() * hubs.width) as u32);
                    unknowns.extend(inside.iter().flat_map(|&hub| hubs.unknowns(incidence, hub)));
                    let part = extended.part(&unknowns, &mut scratch);
                    let elimination = Elimination::new(&part.permuted(&order));
                    (order, elimination)
                }
                _ => order(&incidence.part(&unknowns, &mut scratch), kind),
            };
            let method = if elimination.is_cut_short {
                FactorMethod::Simplicial
            } else if elimination.factor_flops() >= BLOCKED_FROM * elimination.entries() {
                FactorMethod::Multifrontal
            } else {
                FactorMethod::Simplicial
            };
            let (again, widths) = match method {
                FactorMethod::Multifrontal => elimination.fronts(),
                // A factor of this size is refused, so that its order does not matter.
                _ if elimination.is_cut_short => ((0..unknowns.len() as u32).collect(), Vec::new()),
                _ => (elimination.postorder(), Vec::new()),
            };
            let order = again.iter().map(|&k| unknowns[order[k as usize] as usize]);
            match method {
                FactorMethod::Multifrontal => blocked.extend(order),
                _ => plan.order.extend(order),
            }
            plan.widths.extend(widths);
            plan.components.push(Component {
                kind,
                rows,
                hubs: inside.len(),
                method,
                entries: elimination.entries(),
                factor_flops: elimination.factor_flops(),
                solve_flops: 4 * elimination.entries() - 3 * unknowns.len() as u64,
                memory: memory(method, &elimination),
            });
        }
        plan.simplicial = plan.order.len();
        plan.order.extend(blocked);
        plan
    }
}

impl Component {
    /// This component in a matrix that is small enough to be factored densely as a whole.
    pub(crate) fn dense(self) -> Self {
        let n = self.rows as u64;
        Component {
            method: FactorMethod::Dense,
            hubs: 0,
            entries: n * (n + 1) / 2,
            factor_flops: n * n * n / 3,
            solve_flops: 2 * n * n,
            memory: 8 * n * n,
            ..self
        }
    }
}

/// Memory of the numbers and indices of L [bytes]. Fronts add stored zeros and the updates on the stacks, about twice
/// the largest update.
fn memory(method: FactorMethod, elimination: &Elimination) -> u64 {
    let largest = u64::from(elimination.below.iter().copied().max().unwrap_or(0));
    match method {
        FactorMethod::Multifrontal => 16 * elimination.entries() + 16 * largest * largest,
        _ => 20 * elimination.entries(),
    }
}

/// An order of elimination with little fill, and its symbolic elimination.
fn order(part: &Incidence, kind: ComponentKind) -> (Vec<u32>, Elimination) {
    let n = part.unknowns();
    let analysed = |order: Vec<u32>| {
        let elimination = Elimination::new(&part.permuted(&order));
        (order, elimination)
    };
    if kind != ComponentKind::Cyclic {
        return analysed(leaves_first(part));
    }
    let dissected = analysed(nested_dissection(part));
    // On long thin graphs minimum degree has less fill than dissection and is quick; on large nets it has more and is
    // slow.
    match minimum_degree(part, n, 100 * n + 200_000).map(analysed) {
        Some(other) if other.1.factor_flops() < dissected.1.factor_flops() => other,
        _ => dissected,
    }
}

/// The connected components, each with its unknowns; the last unknown of a path or a tree is at an end of it.
pub(crate) fn components(incidence: &Incidence) -> Vec<(ComponentKind, Vec<u32>)> {
    let mut components = Vec::new();
    let mut seen = vec![false; incidence.unknowns()];
    let mut seen_point = vec![false; incidence.points()];
    for u in 0..incidence.unknowns() as u32 {
        if seen[u as usize] {
            continue;
        }
        seen[u as usize] = true;
        let mut unknowns = vec![u];
        let (mut next, mut points, mut touches, mut crowded) = (0, 0, 0, false);
        while next < unknowns.len() {
            for &p in incidence.points_of(unknowns[next]) {
                touches += 1;
                if seen_point[p as usize] {
                    continue;
                }
                seen_point[p as usize] = true;
                points += 1;
                crowded |= incidence.unknowns_at(p).len() > 2;
                for &other in incidence.unknowns_at(p) {
                    if !seen[other as usize] {
                        seen[other as usize] = true;
                        unknowns.push(other);
                    }
                }
            }
            crowded |= incidence.points_of(unknowns[next]).len() > 2;
            next += 1;
        }
        let kind = match (unknowns.len() + points == touches + 1 || points == 0, crowded) {
            (false, _) => ComponentKind::Cyclic,
            (true, true) => ComponentKind::Tree,
            (true, false) => ComponentKind::Path,
        };
        components.push((kind, unknowns));
    }
    components
}

/// The order of a tree without fill: from the leaves to the unknown that is last in the component.
fn leaves_first(tree: &Incidence) -> Vec<u32> {
    let root = tree.unknowns() as u32 - 1;
    let mut seen = vec![false; tree.unknowns()];
    let mut seen_point = vec![false; tree.points()];
    let mut order = Vec::with_capacity(tree.unknowns());
    // Depth first, so that subtrees stay together. Each point is entered once, so the time is linear for any degree.
    let mut stack = vec![root];
    seen[root as usize] = true;
    while let Some(u) = stack.pop() {
        order.push(u);
        for &p in tree.points_of(u) {
            if !seen_point[p as usize] {
                seen_point[p as usize] = true;
                for &other in tree.unknowns_at(p) {
                    if !seen[other as usize] {
                        seen[other as usize] = true;
                        stack.push(other);
                    }
                }
            }
        }
    }
    order.reverse();
    order
}

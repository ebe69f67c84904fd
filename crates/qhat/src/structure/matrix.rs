//! The structure of A = J W Jᵀ: its pattern, its order of elimination and the contributions to each entry.
//!
//! Two rows are coupled only if they share a particle that can move, so A is as sparse as the graph of rods. Which
//! pairs of blocks meet in which entry never changes once a System is built. `multiplier/matrix.rs` writes the numbers.

use crate::constraint::{Layout, Softness};
use crate::linalg::{Component, DENSE_UP_TO, EliminationPlan, Hubs, Incidence, Pattern, Symbolic};
use crate::space::ParticleId;
use std::sync::Arc;

/// The structure of A: its pattern, the contributions to each entry, and the plan of its factorization.
#[derive(Clone, Debug, Default)]
pub(crate) struct MatrixStructure {
    /// The pattern of A, its unknowns in the order of elimination.
    pub(crate) pattern: Pattern,
    /// `order[k]` is the number of the row or of the unknown of a hub that is eliminated k-th; unknowns of hubs are
    /// numbered after the rows.
    pub(crate) order: Vec<u32>,
    pub(crate) on_hubs: Vec<OnHub>,
    /// For each particle that can move: its blocks of J and the slots to which the products of their pairs are added.
    pub(crate) meeting: Vec<Meeting>,
    pub(crate) blocks: Vec<u32>,
    pub(crate) slots: Vec<u32>,
    /// Rows whose row of A is always zero: rows all of whose particles are fixed, and compliant rows, which act as
    /// forces.
    pub(crate) inert: Vec<bool>,
    pub(crate) symbolic: Arc<Symbolic>,
    pub(crate) components: Vec<Component>,
}

/// One entry of B.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnHub {
    /// The position of its row in the order of elimination.
    pub(crate) row: u32,
    pub(crate) slot: u32,
    /// The index of its number in J.
    pub(crate) number: u32,
    pub(crate) particle: ParticleId,
}

/// The blocks of J that belong to one particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    pub(crate) particle: ParticleId,
    /// Number of its blocks of J.
    pub(crate) blocks: u32,
}

/// The decisions about A that are made before any large array is allocated for it.
#[derive(Clone, Debug)]
pub(crate) struct MatrixPlan {
    incidence: Incidence,
    hubs: Hubs,
    plan: EliminationPlan,
    inert: Vec<bool>,
    /// The components of A, without the rows that cannot act.
    pub(crate) components: Vec<Component>,
    /// The row from which each component was found.
    found_from: Vec<usize>,
}

impl MatrixPlan {
    pub(crate) fn new(layout: &Layout, W: &[f64], softness: &[Softness], dimension: usize) -> Self {
        let m = layout.row_count();
        let entries = |row: usize| layout.start[row]..layout.start[row + 1];
        let moves = |e: &usize| W[layout.particle[*e].0] > 0.0;
        let acts = |row: usize| softness[row].is_rigid() && entries(row).any(|e| moves(&e));
        let inert: Vec<bool> = (0..m).map(|row| !acts(row)).collect();
        let points = |row: usize| {
            let is_inert = inert[row];
            let acting = entries(row).filter(move |_| !is_inert).filter(moves);
            acting.map(|e| layout.particle[e].0 as u32)
        };
        let incidence = Incidence::new(W.len(), (0..m).map(points));
        let hubs = Hubs::new(&incidence, dimension);
        let plan = EliminationPlan::with_hubs(&incidence, &hubs);
        let acting = plan.components.iter().zip(&plan.found_from).filter(|&(_, &row)| !inert[row as usize]);
        let found_from = acting.clone().map(|(_, &row)| row as usize).collect();
        let components = acting.map(|(component, _)| *component);
        let components =
            if m <= DENSE_UP_TO { components.map(Component::dense).collect() } else { components.collect() };
        MatrixPlan { incidence, hubs, plan, inert, components, found_from }
    }

    /// A row of the component whose factor takes most memory, and the number of its rows.
    pub(crate) fn largest(&self) -> Option<(usize, usize)> {
        let all = self.components.iter().zip(&self.found_from);
        let (largest, &row) = all.max_by_key(|(component, _)| component.memory)?;
        Some((row, largest.rows))
    }

    /// Memory of the factor [bytes].
    pub(crate) fn memory(&self) -> u64 {
        self.components.iter().map(|component| component.memory).sum()
    }
}

impl MatrixStructure {
    pub(crate) fn new(layout: &Layout, W: &[f64], planned: MatrixPlan) -> Self {
        let MatrixPlan { incidence, hubs, plan, inert, components, .. } = planned;
        let m = layout.row_count();
        // A small matrix is factored densely, in the order of its rows.
        let order = if m <= DENSE_UP_TO { (0..m as u32).collect() } else { plan.order.clone() };
        let permuted = hubs.extended(&incidence).permuted(&order);
        let pattern = Pattern::of_incidence(&permuted);
        let negative = order.iter().map(|&row| row as usize >= m).collect();
        let symbolic = Arc::new(Symbolic::new(&pattern, &plan, None, negative));
        let mut structure = MatrixStructure {
            pattern,
            order,
            on_hubs: Vec::new(),
            meeting: Vec::new(),
            blocks: Vec::new(),
            slots: Vec::new(),
            inert,
            symbolic,
            components,
        };
        structure.meet(layout, W.len(), &permuted);
        structure.touch_hubs(layout, &incidence, &hubs);
        structure
    }

    /// Finds the slots of B.
    fn touch_hubs(&mut self, layout: &Layout, incidence: &Incidence, hubs: &Hubs) {
        let mut place = vec![0; if hubs.is_empty() { 0 } else { self.order.len() }];
        for (k, &row) in self.order.iter().enumerate().take(place.len()) {
            place[row as usize] = k;
        }
        for row in (0..if hubs.is_empty() { 0 } else { self.inert.len() }).filter(|&row| !self.inert[row]) {
            for e in layout.start[row]..layout.start[row + 1] {
                let particle = layout.particle[e];
                let Some(hub) = hubs.number(particle.0 as u32) else { continue };
                for (c, unknown) in hubs.unknowns(incidence, hub).enumerate() {
                    let (k, l) = (place[row], place[unknown as usize]);
                    if let Some(slot) = self.pattern.slot(k.max(l), k.min(l)) {
                        let number = (e * hubs.width + c) as u32;
                        self.on_hubs.push(OnHub { row: k as u32, slot: slot as u32, number, particle });
                    }
                }
            }
        }
        // Hub after hub, the rows of each ascending.
        self.on_hubs.sort_by_key(|on_hub| on_hub.particle);
    }

    /// Finds the slots of all pairs of rows at each particle. The particles come in the order in which elimination
    /// touches them.
    fn meet(&mut self, layout: &Layout, particles: usize, incidence: &Incidence) {
        let row_of = |unknown: u32| Some(self.order[unknown as usize] as usize).filter(|&row| row < self.inert.len());
        let blocks = blocks_at(incidence, layout, row_of);
        let mut seen = vec![false; particles];
        for first in 0..self.order.len() as u32 {
            for &p in incidence.points_of(first) {
                // A point beyond the particles belongs to a hub; its unknowns share it.
                if p as usize >= particles || std::mem::replace(&mut seen[p as usize], true) {
                    continue;
                }
                let rows = incidence.unknowns_at(p);
                self.blocks.extend(&blocks[incidence.first_at(p)..][..rows.len()]);
                for (k, &left) in rows.iter().enumerate() {
                    let slots = rows[..=k].iter().filter_map(|&right| self.pattern.slot(left as usize, right as usize));
                    self.slots.extend(slots.map(|slot| slot as u32));
                }
                self.meeting.push(Meeting { particle: ParticleId(p as usize), blocks: rows.len() as u32 });
            }
        }
    }

    /// Whether a number of the order belongs to an unknown of a hub and not to a row.
    pub(crate) fn is_hub(&self, row: u32) -> bool {
        row as usize >= self.inert.len()
    }
}

/// The block of J of each row at each point, in the order of the lists `unknowns_at`, point after point. `row_of` gives
/// the row of an unknown; `None` for an unknown of a hub. It takes time in proportion to the number of blocks, also
/// where a row touches very many particles.
pub(crate) fn blocks_at(incidence: &Incidence, layout: &Layout, row_of: impl Fn(u32) -> Option<usize>) -> Vec<u32> {
    let mut next: Vec<usize> = (0..incidence.points() as u32).map(|p| incidence.first_at(p)).collect();
    let mut blocks = vec![0; layout.particle.len()];
    for unknown in 0..incidence.unknowns() as u32 {
        // A row that cannot act touches no point; a particle that is fixed, or a hub, has no row in the incidence.
        let Some(row) = row_of(unknown).filter(|_| !incidence.points_of(unknown).is_empty()) else { continue };
        for e in layout.start[row]..layout.start[row + 1] {
            let point = layout.particle[e].0;
            if !incidence.unknowns_at(point as u32).is_empty() {
                blocks[next[point]] = e as u32;
                next[point] += 1;
            }
        }
    }
    blocks
}

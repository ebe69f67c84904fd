//! Hubs: points with very many unknowns.
//!
//! A point adds B W Bᵀ to the matrix, a clique of all unknowns that touch the point. If a hub gets unknowns of its own,
//! a = W Bᵀ x, it adds only B:
//!
//! ```text
//! (A′ + B W Bᵀ) x = b   ⇔   [ A′   B  ] [x]   [b]
//!                           [ Bᵀ −W⁻¹ ] [a] = [0]
//! ```
//!
//! This matrix is quasi-definite as long as A′ is positive definite: any order of elimination works, with negative
//! pivots for a. A′ is singular if a connected piece has more unknowns than its points other than hubs have
//! coordinates. Some of these unknowns are then eliminated after the hub. Source: Vanderbei, Symmetric quasidefinite
//! matrices, SIAM J. Optim. 5 (1995).

use super::Incidence;
use super::plan::{EliminationPlan, HUB_FROM};
use std::ops::Range;

/// The points that are hubs, and the number of unknowns that each hub adds: the dimension of space.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hubs {
    pub(crate) points: Vec<u32>,
    pub(crate) width: usize,
}

impl Hubs {
    pub(crate) fn new(incidence: &Incidence, width: usize) -> Self {
        let crowded = |&p: &u32| incidence.unknowns_at(p).len() >= HUB_FROM;
        Hubs { points: (0..incidence.points() as u32).filter(crowded).collect(), width }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Number of unknowns that the hubs add.
    pub(crate) fn unknown_count(&self) -> usize {
        self.points.len() * self.width
    }

    /// The number of the hub at a point; `None` if the point is no hub.
    pub(crate) fn number(&self, point: u32) -> Option<usize> {
        self.points.binary_search(&point).ok()
    }

    /// The unknowns of a hub.
    pub(crate) fn unknowns(&self, incidence: &Incidence, hub: usize) -> Range<u32> {
        let first = incidence.unknowns() + hub * self.width;
        first as u32..(first + self.width) as u32
    }

    /// The incidence with the unknowns of the hubs. The point of a hub is replaced by one point for each of its
    /// unknowns, shared with the unknowns of the hub.
    pub(crate) fn extended(&self, incidence: &Incidence) -> Incidence {
        let mut points = incidence.points() as u32;
        let mut of_hubs = vec![Vec::new(); self.points.len()];
        let mut lists: Vec<Vec<u32>> = Vec::with_capacity(incidence.unknowns() + self.unknown_count());
        for u in 0..incidence.unknowns() as u32 {
            let mut list = Vec::new();
            for &p in incidence.points_of(u) {
                match self.number(p) {
                    None => list.push(p),
                    Some(hub) => {
                        list.push(points);
                        of_hubs[hub].push(points);
                        points += 1;
                    }
                }
            }
            lists.push(list);
        }
        for list in of_hubs {
            lists.extend(std::iter::repeat_n(list, self.width));
        }
        Incidence::new(points as usize, lists.into_iter())
    }

    /// The hubs that any of these unknowns touches, ascending.
    pub(crate) fn among(&self, incidence: &Incidence, unknowns: &[u32]) -> Vec<usize> {
        if self.is_empty() {
            return Vec::new();
        }
        let points = unknowns.iter().flat_map(|&u| incidence.points_of(u));
        let mut hubs: Vec<usize> = points.filter_map(|&p| self.number(p)).collect();
        hubs.sort_unstable();
        hubs.dedup();
        hubs
    }

    /// Order of elimination of a component, as indices into `unknowns` and then the numbers of its hubs' unknowns:
    /// first the unknowns that leave A′ regular, then the hubs, then the unknowns that would make A′ singular.
    pub(crate) fn order(&self, incidence: &Incidence, unknowns: &[u32], hubs: Range<u32>) -> Vec<u32> {
        let inner = |u: u32| incidence.points_of(u).iter().copied().filter(|&p| self.number(p).is_none());
        let rest = Incidence::new(incidence.points(), unknowns.iter().map(|&u| inner(u)));
        let late = self.late(incidence, unknowns, &rest);
        let plan = EliminationPlan::new(&rest);
        let (mut order, mut last) = (Vec::with_capacity(unknowns.len() + hubs.len()), Vec::new());
        for k in plan.order {
            if late[k as usize] { last.push(k) } else { order.push(k) }
        }
        order.extend(hubs);
        order.append(&mut last);
        order
    }

    /// Whether each unknown is eliminated after the hubs. A piece that is left when the hubs are removed can hold
    /// `width` unknowns for each of its points; as many unknowns as exceed this number, chosen among the unknowns that
    /// touch a hub, come after the hubs.
    fn late(&self, incidence: &Incidence, unknowns: &[u32], rest: &Incidence) -> Vec<bool> {
        let mut late = vec![false; unknowns.len()];
        let mut counted = vec![false; rest.points()];
        for (_, piece) in super::plan::components(rest) {
            let mut points = 0;
            for &p in piece.iter().flat_map(|&u| rest.points_of(u)) {
                points += usize::from(!std::mem::replace(&mut counted[p as usize], true));
            }
            let beyond = piece.len().saturating_sub(points * self.width);
            let at_hub = |&&k: &&u32| rest.points_of(k).len() < incidence.points_of(unknowns[k as usize]).len();
            for &k in piece.iter().filter(at_hub).take(beyond) {
                late[k as usize] = true;
            }
        }
        late
    }
}

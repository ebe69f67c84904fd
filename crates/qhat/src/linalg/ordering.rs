//! Minimum degree ordering: eliminate, again and again, the unknown that is coupled to the fewest others.
//!
//! The graph is stored as a quotient graph. A point is an *element*, the clique of the unknowns that touch the point.
//! An eliminated unknown merges its elements into one element, so the storage never grows beyond the input. Ties go to
//! the lower index, so the order depends on the pattern only. Source: George and Liu, The evolution of the minimum
//! degree ordering algorithm, SIAM Review 31 (1989).

use super::Incidence;
use std::collections::BTreeSet;

/// The order in which to eliminate the first `free` unknowns; the unknowns after them stay and count as neighbours.
/// `None` if more than `budget` neighbours were visited.
pub(crate) fn minimum_degree(incidence: &Incidence, free: usize, mut budget: usize) -> Option<Vec<u32>> {
    let mut graph = QuotientGraph::new(incidence);
    let mut degree: Vec<usize> = (0..free as u32).map(|i| graph.degree(i)).collect();
    let mut queue: BTreeSet<(usize, u32)> = degree.iter().copied().zip(0..).collect();
    let mut order = Vec::with_capacity(free);
    while let Some((_, pivot)) = queue.pop_first() {
        order.push(pivot);
        let mut clique = graph.eliminate(pivot);
        clique.retain(|&i| (i as usize) < free);
        if clique.len() == queue.len() {
            // The rest is one clique, so all orders of the rest cost the same.
            order.extend(clique);
            break;
        }
        let before = graph.looked_at;
        for i in clique {
            let now = graph.degree(i);
            queue.remove(&(degree[i as usize], i));
            queue.insert((now, i));
            degree[i as usize] = now;
        }
        budget = budget.checked_sub(graph.looked_at - before)?;
    }
    Some(order)
}

struct QuotientGraph {
    /// The elements that each unknown belongs to.
    elements: Vec<Vec<u32>>,
    /// The unknowns of each element. The elements that were points come first, then the elements that pivots left.
    members: Vec<Vec<u32>>,
    points: usize,
    /// `mark[i] == stamp` means that i was visited in the present sweep.
    mark: Vec<usize>,
    stamp: usize,
    looked_at: usize,
}

impl QuotientGraph {
    fn new(incidence: &Incidence) -> Self {
        let (n, points) = (incidence.unknowns(), incidence.points());
        let mut members: Vec<Vec<u32>> = (0..points as u32).map(|p| incidence.unknowns_at(p).to_vec()).collect();
        members.resize(points + n, Vec::new());
        QuotientGraph {
            elements: (0..n as u32).map(|u| incidence.points_of(u).to_vec()).collect(),
            members,
            points,
            mark: vec![0; n],
            stamp: 0,
            looked_at: 0,
        }
    }

    /// Turns an unknown into an element and returns its members, ascending.
    fn eliminate(&mut self, pivot: u32) -> Vec<u32> {
        self.stamp += 1;
        self.mark[pivot as usize] = self.stamp;
        let mut clique = Vec::new();
        let absorbed = std::mem::take(&mut self.elements[pivot as usize]);
        for &e in &absorbed {
            for i in std::mem::take(&mut self.members[e as usize]) {
                if self.mark[i as usize] != self.stamp {
                    self.mark[i as usize] = self.stamp;
                    clique.push(i);
                }
            }
        }
        clique.sort_unstable();
        let element = self.points as u32 + pivot;
        for &i in &clique {
            self.elements[i as usize].retain(|e| !absorbed.contains(e));
            self.elements[i as usize].push(element);
        }
        self.members[element as usize].clone_from(&clique);
        clique
    }

    /// Number of unknowns that i is coupled to.
    fn degree(&mut self, i: u32) -> usize {
        self.stamp += 1;
        self.mark[i as usize] = self.stamp;
        let mut degree = 0;
        for &e in &self.elements[i as usize] {
            self.looked_at += self.members[e as usize].len();
            for &j in &self.members[e as usize] {
                if self.mark[j as usize] != self.stamp {
                    self.mark[j as usize] = self.stamp;
                    degree += 1;
                }
            }
        }
        degree
    }
}

//! Minimum degree ordering: eliminate, again and again, the unknown that is coupled to the fewest others.
//!
//! Kept as a quotient graph: an eliminated unknown becomes an *element*, the clique of the unknowns it was coupled to, so
//! that storage never grows beyond the input. Ties go to the lower index: the order depends on nothing but the pattern.
//! Source: George and Liu, The evolution of the minimum degree ordering algorithm, SIAM Review 31 (1989).

use super::Pattern;
use std::collections::BTreeSet;

/// The order in which to eliminate the unknowns: `order[k]` is the k-th.
pub(crate) fn minimum_degree(pattern: &Pattern) -> Vec<usize> {
    let mut graph = QuotientGraph::new(pattern);
    let mut queue: BTreeSet<(usize, usize)> = graph.degree.iter().copied().zip(0..).collect();
    let mut order = Vec::with_capacity(pattern.order());
    while let Some((_, pivot)) = queue.pop_first() {
        order.push(pivot);
        let clique = graph.eliminate(pivot);
        if clique.len() == queue.len() {
            // All that is left is one clique: any order of it is as good as any other.
            order.extend(clique.iter().copied());
            break;
        }
        for &i in &clique {
            let degree = graph.current_degree(i);
            queue.remove(&(graph.degree[i], i));
            queue.insert((degree, i));
            graph.degree[i] = degree;
        }
    }
    order
}

struct QuotientGraph {
    /// Direct couplings of an unknown to unknowns, those inside a common element left out.
    neighbours: Vec<Vec<usize>>,
    /// Elements that an unknown belongs to.
    elements: Vec<Vec<usize>>,
    /// The unknowns of an element, by the pivot it came from.
    members: Vec<Vec<usize>>,
    degree: Vec<usize>,
    /// `mark[i] == stamp` says that i was seen in the present sweep.
    mark: Vec<usize>,
    stamp: usize,
}

impl QuotientGraph {
    fn new(pattern: &Pattern) -> Self {
        let n = pattern.order();
        let mut neighbours = vec![Vec::new(); n];
        for i in 0..n {
            for slot in pattern.start[i]..pattern.diagonal(i) {
                let j = pattern.column[slot];
                neighbours[i].push(j);
                neighbours[j].push(i);
            }
        }
        let degree = neighbours.iter().map(Vec::len).collect();
        QuotientGraph {
            neighbours,
            elements: vec![Vec::new(); n],
            members: vec![Vec::new(); n],
            degree,
            mark: vec![0; n],
            stamp: 0,
        }
    }

    /// Turns an unknown into an element and returns its members, ascending.
    fn eliminate(&mut self, pivot: usize) -> Vec<usize> {
        self.stamp += 1;
        self.mark[pivot] = self.stamp;
        let mut clique = Vec::new();
        let absorbed = std::mem::take(&mut self.elements[pivot]);
        let lists = absorbed.iter().map(|&e| std::mem::take(&mut self.members[e]));
        for i in lists.flatten().chain(std::mem::take(&mut self.neighbours[pivot])) {
            if self.mark[i] != self.stamp {
                self.mark[i] = self.stamp;
                clique.push(i);
            }
        }
        clique.sort_unstable();
        for &i in &clique {
            let (mark, stamp) = (&self.mark, self.stamp);
            self.neighbours[i].retain(|&j| mark[j] != stamp);
            self.elements[i].retain(|e| !absorbed.contains(e));
            self.elements[i].push(pivot);
        }
        self.members[pivot].clone_from(&clique);
        clique
    }

    /// Number of unknowns that i is coupled to, directly or through an element.
    fn current_degree(&mut self, i: usize) -> usize {
        self.stamp += 1;
        self.mark[i] = self.stamp;
        let mut degree = 0;
        let through_elements = self.elements[i].iter().flat_map(|&e| self.members[e].iter());
        for &j in through_elements.chain(&self.neighbours[i]) {
            if self.mark[j] != self.stamp {
                self.mark[j] = self.stamp;
                degree += 1;
            }
        }
        degree
    }
}

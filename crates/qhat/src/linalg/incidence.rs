//! Incidence of unknowns and points: two unknowns are coupled if they share a point.
//!
//! For a graph of rods, a rod is an unknown and a particle a point. The incidence is far smaller than the pattern of
//! the matrix, where every point becomes a clique.

#[cfg(test)]
use super::Pattern;

/// The points of every unknown and the unknowns at every point, each as one long list with the start of every part; the
/// points of an unknown ascend.
#[derive(Clone, Debug, Default)]
pub(crate) struct Incidence {
    start: Vec<u32>,
    point: Vec<u32>,
    at_start: Vec<u32>,
    at: Vec<u32>,
}

impl Incidence {
    /// The incidence of unknowns whose points are given, unknown after unknown.
    pub(crate) fn new<I: IntoIterator<Item = u32>>(points: usize, unknowns: impl Iterator<Item = I>) -> Self {
        let mut incidence = Incidence { start: vec![0], at_start: vec![0; points + 1], ..Incidence::default() };
        for list in unknowns {
            incidence.point.extend(list);
            incidence.start.push(incidence.point.len() as u32);
        }
        for &p in &incidence.point {
            incidence.at_start[p as usize + 1] += 1;
        }
        for p in 0..points {
            incidence.at_start[p + 1] += incidence.at_start[p];
        }
        let mut next = incidence.at_start.clone();
        incidence.at = vec![0; incidence.point.len()];
        for u in 0..incidence.unknowns() {
            for e in incidence.start[u]..incidence.start[u + 1] {
                let place = &mut next[incidence.point[e as usize] as usize];
                incidence.at[*place as usize] = u as u32;
                *place += 1;
            }
        }
        incidence
    }

    /// The incidence of a pattern: every coupling becomes a point.
    #[cfg(test)]
    pub(crate) fn of_pattern(pattern: &Pattern) -> Self {
        let n = pattern.order();
        let mut lists = vec![Vec::new(); n];
        let mut points = 0;
        for i in 0..n {
            for slot in pattern.start[i]..pattern.diagonal(i) {
                lists[i].push(points);
                lists[pattern.column[slot]].push(points);
                points += 1;
            }
        }
        Incidence::new(points as usize, lists.into_iter())
    }

    /// The part with these unknowns and their points, both numbered anew in the order given. `scratch` has one number
    /// for each point, all `u32::MAX` before and after.
    pub(crate) fn part(&self, unknowns: &[u32], scratch: &mut [u32]) -> Self {
        let mut points = 0;
        let mut lists = Vec::with_capacity(unknowns.len());
        for &u in unknowns {
            let number = |&p: &u32| {
                let local = &mut scratch[p as usize];
                if *local == u32::MAX {
                    *local = points;
                    points += 1;
                }
                *local
            };
            lists.push(self.points_of(u).iter().map(number).collect::<Vec<u32>>());
        }
        for &u in unknowns {
            for &p in self.points_of(u) {
                scratch[p as usize] = u32::MAX;
            }
        }
        Incidence::new(points as usize, lists.into_iter())
    }

    /// The same incidence with `order[k]` as unknown k.
    pub(crate) fn permuted(&self, order: &[u32]) -> Self {
        Incidence::new(self.points(), order.iter().map(|&u| self.points_of(u).iter().copied()))
    }

    pub(crate) fn unknowns(&self) -> usize {
        self.start.len() - 1
    }

    pub(crate) fn points(&self) -> usize {
        self.at_start.len() - 1
    }

    pub(crate) fn points_of(&self, unknown: u32) -> &[u32] {
        &self.point[self.start[unknown as usize] as usize..self.start[unknown as usize + 1] as usize]
    }

    /// The unknowns at a point, ascending.
    pub(crate) fn unknowns_at(&self, point: u32) -> &[u32] {
        &self.at[self.at_start[point as usize] as usize..self.at_start[point as usize + 1] as usize]
    }

    /// The place of the first unknown at a point where the lists of all points stand one after the other.
    pub(crate) fn first_at(&self, point: u32) -> usize {
        self.at_start[point as usize] as usize
    }

    /// The columns left of the diagonal in row k of the coupling matrix, ascending, each once.
    pub(crate) fn columns(&self, k: u32, out: &mut Vec<u32>) {
        out.clear();
        for &p in self.points_of(k) {
            out.extend(self.unknowns_at(p).iter().take_while(|&&u| u < k));
        }
        out.sort_unstable();
        out.dedup();
    }
}

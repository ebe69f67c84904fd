//! Symbolic elimination in a given order: the elimination tree, the entries of L, and the columns that form fronts.
//!
//! Column j of L has its first entry below the diagonal in row parent(j). The columns of a *front* are eliminated as
//! one dense block. Source: Liu, The role of elimination trees in sparse factorization, SIAM J. Matrix Anal. 11 (1990);
//! Ashcraft and Grimes, The influence of relaxed supernode partitions on the multifrontal method, ACM TOMS 15 (1989).

use super::Incidence;

pub(crate) const NONE: u32 = u32::MAX;

/// The most entries of L that are counted. With this many a factor takes 2.5 GiB, more than the builder of a system
/// accepts, and a count to the end could take hours.
const MOST_ENTRIES: u64 = 1 << 27;

/// The elimination tree and the number of entries below the diagonal in each column of L.
#[derive(Clone, Debug)]
pub(crate) struct Elimination {
    pub(crate) parent: Vec<u32>,
    pub(crate) below: Vec<u32>,
    /// Whether the count ended early, at `MOST_ENTRIES`.
    pub(crate) is_cut_short: bool,
}

impl Elimination {
    /// The elimination of the coupling matrix, with the unknowns eliminated in the order of their numbers.
    pub(crate) fn new(incidence: &Incidence) -> Self {
        let n = incidence.unknowns();
        let (mut parent, mut seen, mut below) = (vec![NONE; n], vec![NONE; n], vec![0; n]);
        let mut columns = Vec::new();
        let mut entries = n as u64;
        for k in 0..n as u32 {
            if entries > MOST_ENTRIES {
                break;
            }
            seen[k as usize] = k;
            incidence.columns(k, &mut columns);
            for &column in &columns {
                let mut i = column as usize;
                while seen[i] != k {
                    if parent[i] == NONE {
                        parent[i] = k;
                    }
                    below[i] += 1;
                    entries += 1;
                    seen[i] = k;
                    i = parent[i] as usize;
                }
            }
        }
        Elimination { parent, below, is_cut_short: entries > MOST_ENTRIES }
    }

    /// Entries of L, its diagonal among them.
    pub(crate) fn entries(&self) -> u64 {
        self.below.iter().map(|&c| 1 + u64::from(c)).sum()
    }

    /// Operations of one factorization.
    pub(crate) fn factor_flops(&self) -> u64 {
        self.below.iter().map(|&c| u64::from(c) * (u64::from(c) + 2)).sum()
    }

    /// The unknowns in an order that keeps every subtree together and puts children before their parents.
    pub(crate) fn postorder(&self) -> Vec<u32> {
        let single = |j: usize| Front { columns: vec![j as u32], below: self.below[j], zeros: 0 };
        let fronts: Vec<Front> = (0..self.parent.len()).map(single).collect();
        postorder(&fronts, &self.parent).0
    }

    /// The unknowns in the order of fronts, and the number of columns of each front.
    pub(crate) fn fronts(&self) -> (Vec<u32>, Vec<u32>) {
        let n = self.parent.len();
        let mut fronts: Vec<Front> = Vec::with_capacity(n);
        let mut children: Vec<Vec<u32>> = Vec::new();
        let mut waiting: Vec<Vec<u32>> = vec![Vec::new(); n];
        for j in 0..n {
            let mut front = Front { columns: vec![j as u32], below: self.below[j], zeros: 0 };
            let mut kept = Vec::new();
            let mut sons = std::mem::take(&mut waiting[j]);
            // The child with the most rows below comes first, because its merger costs the fewest stored zeros and the
            // other mergers depend on it.
            sons.sort_by_key(|&s| (std::cmp::Reverse(fronts[s as usize].below), s));
            for s in sons {
                match fronts[s as usize].merged(&front) {
                    Some(both) => {
                        front = both;
                        kept.append(&mut children[s as usize]);
                        fronts[s as usize].columns = Vec::new();
                    }
                    None => kept.push(s),
                }
            }
            let number = fronts.len() as u32;
            if self.parent[j] != NONE {
                waiting[self.parent[j] as usize].push(number);
            }
            fronts.push(front);
            children.push(kept);
        }
        let mut parent = vec![NONE; fronts.len()];
        for (f, sons) in children.iter().enumerate() {
            for &s in sons {
                parent[s as usize] = f as u32;
            }
        }
        postorder(&fronts, &parent)
    }
}

/// Columns that are eliminated together as one dense block, with the number of rows below them.
#[derive(Clone, Debug)]
struct Front {
    columns: Vec<u32>,
    below: u32,
    zeros: u64,
}

impl Front {
    /// This front merged with its parent, if the merger is worth the zeros that it has to store.
    fn merged(&self, parent: &Front) -> Option<Front> {
        let (k, up) = (self.columns.len() as u64, parent.columns.len() as u64);
        // The rows of a front lie among the columns and rows of its parent.
        let zeros = self.zeros + parent.zeros + k * (up + u64::from(parent.below) - u64::from(self.below));
        let columns = k + up;
        let entries = columns * (columns + 1) / 2 + columns * u64::from(parent.below);
        let share = zeros as f64 / entries as f64;
        // On nets with 32 to 316 points a side, half and twice these limits take the same time within 5 %.
        let allowed = match columns {
            ..=8 => 0.4,
            9..=16 => 0.2,
            17..=32 => 0.15,
            33..=64 => 0.1,
            _ => 0.05,
        };
        (zeros == self.zeros + parent.zeros || share <= allowed).then(|| Front {
            columns: self.columns.iter().chain(&parent.columns).copied().collect(),
            below: parent.below,
            zeros,
        })
    }
}

/// The columns of all fronts that are not empty, subtree after subtree, and the number of columns of each.
fn postorder(fronts: &[Front], parent: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let (mut first, mut next) = (vec![NONE; fronts.len()], vec![NONE; fronts.len()]);
    let mut roots = Vec::new();
    for f in (0..fronts.len()).rev() {
        if fronts[f].columns.is_empty() {
            continue;
        }
        match parent[f] {
            NONE => roots.push(f as u32),
            up => {
                next[f] = first[up as usize];
                first[up as usize] = f as u32;
            }
        }
    }
    let (mut order, mut widths) = (Vec::new(), Vec::new());
    while let Some(root) = roots.pop() {
        let mut stack = vec![root];
        while let Some(&f) = stack.last() {
            let child = first[f as usize];
            if child == NONE {
                order.extend(&fronts[f as usize].columns);
                widths.push(fronts[f as usize].columns.len() as u32);
                stack.pop();
            } else {
                first[f as usize] = next[child as usize];
                stack.push(child);
            }
        }
    }
    (order, widths)
}

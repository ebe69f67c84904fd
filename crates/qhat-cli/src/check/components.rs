//! The connected components of A, with the cost of their factorization.

use crate::print::count;
use qhat::{Component, FactorMethod};
use serde::Serialize;

/// Equal connected components of A.
#[derive(Debug, Serialize)]
pub(super) struct Components {
    pub(super) count: usize,
    kind: &'static str,
    rows: usize,
    hubs: usize,
    method: &'static str,
    entries_of_l: u64,
    factor_flops: u64,
    solve_flops: u64,
    memory_bytes: u64,
}

impl Components {
    /// The components of a system, equal ones in one entry, the largest first.
    pub(super) fn alike(components: &[Component]) -> Vec<Self> {
        let mut sorted: Vec<&Component> = components.iter().collect();
        sorted.sort_by_key(|c| (std::cmp::Reverse(c.rows), c.kind.name(), c.hubs, c.factor_flops));
        let groups = sorted.chunk_by(|a, b| a == b);
        groups
            .map(|group| Components {
                count: group.len(),
                kind: group[0].kind.name(),
                rows: group[0].rows,
                hubs: group[0].hubs,
                method: group[0].method.name(),
                entries_of_l: group[0].entries,
                factor_flops: group[0].factor_flops,
                solve_flops: group[0].solve_flops,
                memory_bytes: group[0].memory,
            })
            .collect()
    }

    /// The line of the report.
    pub(super) fn in_words(&self) -> String {
        let how_many = if self.count == 1 { String::new() } else { format!("{} times ", self.count) };
        let hubs = if self.hubs == 0 { String::new() } else { format!(" with {}", count(self.hubs, "hub")) };
        let mut words = format!("{how_many}{}{hubs}, {}: {}", self.kind, count(self.rows, "row"), self.method);
        if self.method != FactorMethod::Dense.name() {
            words += &format!(", {} entries of L, {} operations to factor", self.entries_of_l, self.factor_flops);
        }
        words
    }
}

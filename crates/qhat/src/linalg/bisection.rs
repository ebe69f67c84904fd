//! Bisection: cuts a connected graph into two parts of about the same size and cuts few edges.
//!
//! Four vertices that lie far apart are the landmarks. The coordinates of a vertex are its numbers of hops to each
//! landmark and the differences of its hops to two landmarks: with two corners of a net as landmarks, the difference
//! grows straight along one side. The best cut along each coordinate is found, and the best of these cuts is refined by
//! moving single vertices across it.
//! Sources: Harel and Koren, Graph drawing by high-dimensional embedding (2002), for the landmarks; Fiduccia and
//! Mattheyses, A linear-time heuristic for improving network partitions (1982), for the refinement.

use std::collections::BTreeSet;

/// An undirected graph: the neighbours of v are `to[start[v]..start[v + 1]]`.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    pub(crate) start: Vec<u32>,
    pub(crate) to: Vec<u32>,
}

/// Least share of the vertices in a part [percent].
const SMALLEST_PART: usize = 40;

/// Moves without a new best cut after which refinement ends a walk.
const PATIENCE: usize = 60;

impl Graph {
    pub(crate) fn vertices(&self) -> usize {
        self.start.len() - 1
    }

    pub(crate) fn neighbours(&self, v: u32) -> &[u32] {
        &self.to[self.start[v as usize] as usize..self.start[v as usize + 1] as usize]
    }

    /// Hops from v to every vertex; `u32::MAX` where no path leads.
    fn hops(&self, v: u32) -> Vec<u32> {
        let mut hops = vec![u32::MAX; self.vertices()];
        hops[v as usize] = 0;
        let mut queue = vec![v];
        let mut next = 0;
        while next < queue.len() {
            let u = queue[next];
            next += 1;
            for &w in self.neighbours(u) {
                if hops[w as usize] == u32::MAX {
                    hops[w as usize] = hops[u as usize] + 1;
                    queue.push(w);
                }
            }
        }
        hops
    }
}

/// The side of every vertex of a connected graph.
pub(crate) fn bisect(graph: &Graph) -> Vec<bool> {
    let hops = landmarks(graph);
    let n = graph.vertices();
    let mut best = Cut { score: f64::INFINITY, low: Vec::new() };
    let mut key = vec![0_i64; n];
    for a in 0..hops.len() {
        for b in a..hops.len() {
            for v in 0..n {
                key[v] = i64::from(hops[a][v]) - if a == b { 0 } else { i64::from(hops[b][v]) };
            }
            let cut = along(graph, &key, best.score);
            if cut.score < best.score {
                best = cut;
            }
        }
    }
    refine(graph, &mut best.low);
    best.low
}

/// Hops from up to four vertices far from each other.
fn landmarks(graph: &Graph) -> Vec<Vec<u32>> {
    let farthest = |value: &dyn Fn(usize) -> u32| {
        let better = |best: usize, v: usize| if value(v) > value(best) { v } else { best };
        (1..graph.vertices()).fold(0, better) as u32
    };
    let near = graph.hops(0);
    let first = graph.hops(farthest(&|v| near[v]));
    let mut hops = vec![first];
    let second = graph.hops(farthest(&|v| hops[0][v]));
    hops.push(second);
    for _ in 0..2 {
        // Many vertices may be about as far from the landmarks so far (a whole diagonal of a net): the next landmark is
        // a vertex at the end of them.
        let nearest = |v: usize| hops.iter().map(|h| h[v]).min().unwrap_or(0);
        let some = farthest(&nearest);
        let least = nearest(some as usize) * 4 / 5;
        let from = graph.hops(some);
        let last = farthest(&|v| if nearest(v) >= least { 1 + from[v] } else { 0 });
        let next = graph.hops(last);
        hops.push(next);
    }
    hops
}

struct Cut {
    score: f64,
    low: Vec<bool>,
}

/// Cost of a cut: its number of edges, increased with the difference in size of the parts.
fn score(cut: i64, low: usize, n: usize) -> f64 {
    let uneven = (2 * low) as f64 / n as f64 - 1.0;
    cut as f64 * (1.0 + 4.0 * uneven * uneven)
}

/// The best cut between vertices in the order of their keys; its sides are empty if it is no better than `known`.
fn along(graph: &Graph, key: &[i64], known: f64) -> Cut {
    let n = key.len();
    let smallest = key.iter().copied().min().unwrap_or(0);
    let range = (key.iter().copied().max().unwrap_or(0) - smallest) as usize;
    let mut start = vec![0_u32; range + 2];
    for &k in key {
        start[(k - smallest) as usize + 1] += 1;
    }
    for k in 0..=range {
        start[k + 1] += start[k];
    }
    let mut order = vec![0_u32; n];
    for v in 0..n {
        let place = &mut start[(key[v] - smallest) as usize];
        order[*place as usize] = v as u32;
        *place += 1;
    }
    let mut low = vec![false; n];
    let (mut cut, mut best, mut length) = (0_i64, known, 0);
    for (i, &v) in order.iter().enumerate() {
        for &w in graph.neighbours(v) {
            cut += if low[w as usize] { -1 } else { 1 };
        }
        low[v as usize] = true;
        let size = i + 1;
        if 100 * size >= SMALLEST_PART * n && 100 * (n - size) >= SMALLEST_PART * n && score(cut, size, n) < best {
            best = score(cut, size, n);
            length = size;
        }
    }
    if length == 0 {
        if known < f64::INFINITY {
            return Cut { score: f64::INFINITY, low: Vec::new() };
        }
        // Two or three vertices have no cut into parts of the required size.
        length = n / 2;
        best = f64::MAX;
    }
    for &v in &order[length..] {
        low[v as usize] = false;
    }
    Cut { score: best, low }
}

/// Moves single vertices, the vertex with the greatest gain first, and returns to the best sides that it met.
fn refine(graph: &Graph, low: &mut [bool]) {
    let n = low.len();
    loop {
        let mut gain: Vec<i64> = vec![0; n];
        let mut queue = BTreeSet::new();
        let mut count = low.iter().filter(|&&is_low| is_low).count();
        let mut cut = 0;
        for v in 0..n {
            let across = graph.neighbours(v as u32).iter().filter(|&&w| low[w as usize] != low[v]).count() as i64;
            gain[v] = 2 * across - graph.neighbours(v as u32).len() as i64;
            cut += across;
            if across > 0 {
                queue.insert((-gain[v], v as u32));
            }
        }
        cut /= 2;
        let start = score(cut, count, n);
        let (mut best, mut moved, mut kept) = (start, Vec::new(), 0);
        let mut locked = vec![false; n];
        while moved.len() < kept + PATIENCE {
            let fits = |v: u32| {
                let after = if low[v as usize] { count - 1 } else { count + 1 };
                100 * after >= SMALLEST_PART * n && 100 * (n - after) >= SMALLEST_PART * n
            };
            let Some(&(worth, v)) = queue.iter().find(|&&(_, v)| fits(v)) else { break };
            queue.remove(&(worth, v));
            locked[v as usize] = true;
            low[v as usize] = !low[v as usize];
            count = if low[v as usize] { count + 1 } else { count - 1 };
            cut += worth;
            moved.push(v);
            for &w in graph.neighbours(v) {
                let w_ = w as usize;
                let change = if low[w_] == low[v as usize] { -2 } else { 2 };
                if !locked[w_] {
                    queue.remove(&(-gain[w_], w));
                    queue.insert((-gain[w_] - change, w));
                }
                gain[w_] += change;
            }
            if score(cut, count, n) < best {
                best = score(cut, count, n);
                kept = moved.len();
            }
        }
        for &v in &moved[kept..] {
            low[v as usize] = !low[v as usize];
        }
        if best >= start {
            break;
        }
    }
}

//! The shapes of the workloads. Rods have a length of 0.01 m and particles a mass of 0.01 kg, unless another number is
//! given.

use crate::workload::{GRAVITY, Workload};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const LENGTH: f64 = 0.01;
const MASS: f64 = 0.01;

impl Workload {
    fn new(dimension: usize) -> Self {
        let mut gravity = vec![0.0; dimension];
        gravity[1] = -GRAVITY;
        Workload {
            name: String::new(),
            dimension,
            gravity,
            frame: 1.0 / 60.0,
            frames: 120,
            positions: Vec::new(),
            masses: Vec::new(),
            fixed: Vec::new(),
            ends: Vec::new(),
            lengths: Vec::new(),
        }
    }

    fn particle(&mut self, position: [f64; 3], fixed: bool) -> usize {
        self.positions.extend_from_slice(&position[..self.dimension]);
        self.masses.push(MASS);
        self.fixed.push(u8::from(fixed));
        self.masses.len() - 1
    }

    fn rod(&mut self, a: usize, b: usize, length: f64) {
        self.ends.extend([a, b]);
        self.lengths.push(length);
    }

    /// A rod whose length is the distance of its ends.
    fn rod_between(&mut self, a: usize, b: usize) {
        let d = self.dimension;
        let square = |k: usize| (self.positions[b * d + k] - self.positions[a * d + k]).powi(2);
        let length = (0..d).map(square).sum::<f64>().sqrt();
        self.rod(a, b, length);
    }

    /// A chain of `count` links that leaves `from` in the direction of x.
    fn links(&mut self, from: usize, count: usize) {
        let start = [0, 1, 2].map(|k| if k < self.dimension { self.positions[from * self.dimension + k] } else { 0.0 });
        let mut last = from;
        for i in 1..=count {
            let next = self.particle([start[0] + LENGTH * i as f64, start[1], start[2]], false);
            self.rod(last, next, LENGTH);
            last = next;
        }
    }

    /// Gives a large workload four short frames only.
    fn timed(self) -> Self {
        if self.is_large() { Workload { frame: 1.0 / 960.0, frames: 4, ..self } } else { self }
    }
}

/// A planar chain that hangs from one end, released from the horizontal.
pub fn chain(links: usize) -> Workload {
    let mut workload = Workload::new(2);
    let hook = workload.particle([0.0; 3], true);
    workload.links(hook, links);
    workload.timed()
}

/// A chain of 100 links whose last mass is `ratio` times heavier.
pub fn heavy(ratio: f64) -> Workload {
    let mut workload = chain(100);
    workload.masses[100] *= ratio;
    workload
}

/// n × n particles joined along rows and columns, with two fixed corners: a planar net that hangs, or in 3D a cloth
/// that is released from the horizontal. The row between the fixed corners is a quarter of a circle. In a straight row
/// the rods between them would depend on each other at the start.
pub fn net(n: usize, dimension: usize) -> Workload {
    let mut workload = Workload::new(dimension);
    let turn = FRAC_PI_2 / (n - 1) as f64;
    let mut arc = vec![[0.0, 0.0]];
    for i in 1..n {
        // The directions of n − 1 chords, turning evenly from −45° to 45°.
        let angle = -FRAC_PI_2 / 2.0 + turn * (i as f64 - 0.5);
        let [x, y] = arc[i - 1];
        arc.push([x + LENGTH * angle.cos(), y + LENGTH * angle.sin()]);
    }
    for row in 0..n {
        let offset = LENGTH * row as f64;
        for (column, &[x, y]) in arc.iter().enumerate() {
            let position = if dimension == 2 { [x, y - offset, 0.0] } else { [x, y, offset] };
            let here = workload.particle(position, row == 0 && (column == 0 || column == n - 1));
            if column > 0 {
                workload.rod(here - 1, here, LENGTH);
            }
            if row > 0 {
                workload.rod(here - n, here, LENGTH);
            }
        }
    }
    workload.timed()
}

/// A Warren truss of equilateral panels that swings from its first joint. It is statically determinate: it has just
/// enough rods to be rigid, so the tension of each is determined. The redundant truss has a further brace in the
/// middle.
pub fn truss(panels: usize, redundant: bool) -> Workload {
    let mut workload = Workload::new(2);
    let height = -LENGTH * 0.75_f64.sqrt();
    let bottom = |panel: usize| 2 * panel;
    let top = |panel: usize| 2 * panel + 1;
    for panel in 0..panels {
        let x = LENGTH * panel as f64;
        workload.particle([x, 0.0, 0.0], panel == 0);
        workload.particle([x + LENGTH / 2.0, height, 0.0], false);
    }
    workload.particle([LENGTH * panels as f64, 0.0, 0.0], false);
    for panel in 0..panels {
        workload.rod_between(bottom(panel), bottom(panel + 1));
        workload.rod_between(bottom(panel), top(panel));
        workload.rod_between(top(panel), bottom(panel + 1));
        if panel > 0 {
            workload.rod_between(top(panel - 1), top(panel));
        }
    }
    if redundant {
        workload.rod_between(top(panels / 2 - 1), bottom(panels / 2 + 1));
    }
    workload.timed()
}

/// A crank of 0.01 m, a coupler of 0.03 m and a rocker of 0.025 m on a ground link of 0.03 m: the crank can turn
/// full circle.
pub fn four_bar() -> Workload {
    const CRANK: f64 = 0.01;
    const COUPLER: f64 = 0.03;
    const ROCKER: f64 = 0.025;
    const GROUND: f64 = 0.03;
    let mut workload = Workload::new(2);
    let left = workload.particle([0.0; 3], true);
    let right = workload.particle([GROUND, 0.0, 0.0], true);
    let knee = workload.particle([CRANK, 0.0, 0.0], false);
    // The apex of the triangle of coupler and rocker over the base from knee to the right pivot.
    let base = GROUND - CRANK;
    let along = (base * base + COUPLER * COUPLER - ROCKER * ROCKER) / (2.0 * base);
    let up = (COUPLER * COUPLER - along * along).sqrt();
    let apex = workload.particle([CRANK + along, up, 0.0], false);
    workload.rod(left, knee, CRANK);
    workload.rod(knee, apex, COUPLER);
    workload.rod(apex, right, ROCKER);
    workload
}

/// A planar hub with `spokes` rods all around, which swings from the far end of the first rod. All rods share the hub,
/// so J W Jᵀ is a full matrix.
pub fn star(spokes: usize) -> Workload {
    let mut workload = Workload::new(2);
    let hub = workload.particle([0.0; 3], false);
    for spoke in 0..spokes {
        let angle = PI + TAU * spoke as f64 / spokes as f64;
        let end = workload.particle([LENGTH * angle.cos(), LENGTH * angle.sin(), 0.0], spoke == 0);
        workload.rod(hub, end, LENGTH);
    }
    workload.timed()
}

/// Separate chains of 20 links.
pub fn many(chains: usize) -> Workload {
    let mut workload = Workload::new(2);
    for chain in 0..chains {
        let hook = workload.particle([0.0, -LENGTH * chain as f64, 0.0], true);
        workload.links(hook, 20);
    }
    workload.timed()
}

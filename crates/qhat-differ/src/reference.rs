//! The dense reference: accelerations, constraint forces and energies of a framework from its formulas alone.
//!
//! ```text
//! B = J M^(−1/2),   y = M^(1/2) q̈,   y₀ = M^(−1/2) Q,   y = y₀ + B⁺(−γ − B y₀),   Q̂ = M q̈ − Q
//! ```
//!
//! q runs over the coordinates of particles that are not fixed. Each row of B is divided by its length. The
//! number of singular values that count is decided once, at the start, on J with masses of 1, where a gap must separate
//! them from roundoff.

use crate::dense::{Svd, dot, largest, norm};
use crate::formula::{Along, Direction, Formula, Passing};
use crate::framework::{Formulas, Framework};

/// The part of the largest singular value below which one is roundoff: J has entries that are off by some 1e-16, and
/// the start satisfies C to roundoff only.
const ROUNDOFF: f64 = 1e-10;
/// The part of the largest above which a singular value certainly counts. Between the two bounds the reference itself
/// would lose digits, and it says nothing.
const CERTAIN: f64 = 1e-4;

/// The least length of the gradient of a row \[C/m\]: below it the row is near to a place where no force can act.
const LEAST_GRADIENT: f64 = 1e-6;

/// A framework as the reference sees it.
#[derive(Clone, Debug)]
pub struct Reference {
    dimension: usize,
    /// The coordinates that can move.
    free: Vec<usize>,
    /// √m of each of them [√kg].
    root_mass: Vec<f64>,
    formulas: Formulas,
    /// The coordinates that each row depends on, as places in `free`.
    supports: Vec<Vec<usize>>,
    /// The same for each potential.
    slopes: Vec<Vec<usize>>,
    /// The number of singular values that count.
    pub rank: usize,
}

/// One evaluation at a state.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// q̈ of every coordinate [m/s²], 0 for fixed particles.
    pub accelerations: Vec<f64>,
    /// Q̂ of every coordinate \[N\].
    pub constraint_forces: Vec<f64>,
    /// Q of every coordinate \[N\].
    pub applied_forces: Vec<f64>,
    /// The largest over the smallest singular value of B that counts.
    pub condition: f64,
    /// The part of −γ that no acceleration can meet, relative to |γ|.
    pub unmet: f64,
    /// The largest change of a force \[N\] where every position changes by a roundoff of the extent.
    pub force_roundoff: f64,
}

/// The rows at a state, divided by the lengths of the rows of B.
struct Rows {
    svd: Svd,
    /// C, Ċ, γ of each row, divided alike.
    followed: Vec<Along>,
    /// B.
    b: Vec<Vec<f64>>,
}

impl Reference {
    /// The reference of a framework; `None` where the rank at the start is not certain, or where a row has no gradient.
    pub fn new(framework: &Framework) -> Option<Self> {
        let d = framework.dimension;
        let formulas = framework.formulas();
        let is_free = |coordinate: &usize| !framework.particles[coordinate / d].fixed;
        let free: Vec<usize> = (0..d * framework.particles.len()).filter(is_free).collect();
        let place = |coordinate: usize| free.iter().position(|&other| other == coordinate);
        let support = |formula: &Formula| {
            let mut particles = Vec::new();
            formula.particles(&mut |particle| particles.push(particle));
            particles.sort_unstable();
            particles.dedup();
            particles.iter().flat_map(|particle| (0..d).filter_map(move |axis| place(particle * d + axis))).collect()
        };
        let mut reference = Reference {
            dimension: d,
            root_mass: free.iter().map(|&coordinate| framework.particles[coordinate / d].mass.sqrt()).collect(),
            supports: formulas.rows.iter().map(support).collect(),
            slopes: formulas.potentials.iter().map(support).collect(),
            free,
            formulas,
            rank: 0,
        };
        let (q, qd) = (framework.positions(), framework.velocities());
        reference.rank = reference.certain_rank(&q, &qd, 0.0)?;
        Some(reference)
    }

    /// The rank of J at a state, if a gap separates the singular values that count from roundoff.
    fn certain_rank(&self, q: &[f64], qd: &[f64], t: f64) -> Option<usize> {
        let mut jacobian = Vec::new();
        for row in 0..self.formulas.rows.len() {
            let mut gradient = self.gradient(&self.formulas.rows[row], &self.supports[row], q, qd, t);
            let length = norm(&gradient);
            if length < LEAST_GRADIENT {
                return None;
            }
            gradient.iter_mut().for_each(|entry| *entry /= length);
            jacobian.push(gradient);
        }
        let svd = Svd::new(&jacobian);
        let rank = svd.rank(ROUNDOFF);
        (rank == svd.rank(CERTAIN)).then_some(rank)
    }

    fn passing<'a>(&self, q: &'a [f64], qd: &'a [f64], t: f64, along: Direction) -> Passing<'a> {
        Passing { dimension: self.dimension, q, qd, t, along }
    }

    fn gradient(&self, formula: &Formula, support: &[usize], q: &[f64], qd: &[f64], t: f64) -> Vec<f64> {
        let mut gradient = vec![0.0; self.free.len()];
        for &place in support {
            let along = Direction::Coordinate(self.free[place]);
            gradient[place] = formula.follow(self.passing(q, qd, t, along)).first;
        }
        gradient
    }

    fn rows(&self, q: &[f64], qd: &[f64], t: f64) -> Rows {
        let (mut followed, mut b) = (Vec::new(), Vec::new());
        for (row, support) in self.formulas.rows.iter().zip(&self.supports) {
            let mut gradient = self.gradient(row, support, q, qd, t);
            gradient.iter_mut().zip(&self.root_mass).for_each(|(entry, root)| *entry /= root);
            let length = norm(&gradient);
            if length == 0.0 {
                continue;
            }
            gradient.iter_mut().for_each(|entry| *entry /= length);
            let Along { value, first, second } = row.follow(self.passing(q, qd, t, Direction::Motion));
            followed.push(Along { value: value / length, first: first / length, second: second / length });
            b.push(gradient);
        }
        Rows { svd: Svd::new(&b), followed, b }
    }

    /// Q of the coordinates that can move \[N\].
    fn forces(&self, q: &[f64], qd: &[f64], t: f64) -> Vec<f64> {
        let mut forces = vec![0.0; self.free.len()];
        for (potential, support) in self.formulas.potentials.iter().zip(&self.slopes) {
            for &place in support {
                let along = Direction::Coordinate(self.free[place]);
                forces[place] -= potential.follow(self.passing(q, qd, t, along)).first;
            }
        }
        for (coordinate, force) in &self.formulas.forces {
            if let Some(place) = self.free.iter().position(|free| free == coordinate) {
                forces[place] += force.follow(self.passing(q, qd, t, Direction::Nowhere)).value;
            }
        }
        forces
    }

    /// Everything at a state.
    pub fn evaluate(&self, q: &[f64], qd: &[f64], t: f64) -> Evaluation {
        let rows = self.rows(q, qd, t);
        let forces = self.forces(q, qd, t);
        let y = self.solve(&rows, &forces);
        let mut evaluation = Evaluation {
            accelerations: vec![0.0; q.len()],
            constraint_forces: vec![0.0; q.len()],
            applied_forces: vec![0.0; q.len()],
            condition: if self.rank == 0 { 1.0 } else { rows.svd.values[0] / rows.svd.values[self.rank - 1] },
            unmet: 0.0,
            force_roundoff: 0.0,
        };
        for (place, &coordinate) in self.free.iter().enumerate() {
            let acceleration = y[place] / self.root_mass[place];
            evaluation.accelerations[coordinate] = acceleration;
            evaluation.applied_forces[coordinate] = forces[place];
            evaluation.constraint_forces[coordinate] = self.root_mass[place] * y[place] - forces[place];
        }
        let sizes = rows.followed.iter().map(|row| row.second.abs()).fold(0.0, f64::max).max(norm(&y));
        let left = rows.b.iter().zip(&rows.followed).map(|(b, row)| (dot(b, &y) + row.second).abs());
        evaluation.unmet = left.fold(0.0, f64::max) / sizes.max(f64::MIN_POSITIVE);
        let extent = largest(q);
        let moved: Vec<f64> = q.iter().enumerate().map(|(i, x)| x + [1e-9, -1e-9][i % 2] * extent).collect();
        let other = self.forces(&moved, qd, t);
        let change = forces.iter().zip(&other).map(|(a, b)| (a - b).abs());
        // A millionth of a change by 1e-9, because two forces a roundoff apart differ by their own roundoff.
        evaluation.force_roundoff = 1e-6 * change.fold(0.0, f64::max);
        evaluation
    }

    /// q̈ of every coordinate [m/s²].
    pub fn accelerations(&self, q: &[f64], qd: &[f64], t: f64) -> Vec<f64> {
        let y = self.solve(&self.rows(q, qd, t), &self.forces(q, qd, t));
        let mut accelerations = vec![0.0; q.len()];
        for (place, &coordinate) in self.free.iter().enumerate() {
            accelerations[coordinate] = y[place] / self.root_mass[place];
        }
        accelerations
    }

    fn solve(&self, rows: &Rows, forces: &[f64]) -> Vec<f64> {
        let mut y: Vec<f64> = forces.iter().zip(&self.root_mass).map(|(force, root)| force / root).collect();
        let c: Vec<f64> = rows.b.iter().zip(&rows.followed).map(|(b, row)| -row.second - dot(b, &y)).collect();
        let change = rows.svd.solve(self.rank, &c, y.len());
        y.iter_mut().zip(change).for_each(|(entry, change)| *entry += change);
        y
    }

    /// Moves q onto C = 0 and then q̇ onto Ċ = 0, each by the least change in the metric of the masses. Returns the
    /// largest |C| that is left, each divided by the length of its row of J M^(−1/2).
    pub fn project(&self, q: &mut [f64], qd: &mut [f64], t: f64) -> f64 {
        let mut left = f64::INFINITY;
        for _ in 0..8 {
            let rows = self.rows(q, qd, t);
            let residual: Vec<f64> = rows.followed.iter().map(|row| -row.value).collect();
            let now = largest(&residual);
            // Newton's method ends where roundoff lets the residual fall no further.
            if now >= 0.5 * left {
                break;
            }
            left = now;
            let change = rows.svd.solve(self.rank, &residual, self.free.len());
            self.add(q, &change);
        }
        self.project_velocities(q, qd, t);
        left
    }

    /// Moves q̇ onto Ċ = 0.
    pub fn project_velocities(&self, q: &[f64], qd: &mut [f64], t: f64) {
        let rows = self.rows(q, qd, t);
        let rates: Vec<f64> = rows.followed.iter().map(|row| -row.first).collect();
        let change = rows.svd.solve(self.rank, &rates, self.free.len());
        self.add(qd, &change);
    }

    fn add(&self, x: &mut [f64], y: &[f64]) {
        for (place, &coordinate) in self.free.iter().enumerate() {
            x[coordinate] += y[place] / self.root_mass[place];
        }
    }

    /// C of every row, divided by the length of its gradient over the coordinates \[m\].
    pub fn residuals(&self, q: &[f64], t: f64) -> Vec<f64> {
        let qd = vec![0.0; q.len()];
        let each = self.formulas.rows.iter().zip(&self.supports).map(|(row, support)| {
            let length = norm(&self.gradient(row, support, q, &qd, t));
            let value = row.follow(self.passing(q, &qd, t, Direction::Nowhere)).value;
            if length > 0.0 { value / length } else { value }
        });
        each.collect()
    }

    /// T and V \[J\].
    pub fn energies(&self, q: &[f64], qd: &[f64], t: f64) -> [f64; 2] {
        let kinetic = self.free.iter().zip(&self.root_mass).map(|(&i, root)| 0.5 * (root * qd[i]).powi(2)).sum();
        let at = self.passing(q, qd, t, Direction::Nowhere);
        [kinetic, self.formulas.potentials.iter().map(|potential| potential.follow(at).value).sum()]
    }
}

//! A framework: particles, conditions, forces, and the formulas that the reference solves for it.
//!
//! Each kind of constraint and force becomes formulas here, and text in `write.rs`. Neither uses code of the engine.

use crate::formula::{Direction, Formula, Function, Join, Passing, distance, number, of, power, squared_distance};

/// A framework, from a seed.
#[derive(Clone, Debug)]
pub struct Framework {
    /// The seed.
    pub seed: u64,
    /// The name of its shape, for lists of findings.
    pub family: &'static str,
    /// 2 or 3.
    pub dimension: usize,
    /// The particles; every other list names them by their place here.
    pub particles: Vec<Particle>,
    /// The conditions that hold exactly.
    pub conditions: Vec<Condition>,
    /// The rows of the reference, where they are not those of the conditions: see `generate/singular.rs`.
    pub instead: Option<Vec<Formula>>,
    /// The forces beside gravity and drag.
    pub pushes: Vec<Push>,
    /// The acceleration of gravity [m/s²].
    pub gravity: [f64; 3],
    /// Viscous drag on every particle [N·s/m].
    pub drag: f64,
    /// The named constants of the scene.
    pub parameters: Vec<(String, f64)>,
    /// The duration of the motion that is compared \[s\].
    pub duration: f64,
}

/// A particle.
#[derive(Clone, Debug)]
pub struct Particle {
    /// Its id in the scene.
    pub name: String,
    /// The position at the start \[m\].
    pub at: [f64; 3],
    /// The velocity at the start [m/s].
    pub velocity: [f64; 3],
    /// The mass \[kg\].
    pub mass: f64,
    /// Whether it stays at its position.
    pub fixed: bool,
}

/// A condition that holds exactly.
#[derive(Clone, Debug)]
pub enum Condition {
    /// A rod of a length \[m\] that may depend on t.
    Rod {
        /// The two ends.
        between: [usize; 2],
        /// The length \[m\].
        length: Formula,
        /// Whether the row is the difference of the squares, as under `form = "squared"`.
        squared: bool,
    },
    /// A particle at a point \[m\] that may depend on t.
    Nail {
        /// The particle.
        particle: usize,
        /// A formula for each axis.
        at: Vec<Formula>,
    },
    /// Two particles at one place.
    Coincidence {
        /// The two particles.
        between: [usize; 2],
    },
    /// Formulas that stay zero.
    Expression {
        /// One formula for each row.
        rows: Vec<Formula>,
    },
}

/// A force.
#[derive(Clone, Debug)]
pub enum Push {
    /// A damped spring.
    Spring {
        /// The two ends.
        between: [usize; 2],
        /// The stiffness [N/m].
        stiffness: f64,
        /// The damping [N·s/m].
        damping: f64,
        /// The length at which it does not pull \[m\].
        rest: f64,
    },
    /// A constant force \[N\] on a particle.
    Point(usize, [f64; 3]),
    /// A force on a particle: amplitude \[N\], angular frequency [rad/s], phase \[rad\].
    Harmonic(usize, [f64; 3], f64, f64),
    /// A force on a particle: a formula for each axis \[N\].
    Force(usize, Vec<Formula>),
    /// A potential energy \[J\].
    Potential(Formula),
}

/// The formulas of a framework, from which the reference computes.
#[derive(Clone, Debug, Default)]
pub struct Formulas {
    /// The formulas that stay zero.
    pub rows: Vec<Formula>,
    /// The potential energies \[J\].
    pub potentials: Vec<Formula>,
    /// Forces without a potential: the coordinate, the formula \[N\].
    pub forces: Vec<(usize, Formula)>,
}

impl Framework {
    /// q at the start \[m\], with the coordinates of fixed particles.
    pub fn positions(&self) -> Vec<f64> {
        self.particles.iter().flat_map(|particle| particle.at[..self.dimension].to_vec()).collect()
    }

    /// q̇ at the start [m/s].
    pub fn velocities(&self) -> Vec<f64> {
        self.particles.iter().flat_map(|particle| particle.velocity[..self.dimension].to_vec()).collect()
    }

    /// Puts the particles into another state.
    pub fn set_state(&mut self, q: &[f64], qd: &[f64]) {
        for (i, particle) in self.particles.iter_mut().enumerate() {
            for axis in 0..self.dimension {
                particle.at[axis] = q[i * self.dimension + axis];
                particle.velocity[axis] = qd[i * self.dimension + axis];
            }
        }
    }

    /// The value of a formula at the start.
    pub fn value(&self, formula: &Formula) -> f64 {
        let (q, qd) = (self.positions(), self.velocities());
        let at = Passing { dimension: self.dimension, q: &q, qd: &qd, t: 0.0, along: Direction::Nowhere };
        formula.follow(at).value
    }

    /// All formulas, gravity and drag included.
    pub fn formulas(&self) -> Formulas {
        let d = self.dimension;
        let mut all = Formulas::default();
        let rows = self.conditions.iter().flat_map(|condition| condition.rows(d));
        all.rows = self.instead.clone().unwrap_or_else(|| rows.collect());
        for (i, particle) in self.particles.iter().enumerate().filter(|(_, particle)| !particle.fixed) {
            for axis in (0..d).filter(|&axis| self.gravity[axis] != 0.0) {
                all.potentials.push(number(-particle.mass * self.gravity[axis]) * Formula::Place(i, axis));
            }
            if self.drag > 0.0 {
                all.forces.extend((0..d).map(|axis| (i * d + axis, number(-self.drag) * Formula::Speed(i, axis))));
            }
        }
        for push in &self.pushes {
            push.formulas(d, &mut all);
        }
        all
    }
}

impl Condition {
    /// The formulas that stay zero.
    pub fn rows(&self, dimension: usize) -> Vec<Formula> {
        match self {
            Condition::Rod { between: [a, b], length, squared: false } => {
                vec![distance(*a, *b, dimension) - length.clone()]
            }
            Condition::Rod { between: [a, b], length, squared: true } => {
                vec![squared_distance(*a, *b, dimension) - power(length.clone(), 2)]
            }
            Condition::Nail { particle, at } => {
                at.iter().enumerate().map(|(axis, at)| Formula::Place(*particle, axis) - at.clone()).collect()
            }
            Condition::Coincidence { between: [a, b] } => {
                (0..dimension).map(|axis| Formula::Place(*a, axis) - Formula::Place(*b, axis)).collect()
            }
            Condition::Expression { rows } => rows.clone(),
        }
    }
}

impl Push {
    fn formulas(&self, d: usize, all: &mut Formulas) {
        match self {
            Push::Spring { between: [a, b], stiffness, damping, rest } => {
                let (a, b) = (*a, *b);
                let longer = distance(a, b, d) - number(*rest);
                all.potentials.push(number(0.5 * stiffness) * power(longer, 2));
                if *damping == 0.0 {
                    return;
                }
                // F_a = −c (d·u) d / |d|² with d = x_a − x_b and u = v_a − v_b.
                let apart = |axis| Formula::Place(a, axis) - Formula::Place(b, axis);
                let faster = |axis| Formula::Speed(a, axis) - Formula::Speed(b, axis);
                let rate = (1..d).fold(apart(0) * faster(0), |sum, axis| sum + apart(axis) * faster(axis));
                let two = Box::new([rate, squared_distance(a, b, d)]);
                let closing = Formula::Joined(Join::Quotient, two);
                for axis in 0..d {
                    let force = number(*damping) * (closing.clone() * apart(axis));
                    all.forces.push((a * d + axis, number(-1.0) * force.clone()));
                    all.forces.push((b * d + axis, force));
                }
            }
            Push::Point(particle, force) => {
                for axis in 0..d {
                    all.potentials.push(number(-force[axis]) * Formula::Place(*particle, axis));
                }
            }
            Push::Harmonic(particle, force, frequency, phase) => {
                for axis in 0..d {
                    let angle = number(*frequency) * Formula::Time + number(*phase);
                    all.forces.push((particle * d + axis, number(force[axis]) * of(Function::Cos, angle)));
                }
            }
            Push::Force(particle, force) => {
                all.forces.extend(force.iter().cloned().enumerate().map(|(axis, force)| (particle * d + axis, force)));
            }
            Push::Potential(potential) => all.potentials.push(potential.clone()),
        }
    }
}

//! Random frameworks from a seed: a shape, then modifiers, then velocities that satisfy the constraints.

mod conditions;
mod loads;
mod shapes;
mod singular;

use crate::formula::{Formula, number};
use crate::framework::{Condition, Framework, Particle};
use crate::random::Random;
use crate::reference::Reference;

/// A shape: particles and conditions, without velocities or forces.
type Shape = fn(&mut Random, &mut Framework);

/// The shapes, each with its name; a seed takes one of them.
const SHAPES: [(&str, Shape); 13] = [
    ("tree", shapes::tree),
    ("braced", shapes::braced),
    ("crossed truss", shapes::crossed_truss),
    ("cranks", shapes::cranks),
    ("all distances", shapes::all_distances),
    ("straight chain", shapes::straight_chain),
    ("folded chain", shapes::folded_chain),
    ("coincident", shapes::coincident),
    ("expressions", conditions::expressions),
    ("drives", conditions::drives),
    ("springs", loads::springs),
    ("cranks through flat", singular::cranks_through_flat),
    ("three in line", singular::three_in_line),
];

/// Tries of one seed before it is given up: a shape may come out too near to a singular position.
const TRIES: u64 = 40;

/// The name of the shape of a seed.
fn family(seed: u64) -> &'static str {
    SHAPES[(seed % SHAPES.len() as u64) as usize].0
}

/// The framework of a seed.
///
/// # Panics
/// If no try of a seed gives a framework whose rank is certain, which no seed is known to do.
pub fn framework(seed: u64) -> Framework {
    let name = family(seed);
    let made = (0..TRIES).find_map(|attempt| attempt_at(seed, attempt));
    made.unwrap_or_else(|| panic!("no framework of seed {seed}, {name}, has a certain rank"))
}

fn attempt_at(seed: u64, attempt: u64) -> Option<Framework> {
    let (family, shape) = SHAPES[(seed % SHAPES.len() as u64) as usize];
    let mut random = Random::new(seed.wrapping_mul(1000).wrapping_add(attempt));
    let mut framework = Framework {
        seed,
        family,
        dimension: if random.chance(0.6) { 2 } else { 3 },
        particles: Vec::new(),
        conditions: Vec::new(),
        instead: None,
        pushes: Vec::new(),
        gravity: [0.0; 3],
        drag: 0.0,
        parameters: Vec::new(),
        duration: random.between(0.1, 0.4),
    };
    shape(&mut random, &mut framework);
    // Formulas that stand in for the conditions know nothing of conditions that are added.
    if framework.instead.is_none() {
        conditions::repeat(&mut random, &mut framework);
    }
    loads::masses(&mut random, &mut framework);
    loads::pushes(&mut random, &mut framework);
    if random.chance(0.8) {
        framework.gravity[1] = if random.chance(0.5) { -9.81 } else { random.between(-15.0, 15.0) };
        framework.gravity[0] = if random.chance(0.2) { random.between(-5.0, 5.0) } else { 0.0 };
    }
    velocities(&mut random, &mut framework)?;
    Some(framework)
}

/// Velocities that satisfy every constraint; `None` where the framework is not what the reference can answer for.
fn velocities(random: &mut Random, framework: &mut Framework) -> Option<()> {
    let at_rest = random.chance(0.3);
    let speed = random.between(0.2, 3.0);
    for particle in framework.particles.iter_mut().filter(|particle| !particle.fixed && !at_rest) {
        let own = random.vector(framework.dimension, speed);
        // A shape may have given velocities of its own.
        if particle.velocity == [0.0; 3] {
            particle.velocity = own;
        }
    }
    let reference = Reference::new(framework)?;
    let (mut q, mut qd) = (framework.positions(), framework.velocities());
    let left = reference.project(&mut q, &mut qd, 0.0);
    if left > 1e-12 || q.iter().chain(&qd).any(|x| !x.is_finite() || x.abs() > 50.0) {
        return None;
    }
    framework.set_state(&q, &qd);
    let evaluation = reference.evaluate(&q, &qd, 0.0);
    // An acceleration that no row forbids exists, unless rows meet only to second order: then the equation does not
    // say what happens.
    (evaluation.unmet < 1e-10).then_some(())
}

impl Framework {
    /// Adds a particle at a position.
    fn add(&mut self, at: [f64; 3]) -> usize {
        let name = format!("p{}", self.particles.len());
        self.particles.push(Particle { name, at, velocity: [0.0; 3], mass: 1.0, fixed: false });
        self.particles.len() - 1
    }

    /// Adds a particle that stays.
    fn add_fixed(&mut self, at: [f64; 3]) -> usize {
        let particle = self.add(at);
        self.particles[particle].fixed = true;
        particle
    }

    /// The distance between two particles at the start \[m\].
    fn apart(&self, a: usize, b: usize) -> f64 {
        let [a, b] = [a, b].map(|particle| self.particles[particle].at);
        (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
    }

    /// Adds a rod as long as the distance is, in one of its two forms.
    fn rod(&mut self, random: &mut Random, a: usize, b: usize) {
        let length = number(self.apart(a, b));
        self.conditions.push(Condition::Rod { between: [a, b], length, squared: random.chance(0.3) });
    }

    /// Adds a nail where a particle is.
    fn nail(&mut self, particle: usize) {
        let at = self.particles[particle].at[..self.dimension].iter().map(|x| number(*x)).collect();
        self.conditions.push(Condition::Nail { particle, at });
    }

    /// Holds a formula at the value that it has at the start.
    fn kept(&self, formula: Formula) -> Formula {
        let value = self.value(&formula);
        formula - number(value)
    }
}

//! Shapes made of rods and nails.

use crate::framework::{Condition, Framework};
use crate::random::Random;

/// The least distance between two particles of a rod \[m\].
const NEAR: f64 = 0.3;

/// A position at some distance from one that is there, and not too near to the others.
fn somewhere(random: &mut Random, framework: &Framework, from: usize) -> [f64; 3] {
    let mut at = [0.0; 3];
    for _ in 0..100 {
        let offset = random.vector(framework.dimension, 1.0);
        at = std::array::from_fn(|axis| framework.particles[from].at[axis] + offset[axis]);
        let far = |other: [f64; 3]| (0..3).map(|axis| (at[axis] - other[axis]).powi(2)).sum::<f64>() > NEAR * NEAR;
        if framework.particles.iter().all(|particle| far(particle.at)) {
            break;
        }
    }
    at
}

/// A first particle: fixed, nailed, or free.
fn root(random: &mut Random, framework: &mut Framework) -> usize {
    let at = random.vector(framework.dimension, 1.0);
    match random.below(3) {
        0 => framework.add_fixed(at),
        1 => {
            let root = framework.add(at);
            framework.nail(root);
            root
        }
        _ => framework.add(at),
    }
}

/// A tree of rods.
pub(super) fn tree(random: &mut Random, framework: &mut Framework) {
    root(random, framework);
    for _ in 0..2 + random.below(6) {
        let from = random.below(framework.particles.len());
        let at = somewhere(random, framework, from);
        let next = framework.add(at);
        framework.rod(random, from, next);
    }
}

/// A tree with rods between other pairs of its particles: loops, rigid parts, redundant rods.
pub(super) fn braced(random: &mut Random, framework: &mut Framework) {
    tree(random, framework);
    for _ in 0..1 + random.below(4) {
        let [a, b] = random.two(framework.particles.len());
        if !(framework.particles[a].fixed && framework.particles[b].fixed) {
            framework.rod(random, a, b);
        }
    }
}

/// A girder of crossed bays, a redundant rod in each, free or on one or two of its joints.
pub(super) fn crossed_truss(random: &mut Random, framework: &mut Framework) {
    framework.dimension = 2;
    let bays = 1 + random.below(4);
    let rise = random.between(0.5, 1.5);
    let jitter = if random.chance(0.5) { 0.0 } else { 0.2 };
    for i in 0..=bays {
        for y in [0.0, rise] {
            let off = random.vector(2, jitter);
            framework.add([i as f64 + off[0], y + off[1], 0.0]);
        }
    }
    for held in 0..random.below(3) {
        framework.nail(held);
    }
    for i in 0..bays {
        let [low, top, low2, top2] = [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3];
        if i == 0 {
            framework.rod(random, low, top);
        }
        for (a, b) in [(low, low2), (top, top2), (low, top2), (top, low2), (low2, top2)] {
            framework.rod(random, a, b);
        }
    }
}

/// Parallel cranks of equal length on fixed pivots, joined by a bar: every crank after the second is redundant.
pub(super) fn cranks(random: &mut Random, framework: &mut Framework) {
    let angle = random.between(0.4, 2.7);
    crank_row(random, framework, angle);
}

/// The same with the cranks at an angle to the line of their pivots \[rad\].
pub(super) fn crank_row(random: &mut Random, framework: &mut Framework, angle: f64) {
    framework.dimension = 2;
    let count = 2 + random.below(3);
    let length = random.between(0.5, 1.2);
    let mut ends: Vec<usize> = Vec::new();
    for i in 0..count {
        let x = i as f64 * random.between(0.9, 1.1);
        let pivot = framework.add_fixed([x, 0.0, 0.0]);
        let end = framework.add([x + length * libm::cos(angle), length * libm::sin(angle), 0.0]);
        framework.rod(random, pivot, end);
        if let Some(&before) = ends.last() {
            framework.rod(random, before, end);
        }
        ends.push(end);
    }
}

/// A cluster with every distance held.
pub(super) fn all_distances(random: &mut Random, framework: &mut Framework) {
    root(random, framework);
    for _ in 0..framework.dimension + random.below(3) {
        let from = random.below(framework.particles.len());
        let at = somewhere(random, framework, from);
        framework.add(at);
    }
    for a in 0..framework.particles.len() {
        for b in 0..a {
            framework.rod(random, a, b);
        }
    }
}

/// A chain in a straight line, along an axis or not, from a root that may be free.
pub(super) fn straight_chain(random: &mut Random, framework: &mut Framework) {
    let start = root(random, framework);
    let step = match random.below(3) {
        0 => [0.0, -0.5, 0.0],
        1 => [0.5, 0.0, 0.0],
        _ => random.vector(framework.dimension, 1.0),
    };
    for i in 1..=2 + random.below(6) {
        let from = framework.particles[start].at;
        let next = framework.add(std::array::from_fn(|axis| from[axis] + i as f64 * step[axis]));
        framework.rod(random, next - 1, next);
    }
}

/// A chain that goes back and forth between the same places, so that particles lie on each other.
pub(super) fn folded_chain(random: &mut Random, framework: &mut Framework) {
    let start = root(random, framework);
    let offset = random.vector(framework.dimension, 1.0);
    let places = [framework.particles[start].at, std::array::from_fn(|k| framework.particles[start].at[k] + offset[k])];
    for i in 1..=2 + random.below(5) {
        let next = framework.add(places[i % 2]);
        framework.rod(random, next - 1, next);
    }
}

/// Two trees that are joined where they have particles at one place.
pub(super) fn coincident(random: &mut Random, framework: &mut Framework) {
    tree(random, framework);
    let joint = framework.particles.len() - 1;
    let double = framework.add(framework.particles[joint].at);
    framework.conditions.push(Condition::Coincidence { between: [joint, double] });
    for _ in 0..1 + random.below(3) {
        let from = if random.chance(0.5) { double } else { framework.particles.len() - 1 };
        let at = somewhere(random, framework, from);
        let next = framework.add(at);
        framework.rod(random, from, next);
    }
}

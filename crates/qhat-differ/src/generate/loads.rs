//! Masses, springs, dampers and other forces.

use super::conditions;
use crate::formula::{Formula, number};
use crate::framework::{Framework, Push};
use crate::random::Random;

/// Gives masses: all 1, about 1, or over six decades.
pub(super) fn masses(random: &mut Random, framework: &mut Framework) {
    let (low, high) = *random.pick(&[(1.0, 1.0), (0.3, 3.0), (0.3, 3.0), (1e-3, 1e3)]);
    for particle in &mut framework.particles {
        particle.mass = if low == high { low } else { random.decade(low, high) };
    }
}

/// Two particles that are not at one place; a spring between them has a direction.
fn apart(random: &mut Random, framework: &Framework) -> Option<[usize; 2]> {
    let pairs = (0..20).map(|_| random.two(framework.particles.len()));
    let mut pairs = pairs.filter(|&[a, b]| {
        framework.apart(a, b) > 0.1 && !(framework.particles[a].fixed && framework.particles[b].fixed)
    });
    pairs.next()
}

/// A damped spring between two random particles.
fn spring(random: &mut Random, framework: &mut Framework) {
    if let Some([a, b]) = apart(random, framework) {
        // A particle of 1 g on such a spring makes up to 30 turns a second.
        let least = framework.particles[a].mass.min(framework.particles[b].mass);
        framework.pushes.push(Push::Spring {
            between: [a, b],
            stiffness: least * random.decade(1.0, 3e4),
            damping: if random.chance(0.5) { least * random.decade(0.01, 30.0) } else { 0.0 },
            rest: framework.apart(a, b) * random.between(0.0, 1.5),
        });
    }
}

/// Particles on springs alone, or with a rod or two.
pub(super) fn springs(random: &mut Random, framework: &mut Framework) {
    let anchor = random.vector(framework.dimension, 1.0);
    framework.add_fixed(anchor);
    for _ in 0..2 + random.below(4) {
        let at = random.vector(framework.dimension, 1.5);
        framework.add(at);
    }
    for _ in 0..3 + random.below(4) {
        spring(random, framework);
    }
    for _ in 0..random.below(3) {
        if let Some([a, b]) = apart(random, framework) {
            framework.rod(random, a, b);
        }
    }
    if framework.conditions.is_empty() {
        let last = framework.particles.len() - 1;
        framework.rod(random, 0, last);
    }
}

/// Adds forces of every kind.
pub(super) fn pushes(random: &mut Random, framework: &mut Framework) {
    // The springs of a shape were made for masses of 1.
    let masses: Vec<f64> = framework.particles.iter().map(|particle| particle.mass).collect();
    for push in &mut framework.pushes {
        if let Push::Spring { between: [a, b], stiffness, damping, .. } = push {
            let least = masses[*a].min(masses[*b]);
            *stiffness *= least;
            *damping *= least;
        }
    }
    if random.chance(0.3) {
        framework.drag = random.decade(0.01, 3.0) * masses.iter().copied().fold(f64::INFINITY, f64::min);
    }
    let moving: Vec<usize> = (0..framework.particles.len()).filter(|&i| !framework.particles[i].fixed).collect();
    for _ in 0..random.below(3) {
        let particle = *random.pick(&moving);
        let mass = framework.particles[particle].mass;
        let force = random.vector(framework.dimension, 20.0 * mass);
        match random.below(6) {
            0 | 1 => spring(random, framework),
            2 => framework.pushes.push(Push::Point(particle, force)),
            3 => {
                let (frequency, phase) = (random.between(1.0, 20.0), random.between(0.0, 6.0));
                framework.pushes.push(Push::Harmonic(particle, force, frequency, phase));
            }
            4 => {
                let each = (0..framework.dimension).map(|axis| {
                    let along = number(-mass * random.between(0.0, 3.0)) * Formula::Speed(particle, axis);
                    number(mass) * conditions::smooth(random, framework, 2, true) + along
                });
                let force = each.collect();
                framework.pushes.push(Push::Force(particle, force));
            }
            _ => {
                // A potential without a coordinate exerts no force, and the reader refuses it.
                let place = Formula::Place(particle, random.below(framework.dimension));
                let potential = number(mass) * (place + conditions::smooth(random, framework, 2, false));
                framework.pushes.push(Push::Potential(potential));
            }
        }
    }
}

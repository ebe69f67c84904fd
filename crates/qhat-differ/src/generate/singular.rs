//! Shapes that are at, or pass, a position where the rank of J is lower than around it.

use super::shapes;
use crate::formula::{Formula, distance, number};
use crate::framework::{Condition, Framework};
use crate::random::Random;

/// Parallel cranks that pass the line of their pivots on the way, where all of them and the bar lie in one line. The
/// reference holds the first crank, and the ends of the others beside its end: these rows are independent everywhere.
pub(super) fn cranks_through_flat(random: &mut Random, framework: &mut Framework) {
    let ahead = random.between(0.05, 0.2);
    shapes::crank_row(random, framework, ahead);
    // Every crank turns towards the line, at a rate at which it passes the line half way.
    let rate = ahead / (-0.5 * framework.duration);
    for i in 0..framework.particles.len() {
        if !framework.particles[i].fixed {
            let [pivot, end] = [i - 1, i].map(|particle| framework.particles[particle].at);
            framework.particles[i].velocity = [-rate * (end[1] - pivot[1]), rate * (end[0] - pivot[0]), 0.0];
        }
    }
    let mut rows = vec![distance(0, 1, 2) - number(framework.apart(0, 1))];
    for end in (3..framework.particles.len()).step_by(2) {
        for axis in 0..2 {
            let offset = framework.particles[end].at[axis] - framework.particles[1].at[axis];
            rows.push(Formula::Place(end, axis) - Formula::Place(1, axis) - number(offset));
        }
    }
    framework.instead = Some(rows);
}

/// Three joints in line held by three rods, which hold the middle one on the line to second order only. The reference
/// holds the two ends at their distance, and the middle where it divides the line.
pub(super) fn three_in_line(random: &mut Random, framework: &mut Framework) {
    let start = random.vector(framework.dimension, 1.0);
    let offset = random.vector(framework.dimension, 1.0);
    let part = random.between(0.2, 0.8);
    let along = |part: f64| std::array::from_fn(|axis| start[axis] + part * offset[axis]);
    let a = if random.chance(0.5) { framework.add_fixed(start) } else { framework.add(start) };
    let [b, c] = [part, 1.0].map(|part| framework.add(along(part)));
    for [x, y] in [[a, b], [b, c], [a, c]] {
        let length = number(framework.apart(x, y));
        framework.conditions.push(Condition::Rod { between: [x, y], length, squared: false });
    }
    let mut rows = vec![distance(a, c, framework.dimension) - number(framework.apart(a, c))];
    for axis in 0..framework.dimension {
        let [a, b, c] = [a, b, c].map(|particle| Formula::Place(particle, axis));
        rows.push(b - (number(1.0 - part) * a + number(part) * c));
    }
    framework.instead = Some(rows);
}

//! Constraints beyond rods and nails: expressions, drives, and rows that repeat what others say.

use super::shapes;
use crate::formula::{Formula, Function, Join, distance, number, of, power, squared_distance};
use crate::framework::{Condition, Framework};
use crate::random::Random;

/// A coordinate of a random particle that can move.
fn coordinate(random: &mut Random, framework: &Framework) -> Formula {
    let moving: Vec<usize> = (0..framework.particles.len()).filter(|&i| !framework.particles[i].fixed).collect();
    Formula::Place(*random.pick(&moving), random.below(framework.dimension))
}

/// A smooth formula of a few coordinates, and of t where it may be.
pub(super) fn smooth(random: &mut Random, framework: &Framework, depth: usize, time: bool) -> Formula {
    if depth == 0 {
        return match random.below(if time { 6 } else { 5 }) {
            0 => number((random.between(-3.0, 3.0) * 8.0).round() / 8.0),
            5 => Formula::Time,
            _ => coordinate(random, framework),
        };
    }
    let part = |random: &mut Random| smooth(random, framework, depth - 1, time);
    match random.below(9) {
        0 | 1 => part(random) + part(random),
        2 => part(random) - part(random),
        3 => part(random) * part(random),
        4 => of(*random.pick(&[Function::Sin, Function::Cos, Function::Atan]), part(random)),
        5 => power(part(random), 2 + random.below(3) as u32),
        // Roots, logarithms and quotients of what stays positive.
        6 => of(Function::Sqrt, number(1.0) + power(part(random), 2)),
        7 => of(Function::Ln, number(1.5) + power(part(random), 2)),
        _ => {
            let two = Box::new([part(random), number(2.0) + power(part(random), 2)]);
            Formula::Joined(Join::Quotient, two)
        }
    }
}

/// A word of the expression language for points, with its meaning in coordinates.
fn word(random: &mut Random, framework: &Framework) -> Formula {
    let [a, b] = random.two(framework.particles.len());
    let d = framework.dimension;
    let [x, y] = [a, b].map(|particle| framework.particles[particle].name.clone());
    let place = Formula::Place;
    match random.below(4) {
        0 => Formula::Written(format!("dist({x}, {y})"), Box::new(distance(a, b, d))),
        1 => Formula::Written(format!("dot({x} - {y}, {x} - {y})"), Box::new(squared_distance(a, b, d))),
        2 => {
            let products = (1..d).fold(place(a, 0) * place(b, 0), |sum, k| sum + place(a, k) * place(b, k));
            Formula::Written(format!("dot({x}, {y})"), Box::new(products))
        }
        _ if d == 2 => {
            let cross = place(a, 0) * place(b, 1) - place(a, 1) * place(b, 0);
            Formula::Written(format!("cross({x}, {y})"), Box::new(cross))
        }
        _ => {
            let cross = place(a, 0) * place(b, 1) - place(a, 1) * place(b, 0);
            Formula::Written(format!("dot(cross({x}, {y}), [0, 0, 1])"), Box::new(cross))
        }
    }
}

/// Free particles on random surfaces, with a rod or two.
pub(super) fn expressions(random: &mut Random, framework: &mut Framework) {
    for _ in 0..2 + random.below(3) {
        let at = random.vector(framework.dimension, 1.5);
        framework.add(at);
    }
    let room = framework.particles.len() * framework.dimension - 1;
    for _ in 0..1 + random.below(room.min(4)) {
        let depth = 1 + random.below(3);
        let formula = if random.chance(0.4) {
            word(random, framework) + smooth(random, framework, depth, false)
        } else {
            let time = random.chance(0.3);
            smooth(random, framework, depth, time)
        };
        let row = framework.kept(formula);
        framework.conditions.push(Condition::Expression { rows: vec![row] });
    }
    if random.chance(0.5) {
        let [a, b] = random.two(framework.particles.len());
        framework.rod(random, a, b);
    }
}

/// A formula of t that is smooth and changes by little.
fn drive(random: &mut Random, framework: &mut Framework, at: f64) -> Formula {
    let frequency = random.between(0.5, 12.0);
    let rate = if random.chance(0.5) {
        let name = format!("rate{}", framework.parameters.len());
        framework.parameters.push((name.clone(), frequency));
        Formula::Parameter(name, frequency)
    } else {
        number(frequency)
    };
    let swing = number(random.between(0.02, 0.15)) * of(Function::Sin, rate * Formula::Time);
    match random.below(3) {
        0 => number(at) + swing,
        1 => number(at) + number(random.between(-0.5, 0.5)) * Formula::Time,
        _ => number(at) + swing + number(random.between(-0.3, 0.3)) * power(Formula::Time, 2),
    }
}

/// A tree with a driven rod, a driven nail or both.
pub(super) fn drives(random: &mut Random, framework: &mut Framework) {
    shapes::tree(random, framework);
    let rods = framework.conditions.iter().filter(|condition| matches!(condition, Condition::Rod { .. })).count();
    let driven = random.below(rods);
    let places: Vec<f64> = framework
        .conditions
        .iter()
        .filter_map(|condition| match condition {
            Condition::Rod { between: [a, b], .. } => Some(framework.apart(*a, *b)),
            _ => None,
        })
        .collect();
    let formula = drive(random, framework, places[driven]);
    let mut rods = framework.conditions.iter_mut().filter(|condition| matches!(condition, Condition::Rod { .. }));
    if let Some(Condition::Rod { length, squared, .. }) = rods.nth(driven) {
        // A driven rod has the form `length` alone.
        (*length, *squared) = (formula, false);
    }
    let last = framework.particles.len() - 1;
    if random.chance(0.5) {
        let at = framework.particles[last].at;
        let at = (0..framework.dimension).map(|axis| drive(random, framework, at[axis])).collect();
        framework.conditions.push(Condition::Nail { particle: last, at });
    }
}

/// Adds rows that say what others say: the same again, in the other form, as an expression, as a sum.
pub(super) fn repeat(random: &mut Random, framework: &mut Framework) {
    if framework.conditions.is_empty() || random.chance(0.6) {
        return;
    }
    for _ in 0..1 + random.below(2) {
        let chosen = random.pick(&framework.conditions).clone();
        let rows = chosen.rows(framework.dimension);
        let again = match chosen {
            Condition::Rod { between, length: Formula::Number(length), squared } if random.chance(0.5) => {
                let squared = if random.chance(0.3) { squared } else { !squared };
                Condition::Rod { between, length: number(length), squared }
            }
            // A factor that changes nothing: C = 0 and f C = 0 say the same where f is not zero.
            _ => {
                let row = random.pick(&rows).clone();
                let factor = *random.pick(&[-1.0, 1000.0, 0.01, 2.0]);
                let other = random.pick(&framework.conditions).rows(framework.dimension);
                let sum = match random.below(3) {
                    0 => number(factor) * row,
                    1 => number(factor) * row + random.pick(&other).clone(),
                    _ => row * (number(1.5) + of(Function::Cos, coordinate(random, framework))),
                };
                Condition::Expression { rows: vec![sum] }
            }
        };
        framework.conditions.push(again);
    }
}

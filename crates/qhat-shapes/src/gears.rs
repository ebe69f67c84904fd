//! The shapes of gears: pitch circles, and the line along which a rack runs.

use crate::list::Shapes;
use crate::shape::{Shape, ShapeKind};
use qhat::{Gears, ParticleId};

/// Adds the wheels of one constraint. For two wheels that mesh outside each other, the radii of the pitch circles are
/// in the ratio of the teeth and add up to the distance of the centres. The circle of any other wheel passes through
/// the marked point of its arm.
pub(crate) fn add(gears: &Gears, shapes: &mut Shapes<'_>) {
    let wheel = |arm: [ParticleId; 2], radius| Shape::new(ShapeKind::Wheel, shapes.of, arm).sized(radius);
    let turns: Vec<_> = gears.turns().collect();
    let ways: Vec<_> = gears.ways().collect();
    let new: Vec<Shape> = match (&turns[..], &ways[..]) {
        (&[(a, za), (b, zb), (centres, z)], []) if za * zb > 0 && za + zb == -z && centres == [a[0], b[0]] => {
            let tooth = length(centres, shapes) / f64::from(z.abs());
            [(a, za), (b, zb)].map(|(arm, z)| wheel(arm, tooth * f64::from(z.abs()))).into()
        }
        (&[(pinion, _)], &[(rack, [x, y])]) => {
            let line = Shape::new(ShapeKind::Line, shapes.of, [rack[1]]).at([[x, y, 0.0]]);
            vec![wheel(pinion, 1.0 / (x * x + y * y).sqrt()), line]
        }
        _ => turns.iter().map(|&(arm, _)| wheel(arm, length(arm, shapes))).collect(),
    };
    for shape in new {
        shapes.push(shape);
    }
}

/// The distance of two particles \[m\].
fn length([a, b]: [ParticleId; 2], shapes: &Shapes<'_>) -> f64 {
    let (d, q) = (shapes.system.dimension(), shapes.state.positions());
    (0..d).map(|k| q[d * a.index() + k] - q[d * b.index() + k]).map(|x| x * x).sum::<f64>().sqrt()
}

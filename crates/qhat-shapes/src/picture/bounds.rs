//! The points of a scene that must be inside the picture.

use super::vector::{Vec3, dot, minus, plus, scaled};
use super::view::sag;
use super::{Picture, gravity};
use crate::shape::{Shape, ShapeKind};

/// Particles, and the corners of the boxes around all bounded shapes. Lines and planes without ends add no points,
/// because they cross the picture anyway. The ground adds the point below the middle of the others.
pub(super) fn points(picture: &Picture<'_>, places: &[Vec3], shapes: &[Shape]) -> Vec<Vec3> {
    let dimension = picture.system.dimension();
    let mut all = places.to_vec();
    for shape in shapes {
        match shape.kind {
            ShapeKind::Nail | ShapeKind::Wire | ShapeKind::DrivenRod => all.extend(&shape.points),
            ShapeKind::Box => all.extend(around(shape.points[0], shape.points[1], dimension)),
            ShapeKind::Ring | ShapeKind::Ball | ShapeKind::Bowl | ShapeKind::Wheel => {
                let centre =
                    shape.particles.first().map_or_else(|| shape.points[0], |particle| places[particle.index()]);
                all.extend(around(centre, [shape.size; 3], dimension));
            }
            ShapeKind::Rope => {
                let [a, b] = [0, 1].map(|k: usize| places[shape.particles[k].index()]);
                let middle = scaled(plus(a, b), 0.5);
                let down = gravity(picture.system);
                let fall = if dot(down, down) > 0.0 { scaled(down, 1.0 / dot(down, down).sqrt()) } else { [0.0; 3] };
                all.push(plus(middle, scaled(fall, sag(shape.size, minus(a, b)))));
            }
            _ => (),
        }
    }
    let grounds = shapes.iter().filter(|shape| shape.kind == ShapeKind::Ground);
    let feet: Vec<Vec3> = grounds.map(|ground| foot(middle(&all), ground)).collect();
    all.extend(feet);
    all
}

/// The corners of a box.
fn around(centre: Vec3, half: Vec3, dimension: usize) -> impl Iterator<Item = Vec3> {
    (0..8).map(move |corner| {
        std::array::from_fn(|k| {
            let side = if corner >> k & 1 == 0 { -1.0 } else { 1.0 };
            if k < dimension { centre[k] + side * half[k] } else { 0.0 }
        })
    })
}

/// The middle of the box around points.
fn middle(points: &[Vec3]) -> Vec3 {
    std::array::from_fn(|k| {
        let low = points.iter().map(|point| point[k]).fold(f64::INFINITY, f64::min);
        let high = points.iter().map(|point| point[k]).fold(f64::NEG_INFINITY, f64::max);
        if low <= high { 0.5 * low + 0.5 * high } else { 0.0 }
    })
}

/// The point of the ground that is nearest to a place.
fn foot(place: Vec3, ground: &Shape) -> Vec3 {
    let [point, normal] = [ground.points[0], ground.points[1]];
    minus(place, scaled(normal, dot(minus(place, point), normal)))
}

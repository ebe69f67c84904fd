//! The shapes of forces. A test fails for a kind that the match over the kinds does not name.

use crate::list::Shapes;
use crate::shape::{Shape, ShapeKind, Source};
use qhat::{Facet, Force, ParticleId};

/// Adds the shapes of all forces; closed loops under pressure come last.
pub(crate) fn add(forces: &[Force], shapes: &mut Shapes<'_>) {
    let mut outlines = Vec::new();
    for (i, force) in forces.iter().enumerate() {
        shapes.of = Source::Force(i);
        match force {
            Force::Spring(spring) => add_spring([spring.a, spring.b], spring.rest, shapes),
            Force::CubicSpring(spring) => add_spring([spring.a, spring.b], spring.rest, shapes),
            Force::Actuator(actuator) => {
                shapes.push(Shape::new(ShapeKind::Actuator, shapes.of, [actuator.a, actuator.b]));
            }
            Force::Pressure(pressure) => add_facet(&pressure.facet, &mut outlines, shapes),
            Force::Gas(gas) => gas.facets().iter().for_each(|facet| add_facet(facet, &mut outlines, shapes)),
            // Forces on one particle, forces on all particles and forces at a distance have no shape.
            Force::Gravity(_)
            | Force::Drag(_)
            | Force::PointForce(_)
            | Force::MouseSpring(_)
            | Force::ExpressionForce(_)
            | Force::ExpressionPotential(_)
            | Force::CustomForce(_)
            | Force::CentralForce(_)
            | Force::InverseSquare(_)
            | Force::AirDrag(_)
            | Force::HarmonicForce(_)
            // The arms of a torsion spring are drawn as the rods that hold them.
            | Force::TorsionSpring(_) => (),
            // The engine's list of kinds may grow; a test fails for a kind that is not named above.
            _ => (),
        }
    }
    for Outline { of, corners } in outlines {
        shapes.push(Shape::new(ShapeKind::Area, of, corners));
    }
}

fn add_spring(ends: [ParticleId; 2], rest: f64, shapes: &mut Shapes<'_>) {
    shapes.push(Shape::new(ShapeKind::Spring, shapes.of, ends).sized(rest));
}

/// A loop of edges under pressure.
struct Outline {
    /// The force on the first edge of the loop.
    of: Source,
    corners: Vec<ParticleId>,
}

/// Adds the shape of a triangle, or adds an edge to the outline that it continues. Edges of one loop follow each other.
fn add_facet(facet: &Facet, outlines: &mut Vec<Outline>, shapes: &mut Shapes<'_>) {
    match *facet {
        Facet::Edge([a, b]) => match outlines.last_mut() {
            Some(outline) if outline.corners.last() == Some(&a) => outline.corners.push(b),
            _ => outlines.push(Outline { of: shapes.of, corners: vec![a, b] }),
        },
        Facet::Triangle(corners) => shapes.push(Shape::new(ShapeKind::Area, shapes.of, corners)),
    }
}

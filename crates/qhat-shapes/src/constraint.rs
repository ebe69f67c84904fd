//! The shapes of constraints. A test fails for a kind that the match over the kinds does not name.

use crate::gears;
use crate::list::Shapes;
use crate::shape::{Shape, ShapeKind, value};
use qhat::{
    Anchor, Constraint, Driven, Lengths, Limits, Line, Obstacle, OnCircle, OnEllipse, OnLine, OnPlane, OnSphere, Plane,
    Relation, Surface,
};

/// Number of pieces of a drawn wire: on a full screen each piece is about ten pixels long.
const PIECES: usize = 192;

/// Least sum of weights with which a relation counts as tied to a point. A relation whose weights add up to less ties
/// particles to each other. Sums that are 0 or 1 in exact arithmetic (of thirds) have a rounding error of 1e-16.
const NO_WEIGHT: f64 = 1e-9;

/// Adds the shapes of one constraint.
pub(crate) fn add(constraint: &Constraint, shapes: &mut Shapes<'_>) {
    let new = |kind| Shape::new(kind, shapes.of, []);
    match constraint {
        Constraint::Distance(rod) => {
            let shape = Shape::new(ShapeKind::Rod, shapes.of, [rod.a, rod.b]);
            shapes.push_link(shape.sized(rod.length));
        }
        Constraint::Limits(limits) => add_limits(limits, shapes),
        Constraint::Nail(nail) => {
            shapes.push(Shape::new(ShapeKind::Nail, shapes.of, [nail.particle]).at([nail.at]));
        }
        // A residual of a user has no shape.
        Constraint::ExpressionConstraint(_) | Constraint::Custom(_) => (),
        Constraint::Obstacle(obstacle) => add_obstacle(obstacle, shapes),
        Constraint::Relation(relation) => add_relation(relation, shapes),
        Constraint::Lengths(lengths) => add_lengths(lengths, shapes),
        Constraint::Angle(angle) => {
            let (from, to) = angle.arms();
            shapes.push(match from {
                Some(from) => Shape::new(ShapeKind::Angle, shapes.of, [from, to].concat()),
                None => Shape::new(ShapeKind::Angle, shapes.of, to).at([angle.direction()]),
            });
        }
        Constraint::Gears(gears) => gears::add(gears, shapes),
        Constraint::Area(area) => shapes.push(Shape::new(ShapeKind::Area, shapes.of, area.corners.clone())),
        Constraint::Volume(volume) => {
            for corners in volume.triangles() {
                shapes.push(Shape::new(ShapeKind::Area, shapes.of, corners));
            }
        }
        Constraint::Direction(direction) => {
            shapes.push(Shape::new(ShapeKind::Tie, shapes.of, [direction.a, direction.b]));
        }
        Constraint::OnLine(on) => add_line(on, shapes),
        Constraint::OnPlane(on) => add_plane(on, shapes),
        Constraint::OnSphere(sphere) => add_sphere(sphere, shapes),
        Constraint::OnCircle(OnCircle { center, axis, radius, .. }) => {
            let ring = new(ShapeKind::Ring).at([*axis]).around(center, shapes.t);
            shapes.push(ring.sized(radius.value(shapes.t)).following([radius]));
        }
        Constraint::OnEllipse(ellipse) => add_ellipse(ellipse, shapes),
        Constraint::OnCurve(on) => {
            let wire = new(ShapeKind::Wire).at(on.curve.drawn(PIECES));
            shapes.push_shared(wire);
        }
        // The engine's list of kinds may grow; a test fails for a kind that is not named above.
        _ => (),
    }
}

/// A constraint with both limits is drawn as one strut; a rope beside the strut would look like a second constraint.
fn add_limits(limits: &Limits, shapes: &mut Shapes<'_>) {
    let (kind, size) = match (limits.shortest, limits.longest) {
        (Some(shortest), _) => (ShapeKind::Strut, shortest),
        (None, longest) => (ShapeKind::Rope, longest.unwrap_or_default()),
    };
    shapes.push_link(Shape::new(kind, shapes.of, [limits.a, limits.b]).sized(size));
}

fn add_obstacle(obstacle: &Obstacle, shapes: &mut Shapes<'_>) {
    let new = |kind| Shape::new(kind, shapes.of, []);
    let shape = match obstacle.surface {
        Surface::HalfSpace { normal, offset } => {
            let size = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            let unit = normal.map(|n| n / size);
            new(ShapeKind::Ground).at([unit.map(|n| n * offset), unit])
        }
        Surface::Ball { center, radius, inside } => {
            new(if inside { ShapeKind::Bowl } else { ShapeKind::Ball }).at([center]).sized(radius)
        }
        Surface::Box { center, half } => new(ShapeKind::Box).at([center, half]),
    };
    shapes.push_shared(shape);
}

/// A relation of one particle is drawn as a nail. A relation of several particles whose weights add up
/// to zero is drawn as ties from the first particle to the others.
fn add_relation(relation: &Relation, shapes: &mut Shapes<'_>) {
    if let [(particle, weight)] = relation.terms[..] {
        let place = value(&relation.point, shapes.t).map(|p| p / weight);
        shapes.push(Shape::new(ShapeKind::Nail, shapes.of, [particle]).at([place]).following(&relation.point));
    } else if relation.terms.iter().map(|(_, weight)| weight).sum::<f64>().abs() < NO_WEIGHT {
        let first = relation.terms[0].0;
        for &(other, _) in &relation.terms[1..] {
            shapes.push(Shape::new(ShapeKind::Tie, shapes.of, [first, other]));
        }
    }
}

/// A sum of lengths is drawn as a rope over pulleys, a relation between lengths as ties between their ends.
fn add_lengths(lengths: &Lengths, shapes: &mut Shapes<'_>) {
    let is_cord = lengths.segments().all(|(_, weight)| weight > 0.0);
    let kind = if is_cord { ShapeKind::Cord } else { ShapeKind::Tie };
    for (ends, _) in lengths.segments() {
        shapes.push(Shape::new(kind, shapes.of, ends));
    }
}

fn add_line(on: &OnLine, shapes: &mut Shapes<'_>) {
    let t = shapes.t;
    shapes.push(match &on.line {
        Line::Through(point, along) => {
            let line = Shape::new(ShapeKind::Line, shapes.of, []).at([value(point, t), value(along, t)]);
            line.following(point).following(along)
        }
        Line::Particles(a, b) => Shape::new(ShapeKind::Line, shapes.of, [*a, *b]),
    });
}

/// In two dimensions a plane is drawn as the line at right angles to its normal.
fn add_plane(on: &OnPlane, shapes: &mut Shapes<'_>) {
    let (t, of) = (shapes.t, shapes.of);
    let shape = match &on.plane {
        Plane::Across(point, normal) => {
            let [x, y, z] = value(normal, t);
            let (kind, direction) = match shapes.system.dimension() {
                2 => (ShapeKind::Line, [-y, x, 0.0]),
                _ => (ShapeKind::Plane, [x, y, z]),
            };
            Shape::new(kind, of, []).at([value(point, t), direction]).following(point).following(normal)
        }
        Plane::Particles(corners) => Shape::new(ShapeKind::Area, of, *corners),
    };
    shapes.push(shape);
}

/// An ellipse about a point is a wire. About a particle it is drawn as a tie: a wire has no particles to follow.
fn add_ellipse(ellipse: &OnEllipse, shapes: &mut Shapes<'_>) {
    let OnEllipse { particle, center, along: [ux, uy, _], half } = ellipse;
    let Anchor::Point(center) = center else {
        shapes.push(Shape::new(ShapeKind::Tie, shapes.of, [*particle]).around(center, shapes.t));
        return;
    };
    let [x, y, _] = value(center, shapes.t);
    let [a, b] = half.each_ref().map(|half| half.value(shapes.t));
    let size = (ux * ux + uy * uy).sqrt();
    let points = (0..=PIECES).map(|i| {
        let (sine, cosine) = (std::f64::consts::TAU * i as f64 / PIECES as f64).sin_cos();
        [x + (a * cosine * ux - b * sine * uy) / size, y + (a * cosine * uy + b * sine * ux) / size, 0.0]
    });
    let wire = Shape::new(ShapeKind::Wire, shapes.of, []).at(points.collect::<Vec<_>>());
    shapes.push(wire.following(center).following(half));
}

/// A sphere at rest is drawn as a circle or bowl, and a sphere that moves as a rod whose length changes.
fn add_sphere(sphere: &OnSphere, shapes: &mut Shapes<'_>) {
    let OnSphere { particle, center, radius, .. } = sphere;
    let at_rest = matches!(radius, Driven::Constant(_)) && matches!(center, Anchor::Point(_));
    let shape = match (at_rest, shapes.system.dimension()) {
        (true, 2) => Shape::new(ShapeKind::Ring, shapes.of, []).at([[0.0, 0.0, 1.0]]),
        (true, _) => Shape::new(ShapeKind::Bowl, shapes.of, []),
        (false, _) => Shape::new(ShapeKind::DrivenRod, shapes.of, [*particle]),
    };
    shapes.push(shape.around(center, shapes.t).sized(radius.value(shapes.t)).following([radius]));
}

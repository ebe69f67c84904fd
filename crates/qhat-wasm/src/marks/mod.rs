//! What holds the particles beside rods, nails and springs, as primitives that a page can draw.
//!
//! A mark names particles, whose places the page knows at every frame, and points of the scene at t. Only a mark that follows t is worth
//! asking for again. What has no picture (an expression) has no mark.

use qhat::{
    Anchor, Constraint, Driven, DrivenPoint, Facet, Force, Gears, Limits, Line, Obstacle, OnCircle, OnSphere,
    ParticleId, Plane, Relation, State, Surface, System,
};

/// Pieces of a drawn wire: on a whole screen each is some ten pixels long.
const PIECES: usize = 192;

/// One thing to draw. What particles, points \[m\] and size \[m\] are of each kind stands in `types.d.ts`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mark {
    pub(crate) kind: &'static str,
    pub(crate) particles: Vec<ParticleId>,
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) size: f64,
    /// Whether it follows t.
    pub(crate) driven: bool,
}

impl Mark {
    fn new(kind: &'static str, particles: impl Into<Vec<ParticleId>>) -> Self {
        Mark { kind, particles: particles.into(), ..Mark::default() }
    }

    fn at(self, points: impl Into<Vec<[f64; 3]>>) -> Self {
        Mark { points: points.into(), ..self }
    }

    fn sized(self, size: f64) -> Self {
        Mark { size, ..self }
    }

    /// Says that it follows t if one of these does.
    fn following<'a>(self, schedules: impl IntoIterator<Item = &'a Driven>) -> Self {
        let driven = schedules.into_iter().any(|schedule| matches!(schedule, Driven::Function(_)));
        Mark { driven: self.driven || driven, ..self }
    }

    /// Puts its centre first: a particle, or a point at t.
    fn around(mut self, center: &Anchor, t: f64) -> Self {
        match center {
            Anchor::Particle(particle) => self.particles.insert(0, *particle),
            Anchor::Point(point) => {
                self.points.insert(0, value(point, t));
                return self.following(point);
            }
        }
        self
    }
}

/// What holds the particles at t \[s\].
pub(crate) fn marks(system: &System, state: &State, t: f64) -> Vec<Mark> {
    let mut marks = Vec::new();
    for named in system.constraints() {
        add(&named.constraint, system, state, t, &mut marks);
    }
    let mut outlines: Vec<Vec<ParticleId>> = Vec::new();
    for force in system.forces() {
        match force {
            Force::CubicSpring(spring) => marks.push(Mark::new("spring", [spring.a, spring.b])),
            Force::Actuator(actuator) => marks.push(Mark::new("actuator", [actuator.a, actuator.b])),
            Force::Pressure(pressure) => add_facet(&pressure.facet, &mut outlines, &mut marks),
            Force::Gas(gas) => gas.facets().iter().for_each(|facet| add_facet(facet, &mut outlines, &mut marks)),
            _ => (),
        }
    }
    marks.extend(outlines.into_iter().map(|outline| Mark::new("area", outline)));
    marks
}

/// The edges of an outline come one after the other.
fn add_facet(facet: &Facet, outlines: &mut Vec<Vec<ParticleId>>, marks: &mut Vec<Mark>) {
    match *facet {
        Facet::Edge([a, b]) => match outlines.last_mut() {
            Some(outline) if outline.last() == Some(&a) => outline.push(b),
            _ => outlines.push(vec![a, b]),
        },
        Facet::Triangle(corners) => marks.push(Mark::new("area", corners)),
    }
}

fn add(constraint: &Constraint, system: &System, state: &State, t: f64, marks: &mut Vec<Mark>) {
    match constraint {
        Constraint::Distance(_) | Constraint::Nail(_) | Constraint::ExpressionConstraint(_) => (),
        Constraint::Limits(limits) => add_limits(limits, marks),
        Constraint::Obstacle(barrier) => add_barrier(barrier, marks),
        Constraint::Relation(relation) => add_relation(relation, t, marks),
        Constraint::Lengths(lengths) => {
            let is_cord = lengths.segments().all(|(_, weight)| weight > 0.0);
            let kind = if is_cord { "cord" } else { "tie" };
            marks.extend(lengths.segments().map(|(ends, _)| Mark::new(kind, ends)));
        }
        Constraint::Angle(angle) => {
            let (from, to) = angle.arms();
            marks.push(match from {
                Some(from) => Mark::new("angle", [from, to].concat()),
                None => Mark::new("angle", to).at([angle.direction()]),
            });
        }
        Constraint::Gears(gears) => add_gears(gears, system, state, marks),
        Constraint::Area(area) => marks.push(Mark::new("area", area.corners.clone())),
        Constraint::Volume(volume) => marks.extend(volume.triangles().map(|corners| Mark::new("area", corners))),
        Constraint::Direction(direction) => marks.push(Mark::new("tie", [direction.a, direction.b])),
        Constraint::OnLine(on) => marks.push(match &on.line {
            Line::Through(point, along) => {
                Mark::new("line", []).at([value(point, t), value(along, t)]).following(point).following(along)
            }
            Line::Particles(a, b) => Mark::new("line", [*a, *b]),
        }),
        Constraint::OnPlane(on) => marks.push(match &on.plane {
            Plane::Across(point, normal) if system.dimension() == 2 => {
                let [x, y, _] = value(normal, t);
                Mark::new("line", []).at([value(point, t), [-y, x, 0.0]]).following(point).following(normal)
            }
            Plane::Across(point, normal) => {
                Mark::new("plane", []).at([value(point, t), value(normal, t)]).following(point).following(normal)
            }
            Plane::Particles(corners) => Mark::new("area", *corners),
        }),
        Constraint::OnSphere(sphere) => add_sphere(sphere, system, t, marks),
        Constraint::OnCircle(OnCircle { center, axis, radius, .. }) => {
            marks.push(Mark::new("ring", []).at([*axis]).around(center, t).sized(radius.value(t)).following([radius]))
        }
        Constraint::OnCurve(on) => {
            push_once(Mark::new("wire", []).at(on.curve.drawn(PIECES)), marks);
        }
        _ => (),
    }
}

fn add_limits(limits: &Limits, marks: &mut Vec<Mark>) {
    let ends = [limits.a, limits.b];
    // With both it is stiff, though loose: a rope hanging beside it would be a second thing.
    marks.extend(match (limits.shortest, limits.longest) {
        (Some(shortest), _) => Some(Mark::new("strut", ends).sized(shortest)),
        (None, longest) => longest.map(|longest| Mark::new("rope", ends).sized(longest)),
    });
}

fn add_barrier(barrier: &Obstacle, marks: &mut Vec<Mark>) {
    let mark = match barrier.surface {
        Surface::HalfSpace { normal, offset } => {
            let size = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            let unit = normal.map(|n| n / size);
            Mark::new("ground", []).at([unit.map(|n| n * offset), unit])
        }
        Surface::Ball { center, radius, inside } => {
            Mark::new(if inside { "bowl" } else { "ball" }, []).at([center]).sized(radius)
        }
        Surface::Box { center, half } => Mark::new("box", []).at([center, half]),
    };
    push_once(mark, marks);
}

/// What tells several particles to be somewhere together is drawn from the first to the others; a lone one that is led, as a nail.
fn add_relation(relation: &Relation, t: f64, marks: &mut Vec<Mark>) {
    if let [(particle, weight)] = relation.terms[..] {
        let place = value(&relation.point, t).map(|p| p / weight);
        marks.push(Mark::new("nail", [particle]).at([place]).following(&relation.point));
    } else if relation.terms.iter().map(|(_, weight)| weight).sum::<f64>().abs() < 1e-9 {
        // Weights that add up to 0 tie the particles to each other, whatever the rounding of thirds; others tie them to a point.
        let first = relation.terms[0].0;
        marks.extend(relation.terms[1..].iter().map(|&(other, _)| Mark::new("tie", [first, other])));
    }
}

/// A circle to run along where nothing moves it, a rod of changing length where something does.
fn add_sphere(sphere: &OnSphere, system: &System, t: f64, marks: &mut Vec<Mark>) {
    let OnSphere { particle, center, radius } = sphere;
    let size = radius.value(t);
    let still = matches!(radius, Driven::Constant(_)) && matches!(center, Anchor::Point(_));
    let mark = if still && system.dimension() == 2 {
        Mark::new("ring", []).at([[0.0, 0.0, 1.0]])
    } else if still {
        Mark::new("bowl", [])
    } else {
        Mark::new("rod", [*particle])
    };
    marks.push(mark.around(center, t).sized(size).following([radius]));
}

/// Pitch circles: of two wheels that mesh from outside, from the distance of their centres; else through the marked points.
fn add_gears(gears: &Gears, system: &System, state: &State, marks: &mut Vec<Mark>) {
    let length = |[a, b]: [ParticleId; 2]| {
        let (d, q) = (system.dimension(), state.positions());
        (0..d).map(|k| q[d * a.index() + k] - q[d * b.index() + k]).map(|x| x * x).sum::<f64>().sqrt()
    };
    let turns: Vec<_> = gears.turns().collect();
    let ways: Vec<_> = gears.ways().collect();
    match (&turns[..], &ways[..]) {
        (&[(a, za), (b, zb), (centres, z)], []) if za * zb > 0 && za + zb == -z && centres == [a[0], b[0]] => {
            let tooth = length(centres) / f64::from(z.abs());
            marks.extend([(a, za), (b, zb)].map(|(arm, z)| Mark::new("wheel", arm).sized(tooth * f64::from(z.abs()))));
        }
        (&[(pinion, _)], &[(rack, [x, y])]) => {
            marks.push(Mark::new("wheel", pinion).sized(1.0 / (x * x + y * y).sqrt()));
            marks.push(Mark::new("line", [rack[1]]).at([[x, y, 0.0]]));
        }
        _ => marks.extend(turns.iter().map(|&(arm, _)| Mark::new("wheel", arm).sized(length(arm)))),
    }
}

/// Surfaces and wires that many particles share are drawn once.
fn push_once(mark: Mark, marks: &mut Vec<Mark>) {
    if !marks.contains(&mark) {
        marks.push(mark);
    }
}

fn value(point: &DrivenPoint, t: f64) -> [f64; 3] {
    [0, 1, 2].map(|k: usize| point[k].value(t))
}

#[cfg(test)]
mod tests;

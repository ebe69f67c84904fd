//! `[[constraints]]` of spheres, circles, ellipses and wires.

use super::Assembly;
use crate::model::curves::{Circle, Curve, Ellipse, Sphere};
use crate::model::{Driven, DrivenVector, Id, Parameters};
use crate::tree::Node;
use qhat::{Anchor, GeometryError, ParticleId, Purpose};

/// The keys that a sphere and a circle share.
struct Round<'a> {
    kind: &'static str,
    particle: &'a Id,
    around: Option<&'a Id>,
    center: Option<&'a DrivenVector>,
    radius: Option<&'a Driven>,
}

impl Assembly<'_, '_, '_> {
    pub(super) fn add_sphere(&mut self, it: &Sphere, place: &Node) -> Option<()> {
        let Sphere { particle, around, center, radius, .. } = it;
        let (around, center, radius) = (around.as_ref(), center.as_ref(), radius.as_ref());
        let round = Round { kind: "sphere", particle, around, center, radius };
        let (particle, center, radius) = self.round(&round, place)?;
        self.add_named(it, qhat::OnSphere::new(particle, center, radius));
        Some(())
    }

    pub(super) fn add_circle(&mut self, it: &Circle, place: &Node) -> Option<()> {
        let Circle { particle, around, center, radius, .. } = it;
        let (around, center, radius) = (around.as_ref(), center.as_ref(), radius.as_ref());
        let round = Round { kind: "circle", particle, around, center, radius };
        let (particle, center, radius) = self.round(&round, place)?;
        match (&it.axis, self.dimension) {
            (None, 2) => self.add_named(it, qhat::OnSphere::new(particle, center, radius)),
            (Some(axis), 3) => {
                let axis = axis.padded();
                self.add_named(it, qhat::OnCircle { particle, center, axis, radius });
            }
            (Some(_), _) => {
                let message = "a circle has no axis in two dimensions";
                self.report.error(place.key("axis").span.clone(), message, Some("leave out `axis`".into()));
            }
            // The check against the schema has refused the axis already.
            (None, _) if place.get("axis").is_some() => {}
            (None, _) => {
                let message = "a circle needs an `axis` in three dimensions";
                let help =
                    "add `axis`, a vector at right angles to the circle, as in `axis = [0.0, 1.0, 0.0]`".to_owned();
                self.report.error(place.span.clone(), message, Some(help));
            }
        }
        Some(())
    }

    /// The particle, the centre and the radius.
    fn round(&mut self, it: &Round<'_>, place: &Node) -> Option<(ParticleId, Anchor, qhat::Driven)> {
        let (particle, center) = self.centred(it.kind, it.particle, (it.around, it.center), place)?;
        let radius = match it.radius {
            Some(radius) => self.schedule(radius, place.key("radius"))?,
            None => qhat::Driven::Constant(self.measured_radius(it.kind, particle, &center, place)?),
        };
        Some((particle, center, radius))
    }

    /// The particle, and the centre: another particle, or a point.
    fn centred(
        &mut self,
        kind: &str,
        particle: &Id,
        centre: (Option<&Id>, Option<&DrivenVector>),
        place: &Node,
    ) -> Option<(ParticleId, Anchor)> {
        match centre {
            (Some(around), None) => {
                let ids = [(particle, place.key("particle")), (around, place.key("around"))];
                let [particle, around] = self.different_at(ids)?;
                Some((particle, Anchor::Particle(around)))
            }
            (None, Some(center)) => {
                let particle = self.particle(particle, place.key("particle"))?;
                Some((particle, Anchor::Point(self.schedules(center, place.key("center"))?)))
            }
            (given, _) => {
                self.needs_one(place, kind, ["center", "around"], given.is_some());
                None
            }
        }
    }

    pub(super) fn add_ellipse(&mut self, it: &Ellipse, place: &Node) -> Option<()> {
        let centre = (it.around.as_ref(), it.center.as_ref());
        let (particle, center) = self.centred("ellipse", &it.particle, centre, place)?;
        self.in_plane(place, "a particle stays on an ellipse")?;
        let along = it.along.as_ref().map_or([1.0, 0.0, 0.0], |along| along.padded());
        let half_along = self.schedule(&it.half_along, place.key("half_along"))?;
        let half_across = self.schedule(&it.half_across, place.key("half_across"))?;
        self.add_named(it, qhat::OnEllipse { particle, center, along, half: [half_along, half_across] });
        Some(())
    }

    /// The distance of a particle from the centre at the start [m].
    fn measured_radius(&mut self, kind: &str, particle: ParticleId, center: &Anchor, place: &Node) -> Option<f64> {
        let x = self.start(particle);
        let p = match center {
            Anchor::Particle(other) => self.start(*other),
            Anchor::Point(point) => point.each_ref().map(|component| component.value(0.0)),
        };
        let squares: f64 = (0..self.dimension).map(|k| x[k] - p[k]).map(|x| x * x).sum();
        let length = squares.sqrt();
        if length > 0.0 && length.is_finite() {
            return Some(length);
        }
        let message = format!("a {kind} needs a radius, but the particle starts at its centre or too far away");
        self.report.error(place.span.clone(), message, Some("give `radius` [m]".into()));
        None
    }

    pub(super) fn add_curve(&mut self, it: &Curve, place: &Node) -> Option<()> {
        let particle = self.particle(&it.particle, place.key("particle"))?;
        self.refuse_foreign_keys(it, place)?;
        let curve = match (&it.path, &it.points) {
            (Some(path), None) => self.path(path, it.range, place)?,
            (None, Some(points)) => {
                let points: Vec<_> = points.iter().map(|point| point.padded()).collect();
                match it.radius {
                    Some(radius) => qhat::Curve::polyline(&points, radius, it.closed),
                    None => qhat::Curve::through(&points, it.closed),
                }
            }
            (given, _) => {
                self.needs_one(place, "curve", ["path", "points"], given.is_some());
                return None;
            }
        };
        match curve {
            Ok(curve) => {
                self.add_named(it, qhat::OnCurve { particle, curve });
                Some(())
            }
            Err(error) => {
                let span = if it.radius.is_some() { &place.key("points").span } else { &place.span };
                self.report.error(span.clone(), error.to_string(), None);
                None
            }
        }
    }

    /// `None` after reporting a key that does not go with the way in which the curve is given.
    fn refuse_foreign_keys(&mut self, it: &Curve, place: &Node) -> Option<()> {
        let (keys, given, other) = match (&it.path, &it.points) {
            (Some(_), None) => (&["radius", "closed"][..], "path", "points"),
            (None, Some(_)) => (&["range"][..], "points", "path"),
            _ => return Some(()),
        };
        let Some(key) = keys.iter().find(|key| place.get(key).is_some()) else { return Some(()) };
        let message = format!("`{key}` goes with `{other}`, but this curve is given by `{given}`");
        self.report.error(place.key(key).span.clone(), message, Some(format!("leave out `{key}`")));
        None
    }

    /// A curve given by an expression of s for each coordinate.
    fn path(
        &mut self,
        path: &[String],
        range: Option<[f64; 2]>,
        place: &Node,
    ) -> Option<Result<qhat::Curve, GeometryError>> {
        let Some([from, to]) = range else {
            // A range that is written but missing here was refused by the check against the schema.
            if place.get("range").is_none() {
                let help = "add `range`, the values of s at the two ends, as in `range = [0.0, 1.0]`".to_owned();
                self.report.error(place.span.clone(), "a curve by `path` needs a `range`", Some(help));
            }
            return None;
        };
        let list = place.key("path");
        let components: Vec<_> = path
            .iter()
            .enumerate()
            .map(|(k, text)| self.expression(text, Purpose::Curve, &Parameters::new(), list.item(k)))
            .collect();
        Some(qhat::Curve::parametric(components.into_iter().collect::<Option<_>>()?, from, to))
    }
}

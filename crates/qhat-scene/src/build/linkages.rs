//! `[[constraints]]` of mechanisms and of what shapes contain.

use super::Assembly;
use crate::model::{Angle, Area, Gears, Id, LengthRatio, Pulley, Rack, Rigid, Volume};
use crate::tree::Node;
use qhat::{Constraint, Distance, Lengths, ParticleId, rigid_rods};
use std::f64::consts::PI;

/// What is nearer to 0 or π [rad] than this is lost in the roundoff of a step.
const IN_LINE: f64 = 1e-6;

impl Assembly<'_, '_, '_> {
    pub(super) fn add_pulley(&mut self, pulley: &Pulley, place: &Node) -> Option<()> {
        let points = self.named(&pulley.over, place.key("over"))?;
        let stretches = points.len() - 1;
        let weights = match &pulley.weights {
            Some(weights) if weights.len() != stretches => {
                let message = format!("this rope has {stretches} stretches, but {} `weights`", weights.len());
                let help = "give one number for each stretch from a particle to the next".to_owned();
                self.report.error(place.key("weights").span.clone(), message, Some(help));
                return None;
            }
            Some(weights) => weights.clone(),
            None => vec![1.0; stretches],
        };
        let ends = points.windows(2).map(|pair| [pair[0], pair[1]]);
        let segments: Vec<_> = ends.zip(weights).collect();
        let [Id(first), .., Id(last)] = &pulley.over[..] else { unreachable!("the schema asks for two") };
        let name = self.name_of(pulley.id.as_ref(), format!("pulley({first}-{last})"));
        self.add_driven(name, &pulley.length, (place, "length"), |total| Lengths::new(&segments, total).into())
    }

    pub(super) fn add_length_ratio(&mut self, lengths: &LengthRatio, place: &Node) -> Option<()> {
        let ab = self.arm(&lengths.between, place.key("between"));
        let cd = self.arm(&lengths.of, place.key("of"));
        let (ab, cd) = (ab?, cd?);
        let ratio = match lengths.ratio {
            Some(ratio) => ratio,
            None => self.distance(ab[0], ab[1]) / self.distance(cd[0], cd[1]),
        };
        if !(ratio.is_finite() && ratio > 0.0) {
            let message = "the ratio of these lengths at the start cannot be measured";
            self.report.error(place.span.clone(), message, Some("give `ratio`, or lengths above 0 to both".into()));
            return None;
        }
        let [Id(a), Id(b)] = &lengths.between;
        let name = self.name_of(lengths.id.as_ref(), format!("ratio({a}-{b})"));
        self.places.insert(name.clone(), place.span.clone());
        self.builder.constraint(name, Lengths::ratio(ab, cd, ratio));
        Some(())
    }

    pub(super) fn add_angle(&mut self, angle: &Angle, place: &Node) -> Option<()> {
        let arm = self.arm(&angle.arm, place.key("arm"))?;
        let Angle { from, direction, .. } = angle;
        if from.is_some() && direction.is_some() {
            let message = "an angle is counted from an arm or from a direction, not from both";
            self.report.error(
                place.key("direction").span.clone(),
                message,
                Some("leave out `from` or `direction`".into()),
            );
            return None;
        }
        let from = match from {
            Some(from) => Some(self.arm(from, place.key("from"))?),
            None => None,
        };
        let direction = direction.as_ref().map_or([1.0, 0.0, 0.0], |direction| direction.padded());
        let make = |angle: qhat::Driven| -> Constraint {
            match from {
                Some(from) => qhat::Angle::between(from, arm, angle).into(),
                None => qhat::Angle::from_direction(direction, arm, angle).into(),
            }
        };
        let at_start = make(0.0.into()).residual(self.dimension_of_system(), &self.positions)[0];
        if self.dimension == 3 && (at_start.abs() < IN_LINE || (PI - at_start.abs()).abs() < IN_LINE) {
            let message = "the arm starts in one line with what its angle is counted from, where in space an angle has no direction to change in";
            self.report.error(
                place.key("arm").span.clone(),
                message,
                Some("start with an angle between 0 and π".into()),
            );
            return None;
        }
        let [Id(a), Id(b)] = &angle.arm;
        let name = self.name_of(angle.id.as_ref(), format!("angle({a}-{b})"));
        self.add_driven(name, &angle.angle, (place, "angle"), make)
    }

    pub(super) fn add_gears(&mut self, gears: &Gears, place: &Node) -> Option<()> {
        let wheels = place.key("wheels");
        let [one, other] = [0, 1].map(|wheel| self.arm(&gears.wheels[wheel], wheels.item(wheel)));
        let wheels = [one?, other?];
        let [[Id(a), _], [Id(b), _]] = &gears.wheels;
        let name = self.name_of(gears.id.as_ref(), format!("gears({a}-{b})"));
        let make = |angle: qhat::Driven| qhat::Gears::mesh(wheels, gears.teeth, angle).into();
        self.in_plane(place, "gears mesh")?;
        self.add_driven(name, &gears.angle, (place, "angle"), make)
    }

    pub(super) fn add_rack(&mut self, rack: &Rack, place: &Node) -> Option<()> {
        let pinion = self.arm(&rack.pinion, place.key("pinion"));
        let particle = self.particle(&rack.particle, place.key("particle"));
        let (pinion, particle) = (pinion?, particle?);
        self.in_plane(place, "a rack moves")?;
        let [x, y, _] = rack.along.padded();
        if x == 0.0 && y == 0.0 {
            let message = "`along` needs a length";
            self.report.error(place.key("along").span.clone(), message, Some("as in `along = [1.0, 0.0]`".into()));
            return None;
        }
        let name = self.name_of(rack.id.as_ref(), format!("rack({})", rack.particle.0));
        self.add_driven(name, &rack.angle, (place, "angle"), |angle: qhat::Driven| {
            qhat::Gears::rack(pinion, particle, [x, y], rack.radius, angle).into()
        })
    }

    pub(super) fn add_rigid(&mut self, rigid: &Rigid, place: &Node) -> Option<()> {
        let place = place.key("particles");
        let particles = self.named(&rigid.particles, place)?;
        let points: Vec<[f64; 3]> = particles.iter().map(|id| self.start(*id)).collect();
        match rigid_rods(self.dimension_of_system(), &points) {
            Ok(rods) => {
                for ends in rods {
                    let [a, b] = ends.map(|end| &rigid.particles[end].0);
                    let name = self.free_constraint_name(format!("{a}-{b}"));
                    let [a, b] = ends.map(|end| particles[end]);
                    let rod = Distance::new(a, b, self.distance(a, b));
                    self.builder.constraint(name, rod);
                }
                Some(())
            }
            Err(reason) => {
                let message = format!("this cluster cannot be held: {reason}");
                self.report.error(place.span.clone(), message, None);
                None
            }
        }
    }

    pub(super) fn add_area(&mut self, area: &Area, place: &Node) -> Option<()> {
        let corners = self.named(&area.corners, place.key("corners"))?;
        self.in_plane(place, "a polygon keeps its area")?;
        let name = self.name_of(area.id.as_ref(), format!("area({})", area.corners[0].0));
        self.add_driven(name, &area.area, (place, "area"), |area: qhat::Driven| {
            qhat::Area { corners: corners.clone(), area }.into()
        })
    }

    pub(super) fn add_volume(&mut self, volume: &Volume, place: &Node) -> Option<()> {
        let mut faces = Vec::new();
        for (index, face) in volume.faces.iter().enumerate() {
            let face = self.named(face, place.key("faces").item(index))?;
            faces.extend(<[ParticleId; 3]>::try_from(face));
        }
        if self.dimension == 2 {
            let help = "use `kind = \"area\"` in two dimensions".to_owned();
            self.report.error(place.span.clone(), "a surface keeps its volume in three dimensions only", Some(help));
            return None;
        }
        let name = self.name_of(volume.id.as_ref(), format!("volume({})", volume.faces[0][0].0));
        self.add_driven(name, &volume.volume, (place, "volume"), |volume: qhat::Driven| {
            qhat::Volume::new(&faces, volume).into()
        })
    }

    fn in_plane(&mut self, place: &Node, what: &str) -> Option<()> {
        if self.dimension != 2 {
            self.report.error(place.span.clone(), format!("{what} in two dimensions only"), None);
            return None;
        }
        Some(())
    }

    /// Two different particles, in order.
    fn arm(&mut self, ids: &[Id; 2], place: &Node) -> Option<[ParticleId; 2]> {
        self.pair(ids, place).map(|(a, b)| [a, b])
    }

    /// All these particles.
    fn named(&mut self, ids: &[Id], place: &Node) -> Option<Vec<ParticleId>> {
        let found: Vec<_> = ids.iter().enumerate().map(|(i, id)| self.particle(id, place.item(i))).collect();
        found.into_iter().collect()
    }
}

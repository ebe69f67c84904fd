//! `[[constraints]]` and `[[springs]]`: what connects particles.

use super::Assembly;
use crate::model::{Constraint, Distance, DistanceForm, Driven, Id, Nail, NailForm, Name, Spring};
use crate::tree::Node;
use qhat::ParticleId;

impl Assembly<'_, '_, '_> {
    /// Takes the names that the file gives, before any that are made from ids.
    pub(super) fn take_constraint_names(&mut self, constraints: &[Constraint]) {
        for (index, constraint) in constraints.iter().enumerate() {
            if let Some(Name(name)) = constraint.id()
                && !self.constraint_names.insert(name.clone())
            {
                let span = self.tree.key("constraints").item(index).key("id").span.clone();
                let message = format!("the id {} is given to two constraints", self.report.quoted(name));
                self.report.error(span, message, Some("each constraint needs an id of its own".into()));
            }
        }
    }

    /// The name, with a number behind it where it is taken: two rods between the same particles are allowed.
    pub(super) fn free_constraint_name(&mut self, wanted: String) -> String {
        let mut name = wanted.clone();
        let mut number = 2;
        while !self.constraint_names.insert(name.clone()) {
            name = format!("{wanted}({number})");
            number += 1;
        }
        name
    }

    /// The name that the file gives, or else one made from what it is.
    pub(super) fn name_of(&mut self, given: Option<&Name>, wanted: String) -> String {
        match given {
            Some(Name(name)) => name.clone(),
            None => self.free_constraint_name(wanted),
        }
    }

    pub(super) fn add_constraints(&mut self, constraints: &[Constraint]) {
        for (index, constraint) in constraints.iter().enumerate() {
            let place = self.tree.key("constraints").item(index);
            match constraint {
                Constraint::Distance(distance) => self.add_distance(distance, place),
                Constraint::Nail(nail) => self.add_nail(nail, place),
                Constraint::Expression(expression) => self.add_expression_constraint(expression, place),
                Constraint::Pulley(pulley) => self.add_pulley(pulley, place),
                Constraint::LengthRatio(lengths) => self.add_length_ratio(lengths, place),
                Constraint::Angle(angle) => self.add_angle(angle, place),
                Constraint::Gears(gears) => self.add_gears(gears, place),
                Constraint::Rack(rack) => self.add_rack(rack, place),
                Constraint::Rigid(rigid) => self.add_rigid(rigid, place),
                Constraint::Area(area) => self.add_area(area, place),
                Constraint::Volume(volume) => self.add_volume(volume, place),
                Constraint::Coincidence(it) => self.add_coincidence(it, place),
                Constraint::Midpoint(it) => self.add_midpoint(it, place),
                Constraint::CenterOfMass(it) => self.add_center_of_mass(it, place),
                Constraint::Relation(it) => self.add_relation(it, place),
                Constraint::Direction(it) => self.add_direction(it, place),
                Constraint::Line(it) => self.add_line(it, place),
                Constraint::Plane(it) => self.add_plane(it, place),
                Constraint::Sphere(it) => self.add_sphere(it, place),
                Constraint::Circle(it) => self.add_circle(it, place),
                Constraint::Curve(it) => self.add_curve(it, place),
                Constraint::Rope(it) => self.add_rope(it, place),
                Constraint::Limits(it) => self.add_limits(it, place),
                Constraint::HalfSpace(it) => self.add_half_space(it, place),
                Constraint::Ball(it) => self.add_ball(it, place),
                Constraint::Box(it) => self.add_box(it, place),
            };
        }
    }

    fn add_distance(&mut self, distance: &Distance, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&distance.between, place)?;
        let length = match &distance.length {
            Some(driven) => match self.schedule(driven, place.key("length"))? {
                qhat::Driven::Constant(length) => length,
                radius => return self.add_driven_rod(distance, radius, (a, b), place),
            },
            None => self.measured_length("rod", &distance.between, (a, b), place)?,
        };
        let [Id(one), Id(other)] = &distance.between;
        let name = self.name_of(distance.id.as_ref(), format!("{one}-{other}"));
        let rod = qhat::Distance::new(a, b, length).with_compliance(distance.compliance, distance.damping);
        let Distance { form, breaks_at, .. } = *distance;
        if breaks_at.is_some() || matches!(distance.length, Some(Driven::Text(_))) {
            self.places.insert(name.clone(), place.span.clone());
        }
        self.builder.constraint(name, qhat::Distance { form: form.into(), breaks_at, ..rod });
        Some(())
    }

    /// The distance at the start [m], for a rod or rope whose length is left out.
    pub(super) fn measured_length(
        &mut self,
        what: &str,
        between: &[Id; 2],
        (a, b): (ParticleId, ParticleId),
        place: &Node,
    ) -> Option<f64> {
        let length = self.distance(a, b);
        let [one, other] = between.each_ref().map(|Id(id)| self.report.quoted(id));
        let complaint = if length == 0.0 {
            format!("a {what} needs a length, but {one} and {other} start at the same place")
        } else if !length.is_finite() {
            format!("{one} and {other} start too far apart to measure the length of a {what}")
        } else {
            return Some(length);
        };
        let help = "move one of them, or give `length` [m]".to_owned();
        self.report.error(place.key("between").span.clone(), complaint, Some(help));
        None
    }

    /// A rod whose length follows the time.
    fn add_driven_rod(
        &mut self,
        distance: &Distance,
        radius: qhat::Driven,
        (a, b): (ParticleId, ParticleId),
        place: &Node,
    ) -> Option<()> {
        if distance.compliance > 0.0 || distance.form != DistanceForm::Length {
            let message = "a rod whose length is an expression is rigid and held in the form `length`";
            let help = "leave out `form`, `compliance` and `damping`, or give `length` as a number".to_owned();
            self.report.error(place.key("length").span.clone(), message, Some(help));
            return None;
        }
        if distance.breaks_at.is_some() {
            let message = "a rod whose length is an expression does not break";
            let help = "leave out `breaks_at`, or give `length` as a number".to_owned();
            self.report.error(place.key("breaks_at").span.clone(), message, Some(help));
            return None;
        }
        let [Id(one), Id(other)] = &distance.between;
        let name = self.name_of(distance.id.as_ref(), format!("{one}-{other}"));
        self.builder.constraint(name, qhat::OnSphere::new(a, b, radius));
        Some(())
    }

    fn add_nail(&mut self, nail: &Nail, place: &Node) -> Option<()> {
        let particle = self.particle(&nail.particle, place.key("particle"))?;
        let start = self.start(particle);
        let point = self.schedules_or(nail.at.as_ref(), place.key("at"), start)?;
        let name = self.name_of(nail.id.as_ref(), format!("nail({})", nail.particle.0));
        if let [qhat::Driven::Constant(x), qhat::Driven::Constant(y), qhat::Driven::Constant(z)] = point {
            self.builder.constraint(name, qhat::Nail { particle, at: [x, y, z], form: nail.form.into() });
        } else if nail.form == NailForm::Vector {
            self.builder.constraint(name, qhat::Relation::driven(particle, point));
        } else {
            let message = "a nail whose point is an expression is held in the form `vector`";
            self.report.error(place.key("form").span.clone(), message, Some("leave out `form`".into()));
        }
        Some(())
    }

    pub(super) fn add_springs(&mut self, springs: &[Spring]) {
        for (index, spring) in springs.iter().enumerate() {
            let place = self.tree.key("springs").item(index);
            let Some((a, b)) = self.pair(&spring.between, place) else { continue };
            let Some(rest) = self.rest(spring.rest, (a, b), place) else { continue };
            let Spring { stiffness, damping, .. } = *spring;
            self.builder.force(qhat::Spring { a, b, stiffness, damping, rest });
        }
    }

    /// The rest length of a spring [m]: as given, else the distance at the start.
    pub(super) fn rest(&mut self, given: Option<f64>, ends: (ParticleId, ParticleId), place: &Node) -> Option<f64> {
        let rest = given.unwrap_or_else(|| self.distance(ends.0, ends.1));
        if !rest.is_finite() {
            let message = "its ends start too far apart to measure its rest length";
            self.report.error(place.key("between").span.clone(), message, Some("give `rest` [m]".into()));
            return None;
        }
        Some(rest)
    }

    /// Two different particles.
    pub(super) fn pair(&mut self, between: &[Id; 2], place: &Node) -> Option<(ParticleId, ParticleId)> {
        let place = place.key("between");
        let [one, other] = between;
        let (a, b) = (self.particle(one, place.item(0)), self.particle(other, place.item(1)));
        let pair = (a?, b?);
        if pair.0 == pair.1 {
            let message = format!("{} cannot be connected to itself", self.report.quoted(&one.0));
            self.report.error(place.span.clone(), message, Some("name two different particles".into()));
            return None;
        }
        Some(pair)
    }

    /// The particle with this id.
    pub(super) fn particle(&mut self, Id(id): &Id, place: &Node) -> Option<ParticleId> {
        let found = self.ids.find(id);
        if found.is_none() && !self.report.is_full() {
            let message = format!("there is no particle {}", self.report.quoted(id));
            self.report.error(place.span.clone(), message, Some(self.ids.help(id)));
        }
        found
    }
}

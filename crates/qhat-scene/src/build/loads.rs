//! `[[loads]]`: each entry as the engine's forces, one for each particle, pair, hinge or facet.

use super::Assembly;
use crate::model::load::{AirDrag, CentralGravity, Charges, Load, PairwiseGravity, Pressure, TorsionSpring};
use crate::model::{Id, Vector};
use crate::tree::Node;
use qhat::{CentralForce, CubicSpring, Facet, Gas, HarmonicForce, InverseSquare, ParticleId, PointForce};
use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

impl Assembly<'_, '_, '_> {
    pub(super) fn add_loads(&mut self, loads: &[Load]) {
        for (index, load) in loads.iter().enumerate() {
            let place = self.tree.key("loads").item(index);
            self.add_load(load, place);
        }
    }

    fn add_load(&mut self, load: &Load, place: &Node) -> Option<()> {
        match load {
            Load::Point(load) => {
                let particle = self.particle(&load.particle, place.key("particle"))?;
                self.builder.force(PointForce { particle, force: load.force.padded() });
            }
            Load::Harmonic(load) => {
                let particle = self.particle(&load.particle, place.key("particle"))?;
                let (amplitude, angular_frequency, phase) = (load.force.padded(), load.angular_frequency, load.phase);
                self.builder.force(HarmonicForce { particle, amplitude, angular_frequency, phase });
            }
            Load::Actuator(load) => {
                let (a, b) = self.pair(&load.between, place)?;
                let crate::model::load::Actuator { push, amplitude, angular_frequency, phase, .. } = *load;
                self.builder.force(qhat::Actuator { a, b, push, amplitude, angular_frequency, phase });
            }
            Load::CubicSpring(load) => {
                let (a, b) = self.pair(&load.between, place)?;
                let rest = self.rest(load.rest, (a, b), place)?;
                let (stiffness, cubic, damping) = (load.stiffness, load.cubic, load.damping);
                self.builder.force(CubicSpring { a, b, stiffness, cubic, damping, rest });
            }
            Load::TorsionSpring(load) => self.add_torsion_spring(load, place)?,
            Load::CentralGravity(load) => self.add_central_gravity(load, place)?,
            Load::PairwiseGravity(load) => self.add_pairwise_gravity(load, place)?,
            Load::Charges(load) => self.add_charges(load, place)?,
            Load::AirDrag(load) => self.add_air_drag(load, place)?,
            Load::Pressure(load) if self.dimension == 2 => self.add_outline(load, place)?,
            Load::Pressure(load) => self.add_mesh(load, place)?,
            Load::Force(load) => self.add_expression_force(load, place)?,
            Load::Potential(load) => self.add_expression_potential(load, place)?,
        }
        Some(())
    }

    fn add_torsion_spring(&mut self, load: &TorsionSpring, place: &Node) -> Option<()> {
        let [a, b, c] = self.different(&load.arms, place.key("arms"))?[..] else { return None };
        let angle = match load.angle {
            Some(angle) if self.dimension == 3 && angle < 0.0 => {
                let message = "there is no negative angle in three dimensions";
                let help = "give the angle between the two arms, 0 to π".to_owned();
                self.report.error(place.key("angle").span.clone(), message, Some(help));
                return None;
            }
            Some(angle) => angle,
            None => self.angle(a, b, c).or_else(|| {
                let message = "an arm of this hinge has no length at the start, and so no angle";
                let help = "move its particles apart, or give `angle` [rad]".to_owned();
                self.report.error(place.key("arms").span.clone(), message, Some(help));
                None
            })?,
        };
        let (stiffness, damping) = (load.stiffness, load.damping);
        self.builder.force(qhat::TorsionSpring { a, b, c, stiffness, damping, angle });
        Some(())
    }

    /// The angle at the start from the arm b–a to the arm b–c [rad].
    fn angle(&self, a: ParticleId, b: ParticleId, c: ParticleId) -> Option<f64> {
        let d = self.dimension;
        let arm = |end: ParticleId| -> [f64; 3] {
            let of = |k: usize| self.positions[end.index() * d + k] - self.positions[b.index() * d + k];
            std::array::from_fn(|k| if k < d { of(k) } else { 0.0 })
        };
        let dot = |u: [f64; 3], w: [f64; 3]| u[0] * w[0] + u[1] * w[1] + u[2] * w[2];
        let (u, w) = (arm(a), arm(c));
        let normal = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
        let across = if d == 2 { normal[2] } else { dot(normal, normal).sqrt() };
        let measurable = dot(u, u) > 0.0 && dot(w, w) > 0.0 && dot(u, w).is_finite() && across.is_finite();
        // Rounding may leave an angle an ulp beyond π.
        measurable.then(|| libm::atan2(across, dot(u, w)).clamp(-PI, PI))
    }

    fn add_central_gravity(&mut self, load: &CentralGravity, place: &Node) -> Option<()> {
        for particle in self.those_or_all(load.particles.as_deref(), place)? {
            let (center, mass) = (load.center.padded(), self.inertias[particle.index()].mass);
            self.builder.force(CentralForce::gravity(particle, mass, center, load.mu, load.softening));
        }
        Some(())
    }

    fn add_pairwise_gravity(&mut self, load: &PairwiseGravity, place: &Node) -> Option<()> {
        let particles = self.different(&load.particles, place.key("particles"))?;
        for (i, &b) in particles.iter().enumerate() {
            for &a in &particles[..i] {
                let pair = [a, b].map(|id| self.inertias[id.index()].mass);
                self.builder.force(InverseSquare::gravity([a, b], pair, load.constant, load.softening));
            }
        }
        Some(())
    }

    fn add_charges(&mut self, load: &Charges, place: &Node) -> Option<()> {
        let particles = self.different(&load.particles, place.key("particles"))?;
        if load.charges.len() != particles.len() {
            let message = format!("there are {} charges for {} particles", load.charges.len(), particles.len());
            let help = "give one charge for each particle".to_owned();
            self.report.error(place.key("charges").span.clone(), message, Some(help));
            return None;
        }
        for (i, (&b, &other)) in particles.iter().zip(&load.charges).enumerate() {
            for (&a, &one) in particles.iter().zip(&load.charges).take(i) {
                self.builder.force(InverseSquare::charges([a, b], [one, other], load.constant, load.softening));
            }
        }
        Some(())
    }

    fn add_air_drag(&mut self, load: &AirDrag, place: &Node) -> Option<()> {
        let rows = load.gradient.as_deref().unwrap_or_default();
        if load.gradient.is_some() && rows.len() != self.dimension {
            let message = format!("the gradient of the wind has {} vectors, not {}", rows.len(), self.dimension);
            let help = "give one for each component of the wind".to_owned();
            self.report.error(place.key("gradient").span.clone(), message, Some(help));
            return None;
        }
        let gradient = std::array::from_fn(|k| rows.get(k).map_or([0.0; 3], Vector::padded));
        let wind = load.wind.as_ref().map_or([0.0; 3], Vector::padded);
        for particle in self.those_or_all(load.particles.as_deref(), place)? {
            let still = qhat::AirDrag::still(particle, load.linear, load.quadratic);
            self.builder.force(qhat::AirDrag { wind, gradient, ..still });
        }
        Some(())
    }

    fn add_outline(&mut self, load: &Pressure, place: &Node) -> Option<()> {
        if load.outline.len() < 3 || !load.triangles.is_empty() {
            let message = "a pressure in two dimensions needs an `outline` of 3 particles or more, and no `triangles`";
            let help = "name the particles of the loop in their order".to_owned();
            self.report.error(place.span.clone(), message, Some(help));
            return None;
        }
        let mut outline = self.different(&load.outline, place.key("outline"))?;
        let x = |id: ParticleId| [self.positions[id.index() * 2], self.positions[id.index() * 2 + 1]];
        let ends = outline.iter().zip(outline.iter().cycle().skip(1));
        let twice_area: f64 = ends.map(|(&a, &b)| x(a)[0] * x(b)[1] - x(a)[1] * x(b)[0]).sum();
        if twice_area < 0.0 {
            outline.reverse();
        }
        let ends = outline.iter().zip(outline.iter().cycle().skip(1));
        self.add_pressure(load, ends.map(|(&a, &b)| Facet::Edge([a, b])).collect(), place)
    }

    fn add_mesh(&mut self, load: &Pressure, place: &Node) -> Option<()> {
        if load.triangles.is_empty() || !load.outline.is_empty() {
            let message = "a pressure in three dimensions needs `triangles`, and no `outline`";
            let help = "name the three corners of every triangle of the mesh".to_owned();
            self.report.error(place.span.clone(), message, Some(help));
            return None;
        }
        let mut facets = Vec::new();
        let mut sides = HashMap::new();
        for (index, triangle) in load.triangles.iter().enumerate() {
            let [a, b, c] = self.different(triangle, place.key("triangles").item(index))?[..] else { return None };
            for side in [(a, b), (b, c), (c, a)] {
                *sides.entry(side).or_insert(0) += 1;
            }
            facets.push(Facet::Triangle([a, b, c]));
        }
        let closes = sides.iter().all(|(&(a, b), count)| *count == 1 && sides.get(&(b, a)) == Some(&1));
        if !closes {
            let message = "there is no closed mesh of these triangles";
            let help = "every side must belong to two triangles that pass it in opposite directions".to_owned();
            self.report.error(place.key("triangles").span.clone(), message, Some(help));
            return None;
        }
        self.add_pressure(load, facets, place)
    }

    fn add_pressure(&mut self, load: &Pressure, facets: Vec<Facet>, place: &Node) -> Option<()> {
        let Some(exponent) = load.exponent else {
            for facet in facets {
                self.builder.force(qhat::Pressure { facet, pressure: load.pressure });
            }
            return Some(());
        };
        let gas = Gas::new(facets, load.pressure, exponent, self.dimension_of_system(), &self.positions);
        if let Err(reason) = gas.check() {
            let help = "leave out `exponent` for a pressure that stays".to_owned();
            self.report.error(place.span.clone(), reason.to_string(), Some(help));
            return None;
        }
        self.builder.force(gas);
        Some(())
    }

    /// The particles with these ids, each another one.
    fn different(&mut self, ids: &[Id], place: &Node) -> Option<Vec<ParticleId>> {
        let found: Vec<_> = ids.iter().enumerate().map(|(k, id)| self.particle(id, place.item(k))).collect();
        let found = found.into_iter().collect::<Option<Vec<ParticleId>>>()?;
        let mut seen = HashSet::new();
        if let Some(k) = found.iter().position(|id| !seen.insert(*id)) {
            let message = format!("{} is named twice", self.report.quoted(&ids[k].0));
            self.report.error(place.item(k).span.clone(), message, Some("name different particles".into()));
            return None;
        }
        Some(found)
    }

    /// The particles with these ids, or all that can move.
    pub(super) fn those_or_all(&mut self, ids: Option<&[Id]>, place: &Node) -> Option<Vec<ParticleId>> {
        match ids {
            Some(ids) => self.different(ids, place.key("particles")),
            None => {
                let free = (0..self.inertias.len()).filter(|&i| !self.inertias[i].fixed);
                free.map(|i| self.builder.particle_at(i)).collect()
            }
        }
    }
}

/// What loads ask of a particle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inertia {
    pub(super) mass: f64,
    pub(super) fixed: bool,
}

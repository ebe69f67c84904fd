//! `kind = "pressure"` of `[[loads]]`: a constant pressure or a gas inside a closed outline or mesh.

use super::Assembly;
use crate::model::pressure::Pressure;
use crate::tree::Node;
use qhat::{Facet, Gas, ParticleId};
use std::collections::HashMap;

impl Assembly<'_, '_, '_> {
    pub(super) fn add_pressure(&mut self, it: &Pressure, place: &Node) -> Option<()> {
        let facets = if self.dimension == 2 { self.outline(it, place)? } else { self.mesh(it, place)? };
        let Some(exponent) = it.exponent else {
            for facet in facets {
                self.builder.force(qhat::Pressure { facet, pressure: it.pressure });
            }
            return Some(());
        };
        let gas = Gas::new(facets, it.pressure, exponent, self.dimension_of_system(), self.start_positions());
        if let Err(reason) = gas.check() {
            let help = "leave out `exponent` for a constant pressure".to_owned();
            self.report.error(place.span.clone(), reason.to_string(), Some(help));
            return None;
        }
        self.builder.force(gas);
        Some(())
    }

    /// The edges of a loop in the plane, counterclockwise.
    fn outline(&mut self, it: &Pressure, place: &Node) -> Option<Vec<Facet>> {
        if it.outline.len() < 3 || !it.triangles.is_empty() {
            let message = "a pressure in two dimensions needs an `outline` of 3 particles or more, and no `triangles`";
            let help = "name the particles of the loop in their order".to_owned();
            self.report.error(place.span.clone(), message, Some(help));
            return None;
        }
        let mut outline = self.different(&it.outline, place.key("outline"))?;
        let q = self.start_positions();
        let x = |id: ParticleId| [q[id.index() * 2], q[id.index() * 2 + 1]];
        let ends = outline.iter().zip(outline.iter().cycle().skip(1));
        let twice_area: f64 = ends.map(|(&a, &b)| x(a)[0] * x(b)[1] - x(a)[1] * x(b)[0]).sum();
        if twice_area < 0.0 {
            outline.reverse();
        }
        let ends = outline.iter().zip(outline.iter().cycle().skip(1));
        Some(ends.map(|(&a, &b)| Facet::Edge([a, b])).collect())
    }

    /// The triangles of a closed mesh in space.
    fn mesh(&mut self, it: &Pressure, place: &Node) -> Option<Vec<Facet>> {
        if it.triangles.is_empty() || !it.outline.is_empty() {
            let message = "a pressure in three dimensions needs `triangles`, and no `outline`";
            let help = "name the three corners of every triangle of the mesh".to_owned();
            self.report.error(place.span.clone(), message, Some(help));
            return None;
        }
        let mut facets = Vec::new();
        let mut sides = HashMap::new();
        for (index, triangle) in it.triangles.iter().enumerate() {
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
        Some(facets)
    }
}

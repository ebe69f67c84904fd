//! `[[constraints]]` that hold an enclosed area or volume.

use super::Assembly;
use crate::model::enclosed::{Area, Volume};
use crate::tree::Node;
use qhat::ParticleId;

impl Assembly<'_, '_, '_> {
    pub(super) fn add_area(&mut self, it: &Area, place: &Node) -> Option<()> {
        let corners = self.particles(&it.corners, place.key("corners"))?;
        self.in_plane(place, "a polygon keeps its area")?;
        let make = |area: qhat::Driven| qhat::Area { corners: corners.clone(), area }.into();
        self.add_driven(it, it.area.as_ref(), (place, "area"), make)
    }

    pub(super) fn add_volume(&mut self, it: &Volume, place: &Node) -> Option<()> {
        let mut faces = Vec::new();
        for (index, face) in it.faces.iter().enumerate() {
            let face = self.particles(face, place.key("faces").item(index))?;
            faces.extend(<[ParticleId; 3]>::try_from(face));
        }
        if self.dimension == 2 {
            let help = "use `kind = \"area\"` in two dimensions".to_owned();
            self.report.error(place.span.clone(), "a surface keeps its volume in three dimensions only", Some(help));
            return None;
        }
        let make = |volume: qhat::Driven| qhat::Volume::new(&faces, volume).into();
        self.add_driven(it, it.volume.as_ref(), (place, "volume"), make)
    }
}

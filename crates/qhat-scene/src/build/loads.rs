//! `[[loads]]`: the call of the function that adds each kind, and loads on one particle or on a pair. Each entry
//! becomes forces of the engine, one for each particle, pair, hinge or facet.

use super::Assembly;
use crate::model::Load;
use crate::model::load::load_kinds;
use crate::model::point::{Actuator, Harmonic, Point};
use crate::tree::Node;
use qhat::{HarmonicForce, PointForce};

macro_rules! add_load {
    ($($kind:ident => $add:ident,)*) => {
        fn add_load(&mut self, load: &Load, place: &Node) -> Option<()> {
            match load {
                $(Load::$kind(it) => self.$add(it, place),)*
            }
        }
    };
}

impl Assembly<'_, '_, '_> {
    load_kinds!(add_load);

    pub(super) fn add_loads(&mut self, loads: &[Load]) {
        for (index, load) in loads.iter().enumerate() {
            let place = self.tree.key("loads").item(index);
            let before = self.builder.force_count();
            self.add_load(load, place);
            self.made.loads.push(before..self.builder.force_count());
        }
    }

    fn add_point(&mut self, it: &Point, place: &Node) -> Option<()> {
        let particle = self.particle(&it.particle, place.key("particle"))?;
        self.builder.force(PointForce { particle, force: it.force.padded() });
        Some(())
    }

    fn add_harmonic(&mut self, it: &Harmonic, place: &Node) -> Option<()> {
        let particle = self.particle(&it.particle, place.key("particle"))?;
        let (amplitude, angular_frequency, phase) = (it.force.padded(), it.angular_frequency, it.phase);
        self.builder.force(HarmonicForce { particle, amplitude, angular_frequency, phase });
        Some(())
    }

    fn add_actuator(&mut self, it: &Actuator, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&it.between, place.key("between"))?;
        let Actuator { push, amplitude, angular_frequency, phase, .. } = *it;
        self.builder.force(qhat::Actuator { a, b, push, amplitude, angular_frequency, phase });
        Some(())
    }
}

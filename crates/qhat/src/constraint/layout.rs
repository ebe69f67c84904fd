//! Layout: the particles that each row depends on.

use super::{Constraint, Holds};
use crate::space::ParticleId;

/// The particles that each row depends on. The blocks of row i are `start[i]..start[i + 1]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Layout {
    pub(crate) start: Vec<usize>,
    pub(crate) particle: Vec<ParticleId>,
}

impl Layout {
    pub(crate) fn new<'a>(constraints: impl Iterator<Item = &'a Constraint>, dimension: usize) -> Self {
        let mut layout = Layout { start: vec![0], particle: Vec::new() };
        for constraint in constraints {
            for _ in 0..constraint.row_count(dimension) {
                layout.particle.extend(constraint.particles());
                layout.start.push(layout.particle.len());
            }
        }
        layout
    }

    pub(crate) fn row_count(&self) -> usize {
        self.start.len() - 1
    }
}

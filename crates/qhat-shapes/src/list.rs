//! The list of all shapes of a system.

use crate::shape::{Shape, Source};
use crate::{constraint, force};
use qhat::{State, System};

/// The shapes of a system at the time of its state: first the shapes of the constraints in their order, then the shapes
/// of the forces.
///
/// Count, order, kinds and particles depend on the system alone. From frame to frame only points and sizes of driven
/// shapes change; [`driven_shapes`] gives the driven shapes at any time. Some constraints and forces (an expression,
/// gravity) have no shape.
pub fn shapes(system: &System, state: &State) -> Vec<Shape> {
    shapes_at(system, state, state.time())
}

/// The driven shapes of a system at t \[s\], in the same order as in [`shapes`].
///
/// Front ends that draw between two states need the shapes at a time between those of the states.
pub fn driven_shapes(system: &System, state: &State, t: f64) -> Vec<Shape> {
    shapes_at(system, state, t).into_iter().filter(|shape| shape.driven).collect()
}

pub(crate) fn shapes_at(system: &System, state: &State, t: f64) -> Vec<Shape> {
    let mut shapes = Shapes::new(system, state, t);
    for (i, named) in system.constraints().iter().enumerate() {
        shapes.of = Source::Constraint(i);
        constraint::add(&named.constraint, &mut shapes);
    }
    force::add(system.forces(), &mut shapes);
    shapes.all
}

/// The shapes found so far, with the system and the state.
pub(crate) struct Shapes<'a> {
    pub(crate) system: &'a System,
    pub(crate) state: &'a State,
    /// t \[s\].
    pub(crate) t: f64,
    /// The constraint or force whose shapes are being added.
    pub(crate) of: Source,
    all: Vec<Shape>,
    /// Indices into `all` of surfaces and wires.
    shared: Vec<usize>,
    links: usize,
}

impl<'a> Shapes<'a> {
    fn new(system: &'a System, state: &'a State, t: f64) -> Self {
        let of = Source::Constraint(0);
        Shapes { system, state, t, of, all: Vec::new(), shared: Vec::new(), links: 0 }
    }

    pub(crate) fn push(&mut self, shape: Shape) {
        self.all.push(shape);
    }

    /// Adds the shape of the system's next link.
    pub(crate) fn push_link(&mut self, shape: Shape) {
        self.all.push(shape.link(self.links));
        self.links += 1;
    }

    /// Adds a surface or wire unless the list has it already: a surface that many particles share is drawn once.
    pub(crate) fn push_shared(&mut self, shape: Shape) {
        let is_same = |&place: &usize| {
            let other = &self.all[place];
            (other.kind, &other.points, other.size) == (shape.kind, &shape.points, shape.size)
        };
        if !self.shared.iter().any(is_same) {
            self.shared.push(self.all.len());
            self.all.push(shape);
        }
    }
}

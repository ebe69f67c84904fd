//! Shape: one thing to draw, and the kinds of shapes.

use qhat::{Anchor, Driven, DrivenPoint, ParticleId};

/// The constraint or force that a shape belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The index of the constraint in [`qhat::System::constraints`].
    Constraint(usize),
    /// The index of the force in [`qhat::System::forces`].
    Force(usize),
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident = $name:literal,)*) => {
        /// The kind of a shape. In brackets: its particles, then its points \[m\], then its size \[m\].
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum ShapeKind { $($(#[$doc])* $kind,)* }

        impl ShapeKind {
            /// Every kind, for front ends that check that they draw all of them.
            pub const ALL: &[ShapeKind] = &[$(ShapeKind::$kind,)*];

            /// The word for the kind in JavaScript and in SVG.
            pub fn name(self) -> &'static str {
                match self { $(ShapeKind::$kind => $name,)* }
            }
        }
    };
}

kinds! {
    /// A link of one length \[a, b; ; length\].
    Rod = "rod",
    /// A link that is taut at its length and slack at less \[a, b; ; length\].
    Rope = "rope",
    /// A link that pushes at its shortest length and is loose at more, up to its longest length if it has one
    /// \[a, b; ; shortest length\].
    Strut = "strut",
    /// A rod whose length or other end is driven \[a, b; ; length\] or \[a; b; length\].
    DrivenRod = "driven-rod",
    /// A piece of a rope over pulleys \[a, b; ; \].
    Cord = "cord",
    /// Two particles that a constraint couples without a solid part between them \[a, b; ; \].
    Tie = "tie",
    /// A spring, linear or not \[a, b; ; rest length\].
    Spring = "spring",
    /// A push and pull along the line of two particles \[a, b; ; \].
    Actuator = "actuator",
    /// A nail that holds a particle to a point \[particle; point; \].
    Nail = "nail",
    /// A curve in the scene \[; its points in order; \].
    Wire = "wire",
    /// An endless straight line \[a, b; ; \], \[a; direction; \] or \[; point, direction; \].
    Line = "line",
    /// A circle across an axis \[centre; axis; radius\] or \[; centre, axis; radius\].
    Ring = "ring",
    /// A ball; particles stay outside \[; centre; radius\].
    Ball = "ball",
    /// A sphere; particles stay inside or on it \[; centre; radius\].
    Bowl = "bowl",
    /// Ground; particles stay above it \[; point, unit normal; \].
    Ground = "ground",
    /// A box; particles stay outside \[; centre, half its size; \].
    Box = "box",
    /// An angle from the arm a-b to the arm c-d \[a, b, c, d; ; \], or from a direction to the arm c-d
    /// \[c, d; direction; \].
    Angle = "angle",
    /// The pitch circle of a wheel \[centre, a point of it; ; radius\].
    Wheel = "wheel",
    /// A filled polygon \[its corners in order; ; \].
    Area = "area",
    /// An endless plane \[; point, normal; \].
    Plane = "plane",
}

/// One thing to draw: its kind, the particles that it is attached to, and points of the scene. [`ShapeKind`] lists the
/// particles, points and size of each kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The kind.
    pub kind: ShapeKind,
    /// The constraint or force that the shape belongs to. If several constraints share a surface or wire, the first.
    pub of: Source,
    /// The particles; their positions are in the state.
    pub particles: Vec<ParticleId>,
    /// Points and directions of the scene \[m\]; z = 0 in two dimensions.
    pub points: Vec<[f64; 3]>,
    /// A length \[m\]; 0 for a kind without a size.
    pub size: f64,
    /// Whether points and size change with t. They are constant for every other shape.
    pub driven: bool,
    /// For a rod, rope or strut, its index in [`qhat::System::links`], in `tension` and among the broken links.
    pub link: Option<usize>,
}

impl Shape {
    pub(crate) fn new(kind: ShapeKind, of: Source, particles: impl Into<Vec<ParticleId>>) -> Self {
        Shape { kind, of, particles: particles.into(), points: Vec::new(), size: 0.0, driven: false, link: None }
    }

    pub(crate) fn at(self, points: impl Into<Vec<[f64; 3]>>) -> Self {
        Shape { points: points.into(), ..self }
    }

    pub(crate) fn sized(self, size: f64) -> Self {
        Shape { size, ..self }
    }

    pub(crate) fn link(self, place: usize) -> Self {
        Shape { link: Some(place), ..self }
    }

    /// Marks the shape as driven if one of these numbers is driven.
    pub(crate) fn following<'a>(self, numbers: impl IntoIterator<Item = &'a Driven>) -> Self {
        let driven = numbers.into_iter().any(|number| matches!(number, Driven::Function(_)));
        Shape { driven: self.driven || driven, ..self }
    }

    /// Inserts the centre of the shape as its first particle, or as its first point at t \[s\].
    pub(crate) fn around(mut self, center: &Anchor, t: f64) -> Self {
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

/// A driven point at t \[s\], in metres.
pub(crate) fn value(point: &DrivenPoint, t: f64) -> [f64; 3] {
    [0, 1, 2].map(|k: usize| point[k].value(t))
}

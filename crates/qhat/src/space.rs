//! The ground floor: how many dimensions there are, and the number of a particle.

/// Number of space dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// The plane.
    Two,
    /// Space.
    Three,
}

impl Dimension {
    /// d as a number, 2 or 3.
    pub fn number(self) -> usize {
        match self {
            Dimension::Two => 2,
            Dimension::Three => 3,
        }
    }
}

/// Runs a generic body with `$D` bound to the number of dimensions. It is the only place at which d becomes a constant.
macro_rules! in_dimension {
    ($dimension:expr, $D:ident => $body:expr) => {
        match $dimension {
            $crate::space::Dimension::Two => {
                const $D: usize = 2;
                $body
            }
            $crate::space::Dimension::Three => {
                const $D: usize = 3;
                $body
            }
        }
    };
}
pub(crate) use in_dimension;

/// The number of a particle: its place in the order they were added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ParticleId(pub usize);

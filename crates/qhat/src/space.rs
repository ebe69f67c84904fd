//! The ground floor: the number of dimensions, and the ids of particles, constraints and forces.

use std::collections::HashSet;

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

macro_rules! ids {
    ($($(#[$doc:meta])* $id:ident,)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        pub struct $id(pub(crate) usize);

        impl $id {
            /// The place in the order of addition, from 0: the index into the arrays of a [`System`](crate::System).
            pub fn index(self) -> usize {
                self.0
            }
        }
    )*};
}

ids! {
    /// The id of a particle, from [`SystemBuilder::particle`](crate::SystemBuilder::particle) or
    /// [`System::particle`](crate::System::particle).
    ParticleId,
    /// The id of a constraint, from [`SystemBuilder::constraint`](crate::SystemBuilder::constraint) or
    /// [`System::constraint`](crate::System::constraint).
    ConstraintId,
    /// The id of a force, from [`SystemBuilder::force`](crate::SystemBuilder::force) or
    /// [`System::force`](crate::System::force).
    ForceId,
}

/// The place of the first id that came before in the list, for lists of any length; `None` if all differ.
pub(crate) fn first_repeated(ids: impl IntoIterator<Item = ParticleId>) -> Option<usize> {
    let mut seen = HashSet::new();
    ids.into_iter().position(|id| !seen.insert(id))
}

//! Points and vectors of D components, and the motion of all particles.

pub(crate) use crate::number::{dot, larger, minus, norm, scaled};

use crate::space::ParticleId;

/// A point or vector of two or three components, as functions take it: from `[x, y]`, where z is 0, or `[x, y, z]`.
///
/// ```
/// use qhat::Vector;
/// assert_eq!(Vector::from([1.0, 2.0]), Vector::from([1.0, 2.0, 0.0]));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector(pub(crate) [f64; 3]);

impl From<[f64; 2]> for Vector {
    fn from([x, y]: [f64; 2]) -> Self {
        Vector([x, y, 0.0])
    }
}

impl From<[f64; 3]> for Vector {
    fn from(components: [f64; 3]) -> Self {
        Vector(components)
    }
}

impl From<Vector> for [f64; 3] {
    fn from(vector: Vector) -> Self {
        vector.0
    }
}

/// Conversions from and to the vectors of other crates.
#[cfg(feature = "mint")]
mod with_mint {
    use super::Vector;

    macro_rules! through_mint {
        ($($kind:ident: $size:literal,)*) => {$(
            impl From<mint::$kind<f64>> for Vector {
                fn from(vector: mint::$kind<f64>) -> Self {
                    Vector::from(<[f64; $size]>::from(vector))
                }
            }
        )*};
    }

    through_mint! { Vector2: 2, Point2: 2, Vector3: 3, Point3: 3, }
}

/// A point or vector in D dimensions.
pub(crate) type Point<const D: usize> = [f64; D];

/// The first axis: the direction that is taken where no direction exists.
pub(crate) fn first_axis<const D: usize>() -> Point<D> {
    std::array::from_fn(|k| if k == 0 { 1.0 } else { 0.0 })
}

/// The first D of three stored components (the third is 0 in two dimensions).
#[inline(always)]
pub(crate) fn first<const D: usize>(a: &[f64; 3]) -> Point<D> {
    std::array::from_fn(|k| a[k])
}

/// The positions q and velocities q̇ of all particles, flat, d·n each, at the time t.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'a, const D: usize> {
    pub(crate) q: &'a [f64],
    pub(crate) qd: &'a [f64],
    /// t [s], for constraints and forces that depend on time.
    pub(crate) t: f64,
}

impl<const D: usize> Motion<'_, D> {
    /// x of one particle.
    #[inline(always)]
    pub(crate) fn x(&self, particle: ParticleId) -> Point<D> {
        block(self.q, particle)
    }

    /// v of one particle.
    #[inline(always)]
    pub(crate) fn v(&self, particle: ParticleId) -> Point<D> {
        block(self.qd, particle)
    }
}

/// The D components that belong to one particle in a flat array.
#[inline(always)]
pub(crate) fn block<const D: usize>(flat: &[f64], particle: ParticleId) -> Point<D> {
    let start = particle.0 * D;
    std::array::from_fn(|k| flat[start + k])
}

/// flat[particle] += a.
#[inline(always)]
pub(crate) fn add<const D: usize>(flat: &mut [f64], particle: ParticleId, a: Point<D>) {
    for (target, component) in flat[particle.0 * D..][..D].iter_mut().zip(a) {
        *target += component;
    }
}

/// max |x|; not a number if an entry is not.
pub(crate) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| larger(most, x.abs()))
}

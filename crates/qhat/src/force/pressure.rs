//! Pressure: pressure inside a closed loop of edges in the plane or a closed mesh of triangles in space; one force for
//! each facet.
//!
//! ```text
//! edge ab:       A = ½ (x_a y_b − y_a x_b)           V = −p A        F_a = ½ p (y_b, −x_b),   F_b = ½ p (−y_a, x_a)
//! triangle abc:  U = ⅙ x_a · (x_b × x_c)             V = −p U        F_a = ⅙ p x_b × x_c, and so on in turn
//! −∂F_a/∂x_b:    −½ p [0 1; −1 0]                    ⅙ p [x_c]×
//! ```
//!
//! A and U are the signed area and volume between a facet and the origin. By Gauss's theorem their sum over all facets
//! is the area or volume inside, if the edges go round counter-clockwise, or the triangles counter-clockwise as seen
//! from outside. Only then does the sum not depend on the origin. At a corner of a loop the force is ½ p times the
//! chord of its two neighbours, turned outward. p is in N/m in the plane (a pressure times a depth) and in Pa in space.
//! An edge in space acts in the x–y plane. The force of a triangle in the plane is zero.

use super::{Acts, Dependence, ForceError};
use crate::allowed::finite;
use crate::linalg::block::Block;
use crate::number::{cross, raised};
use crate::point::{Motion, Point, add, minus, norm};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// One edge of a closed loop or one triangle of a closed mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Facet {
    /// The edge from a to b of a loop that goes round counter-clockwise.
    Edge([ParticleId; 2]),
    /// The triangle a, b, c, counter-clockwise as seen from outside.
    Triangle([ParticleId; 3]),
}

/// Pressure on one edge of a closed loop or one triangle of a closed mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressure {
    /// The facet under pressure.
    pub facet: Facet,
    /// p [N/m on an edge, Pa on a triangle], positive if it pushes outward.
    pub pressure: f64,
}

impl Pressure {
    /// The pressure in a loop of particles that goes round counter-clockwise: one force for each edge.
    pub fn in_loop(outline: &[ParticleId], pressure: f64) -> impl Iterator<Item = Pressure> + '_ {
        let ends = outline.iter().zip(outline.iter().cycle().skip(1));
        ends.map(move |(&a, &b)| Pressure { facet: Facet::Edge([a, b]), pressure })
    }
}

impl Facet {
    /// The particles at the corners.
    pub fn corners(&self) -> &[ParticleId] {
        match self {
            Facet::Edge(corners) => corners,
            Facet::Triangle(corners) => corners,
        }
    }

    /// A or U.
    pub(super) fn enclosed<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        match *self {
            Facet::Edge([a, b]) => 0.5 * cross(place(motion, a), place(motion, b))[2],
            Facet::Triangle([a, b, c]) => {
                let [u, v, w] = cross(place(motion, b), place(motion, c));
                let [x, y, z] = place(motion, a);
                (x * u + y * v + z * w) / 6.0
            }
        }
    }

    /// Calls `visit(particle, share, v)` for each corner in order, where share times v is ∂A/∂x or ∂U/∂x.
    pub(super) fn gradient<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(ParticleId, f64, Point<3>),
    ) {
        match *self {
            Facet::Edge([a, b]) => {
                let (x_a, x_b) = (place(motion, a), place(motion, b));
                visit(a, 0.5, [x_b[1], -x_b[0], 0.0]);
                visit(b, 0.5, [-x_a[1], x_a[0], 0.0]);
            }
            Facet::Triangle([a, b, c]) => {
                for (a, b, c) in [(a, b, c), (b, c, a), (c, a, b)] {
                    visit(a, 1.0 / 6.0, cross(place(motion, b), place(motion, c)));
                }
            }
        }
    }

    /// The bound of p times the second derivatives on the force of each corner.
    pub(super) fn bound<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        pressure: f64,
        bound: &mut impl FnMut(ParticleId, f64, f64),
    ) {
        // In a closed mesh the two triangles at an edge add up to the block ⅙ p [x_c − x_d]×. The bound therefore uses
        // distances between corners and not from the origin. Each triangle bounds its part of the two edges at a
        // corner.
        match *self {
            Facet::Edge(ends) => ends.into_iter().for_each(|id| bound(id, 0.5 * pressure.abs(), 0.0)),
            Facet::Triangle([a, b, c]) => {
                for (a, b, c) in [(a, b, c), (b, c, a), (c, a, b)] {
                    let reach = |id| norm(minus(motion.x(id), motion.x(a)));
                    bound(a, pressure.abs() / 6.0 * (reach(b) + reach(c)), 0.0);
                }
            }
        }
    }

    /// Calls `visit` with −p times the second derivatives.
    pub(super) fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        pressure: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    ) {
        match *self {
            Facet::Edge([a, b]) => {
                let s = 0.5 * pressure;
                visit(a, b, Stiffness::Indefinite(within([[0.0, -s, 0.0], [s, 0.0, 0.0], [0.0; 3]])));
            }
            Facet::Triangle([a, b, c]) => {
                for (a, b, c) in [(a, b, c), (b, c, a), (c, a, b)] {
                    let [x, y, z] = place(motion, c).map(|component| pressure / 6.0 * component);
                    visit(a, b, Stiffness::Indefinite(within([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])));
                }
            }
        }
    }

    /// `Ok` if its corners are different particles.
    pub(super) fn check(&self) -> Result<(), ForceError> {
        let corners = self.corners();
        let repeats = corners.iter().enumerate().any(|(i, id)| corners[..i].contains(id));
        if repeats { Err(ForceError::FacetCorners) } else { Ok(()) }
    }
}

/// x of one particle, z = 0 in two dimensions.
fn place<const D: usize>(motion: Motion<'_, D>, particle: ParticleId) -> Point<3> {
    raised(motion.x(particle))
}

/// The first D rows and columns.
fn within<const D: usize>(full: Block<3>) -> Block<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| full[i][j]))
}

impl Acts for Pressure {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        self.facet.gradient(motion, &mut |particle, share, v| {
            add::<D>(Q, particle, std::array::from_fn(|k| share * self.pressure * v[k]));
        });
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        -self.pressure * self.facet.enclosed(motion)
    }

    fn power<const D: usize>(&self, _: Motion<'_, D>) -> f64 {
        0.0
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        self.facet.bound(motion, self.pressure, bound);
    }

    fn dependence(&self) -> Dependence {
        Dependence::Motion
    }

    fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        _: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    ) {
        self.facet.tangent(motion, self.pressure, visit);
    }

    fn particles(&self) -> Vec<ParticleId> {
        self.facet.corners().to_vec()
    }

    fn check(&self) -> Result<(), ForceError> {
        finite("a pressure", self.pressure)?;
        self.facet.check()
    }
}

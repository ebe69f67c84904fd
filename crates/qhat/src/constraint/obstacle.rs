//! Obstacle: one particle stays on one side of a surface: the ground, a wall, a ball, a box.
//!
//! ```text
//! φ(x): signed distance to the surface [m], positive where the particle may be;   n = ∇φ,   H = ∂²φ/∂x²
//! normal      C = φ ≥ 0    J = nᵀ    Ċ = n·v     γ = vᵀH v     λ ≥ 0 [N]
//! tangents    C = 0        J = tᵀ    Ċ = t·v     γ = 0         t ⊥ n, one in the plane, two in space
//!
//! half-space  φ = n·x − p                  H = 0
//! ball        φ = ±(|x − c| − r)           H = ±(I − nnᵀ)/|x − c|       + outside, − inside
//! box         φ = |max(y, 0)| + min(max_k y_k, 0) − ρ,   y_k = |x_k − c_k| − (half_k − ρ)
//!             H ≠ 0 only off a corner or an edge
//! ```
//!
//! The edges and corners of a box are rounded with the radius ρ, a thousandth of the smallest half. A sharp edge has no
//! normal, and the force that leads a sliding particle round it would have no bound. On a round edge a particle with
//! v² > g ρ takes off, and a slower particle goes round.
//!
//! Sticking is a condition on velocities, so the tangential rows have C = 0. Their exact γ is ṫ·v, which is zero at
//! v = 0, and they are active only at v = 0. Friction follows Coulomb's law: |λ_t| ≤ μ λ_n.
//!
//! Fails in the centre of a ball, where no direction leads to the surface; n is then the first axis.

use super::{ConstraintError, ContactRows, Formulation, Holds, RowWriter};
use crate::allowed::{all_finite, check_restitution, finite, not_negative, positive};
use crate::linalg::block::{Block, diagonal, outer, plus, zero};
use crate::point::{Motion, Point, Vector, dot, first, first_axis, minus, norm, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// ρ of a box, relative to its smallest half.
const ROUND: f64 = 1e-3;

/// The surface of an obstacle; third components are ignored in two dimensions.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// The particle stays where normal·x ≥ offset: ground, a wall, a slope.
    HalfSpace {
        /// A direction of any length.
        normal: [f64; 3],
        /// The offset of the plane along the unit normal \[m\].
        offset: f64,
    },
    /// A circle or sphere.
    Ball {
        /// \[m\].
        center: [f64; 3],
        /// \[m\], positive.
        radius: f64,
        /// Whether the particle stays inside.
        inside: bool,
    },
    /// A box along the axes; the particle stays outside. The radius of its round edges is a thousandth of the
    /// smallest half.
    Box {
        /// \[m\].
        center: [f64; 3],
        /// Half its size along each axis \[m\], positive.
        half: [f64; 3],
    },
}

impl Surface {
    /// A half-space: the particle stays where normal·x ≥ offset \[m\], for the unit vector along the normal.
    pub fn half_space(normal: impl Into<Vector>, offset: f64) -> Self {
        Surface::HalfSpace { normal: normal.into().0, offset }
    }

    /// A ball that the particle stays out of: its centre \[m\] and radius \[m\].
    pub fn ball(center: impl Into<Vector>, radius: f64) -> Self {
        Surface::Ball { center: center.into().0, radius, inside: false }
    }

    /// A ball that the particle stays in: its centre \[m\] and radius \[m\].
    pub fn inside_of_ball(center: impl Into<Vector>, radius: f64) -> Self {
        Surface::Ball { center: center.into().0, radius, inside: true }
    }

    /// A box along the axes that the particle stays out of: its centre \[m\] and half its size along each axis \[m\].
    /// In two dimensions the third component of the half size is ignored, but positive.
    pub fn block(center: impl Into<Vector>, half: [f64; 3]) -> Self {
        Surface::Box { center: center.into().0, half }
    }
}

/// One particle on one side of a surface, with restitution and friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// The particle.
    pub particle: ParticleId,
    /// The surface.
    pub surface: Surface,
    /// e, in [0, 1]: the part of the closing speed that an impact gives back.
    pub restitution: f64,
    /// μ of Coulomb's law, not negative.
    pub friction: f64,
}

/// φ, n and H at one point.
struct Near<const D: usize> {
    phi: f64,
    n: Point<D>,
    H: Block<D>,
}

impl Obstacle {
    /// An obstacle without restitution and friction.
    pub fn new(particle: ParticleId, surface: Surface) -> Self {
        Obstacle { particle, surface, restitution: 0.0, friction: 0.0 }
    }

    /// The same with the part of the closing speed that an impact gives back \[1\].
    pub fn with_restitution(self, restitution: f64) -> Self {
        Obstacle { restitution, ..self }
    }

    /// The same with μ of Coulomb's law \[1\].
    pub fn with_friction(self, friction: f64) -> Self {
        Obstacle { friction, ..self }
    }

    fn near<const D: usize>(&self, x: Point<D>) -> Near<D> {
        match &self.surface {
            Surface::HalfSpace { normal, offset } => {
                let normal = first::<D>(normal);
                let n = scaled(1.0 / norm(normal), normal);
                Near { phi: dot(n, x) - offset, n, H: zero() }
            }
            Surface::Ball { center, radius, inside } => {
                let away = from_point(minus(x, first::<D>(center)));
                let sign = if *inside { -1.0 } else { 1.0 };
                Near { phi: sign * (away.phi - radius), n: scaled(sign, away.n), H: plus(zero(), sign, away.H) }
            }
            Surface::Box { center, half } => near_box(minus(x, first::<D>(center)), first::<D>(half)),
        }
    }

    fn has_friction(&self) -> bool {
        self.friction > 0.0
    }
}

/// φ = |d|.
fn from_point<const D: usize>(d: Point<D>) -> Near<D> {
    let length = norm(d);
    if length == 0.0 {
        return Near { phi: 0.0, n: first_axis(), H: zero() };
    }
    let n = scaled(1.0 / length, d);
    Near { phi: length, n, H: plus(diagonal(1.0 / length), -1.0 / length, outer(1.0, n, n)) }
}

fn near_box<const D: usize>(d: Point<D>, half: Point<D>) -> Near<D> {
    let rho = ROUND * half.iter().copied().fold(f64::INFINITY, f64::min);
    let sign: Point<D> = d.map(|d| if d < 0.0 { -1.0 } else { 1.0 });
    let y: Point<D> = std::array::from_fn(|k| d[k].abs() - (half[k] - rho));
    let near = if y.iter().filter(|&&y| y > 0.0).count() > 1 {
        // Beyond a corner or an edge, the distance is measured from the nearest point of the box shrunk by ρ.
        from_point(std::array::from_fn(|k| sign[k] * y[k].max(0.0)))
    } else {
        let nearest = (1..D).fold(0, |nearest, k| if y[k] > y[nearest] { k } else { nearest });
        let n = std::array::from_fn(|k| if k == nearest { sign[k] } else { 0.0 });
        Near { phi: y[nearest], n, H: zero() }
    };
    Near { phi: near.phi - rho, ..near }
}

/// Unit vectors along the surface: in the plane n turned by a quarter turn, in space two orthogonal vectors. They jump
/// only where n_z passes −0.9. A jump at n_z = 0 would be possible, too, but motions in the plane z = 0 have n_z = 0.
/// Source: Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6 (2017).
fn tangents<const D: usize>(n: Point<D>) -> [Point<D>; 2] {
    if D == 2 {
        let along = std::array::from_fn(|k| if k == 0 { -n[1] } else { n[0] });
        return [along, [0.0; D]];
    }
    let (x, y, z) = (n[0], n[1], n[2 % D]);
    let sign = if z < -0.9 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    let (one, other) = ([1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]);
    [std::array::from_fn(|k| one[k]), std::array::from_fn(|k| other[k])]
}

impl Holds for Obstacle {
    fn row_count(&self, dimension: usize) -> usize {
        if self.has_friction() { dimension } else { 1 }
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.particle]
    }

    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>) {
        let v = motion.v(self.particle);
        let Near { phi, n, H } = self.near(motion.x(self.particle));
        let gamma = (0..D).map(|k| v[k] * dot(H[k], v)).sum();
        rows.write(phi, dot(n, v), gamma, [n]);
        if self.has_friction() {
            for t in tangents(n).into_iter().take(D - 1) {
                rows.write(0.0, dot(t, v), 0.0, [t]);
            }
        }
    }

    fn scale(&self, extent: f64) -> f64 {
        extent
    }

    fn contacts(&self, dimension: usize) -> [Option<ContactRows>; 2] {
        let tangents = 1..self.row_count(dimension);
        let (restitution, friction) = (self.restitution, self.friction);
        [Some(ContactRows { normal: 0, tangents, restitution, friction }), None]
    }

    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        let H = self.near::<D>(motion.x(self.particle)).H;
        (0..D).map(|k| H[k][k].abs()).sum()
    }

    fn geometric_stiffness<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    ) {
        let H = self.near::<D>(motion.x(self.particle)).H;
        visit(0, 0, Stiffness::Difference(plus(zero(), -lambda[0], H)));
    }

    fn formulated(&self, _: Formulation) -> Self {
        self.clone()
    }

    fn check(&self) -> Result<(), ConstraintError> {
        check_restitution(self.restitution)?;
        not_negative("the friction of an obstacle", self.friction)?;
        match &self.surface {
            Surface::HalfSpace { normal, offset } => {
                finite("the offset of a half-space", *offset)?;
                positive("the length of the normal of a half-space", norm(*normal))?;
            }
            Surface::Ball { center, radius, .. } => {
                all_finite("the centre of a ball", center)?;
                positive("the radius of a ball", *radius)?;
            }
            Surface::Box { center, half } => {
                all_finite("the centre of a box", center)?;
                half.iter().try_for_each(|&half| positive("half the size of a box", half))?;
            }
        }
        Ok(())
    }
}

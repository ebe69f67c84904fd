//! Bodies: a rigid body as a few particles and the rods between them, which move as the body does.
//!
//! In Newton's and Euler's equations the matter of a rigid body appears in three sums only,
//!
//! ```text
//! m = Σ m_i,   c = Σ m_i x_i / m,   S = Σ m_i (x_i − c)(x_i − c)ᵀ            kg, m, kg m²
//! inertia tensor I = tr(S) 1 − S,   in the plane the polar moment I = tr(S)
//! ```
//!
//! so two rigid systems with the same three sums are *equimomental*: under the same resultant and moment they move
//! alike (E. J. Routh, *Dynamics of a System of Rigid Bodies*, Elementary Part, chapter I). A few particles are
//! enough. Let m G Gᵀ = S with r independent columns g_k, and let s_0 … s_r be the corners of a simplex in r
//! dimensions with Σ s_i = 0 and Σ s_i s_iᵀ = (r + 1) 1:
//!
//! ```text
//! r = 1:  −1, 1      r = 2:  √2 (cos 2πi/3, sin 2πi/3)      r = 3:  (1, 1, 1) (1, −1, −1) (−1, 1, −1) (−1, −1, 1)
//! x_i = c + G s_i with m_i = m/(r + 1)   ⇒   Σ m_i (x_i − c)(x_i − c)ᵀ = m G Gᵀ = S
//! ```
//!
//! The points are again the corners of a simplex. Rods along all its edges hold it, and no rod repeats another: the
//! edges that meet in a corner are linearly independent. A body that is flat in space has r = 2, and a body in one line
//! has r = 1.
//!
//! A body that is uniform over x = c + Σ u_k e_k, |u_k| ≤ ½ (a box with the edges e_k) has S = m Σ e_k e_kᵀ/12, so
//! g_k = e_k/√12. A triangle is equimomental to m/3 at the middle of each side. In the plane only tr(S) counts.

mod error;
mod factor;
mod pose;

pub use error::BodyError;
pub use pose::Pose;

use crate::number::cross;
use crate::point::{add, dot, minus, norm, scaled};
use crate::space::ParticleId;
use factor::factor;

/// The relative size of an eigenvalue of S below which the body counts as flat in that direction. The moments change
/// by as little, and a simplex as thin as that would have rods that double precision cannot tell apart.
const FLAT: f64 = 1e-12;

/// Particles and rods that move as a rigid body does. In two dimensions z is 0 and rotations are about z.
///
/// ```
/// use qhat::{Body, Dimension, Distance, Particle, System};
/// let brick = Body::block(2.0, [0.0; 3], &[[0.2, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.05]])?;
/// assert_eq!((brick.points.len(), brick.rods.len()), (4, 6));
///
/// let mut builder = System::builder(Dimension::Three);
/// let velocities = brick.velocities([1.0, 0.0, 0.0], [0.0, 0.0, 6.0]);
/// let ids: Vec<_> = (0..4)
///     .map(|i| Particle::at(format!("brick{i}"), brick.points[i]).with_mass(brick.masses[i]))
///     .zip(velocities)
///     .map(|(particle, velocity)| particle.with_velocity(velocity))
///     .map(|particle| builder.particle(particle))
///     .collect();
/// for (k, &[a, b]) in brick.rods.iter().enumerate() {
///     builder.constraint(format!("rod{k}"), Distance::new(ids[a], ids[b], brick.length(k)));
/// }
/// # builder.build().unwrap();
/// # Ok::<(), qhat::BodyError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// x_i, the positions of the particles \[m\].
    pub points: Vec<[f64; 3]>,
    /// m_i, the masses of the particles \[kg\], positive.
    pub masses: Vec<f64>,
    /// The two particles of each rod.
    pub rods: Vec<[usize; 2]>,
    /// A particle, and the two in whose middle it stays. Empty but for a bar in space.
    pub midpoints: Vec<[usize; 3]>,
}

impl Body {
    /// A uniform body over the edges e_k \[m\] around a centre \[m\]: a thin bar (one edge), a plate (two) or a block
    /// (three), not necessarily with right angles. It has two, three or four particles. A bar in space has no spin
    /// about itself.
    ///
    /// # Errors
    /// A mass \[kg\] that is not positive; numbers that are not finite; edges that are linearly dependent.
    pub fn block(mass: f64, centre: [f64; 3], edges: &[[f64; 3]]) -> Result<Self, BodyError> {
        check(mass, edges.iter().chain([&centre]))?;
        if !(1..=3).contains(&edges.len()) {
            return Err(BodyError::EdgeCount(edges.len()));
        }
        let unit: Vec<[f64; 3]> = edges.iter().map(|&edge| scaled(1.0 / norm(edge), edge)).collect();
        let area = |a: usize, b: usize| cross(unit[a], unit[b]);
        let volume = match edges.len() {
            1 => norm(unit[0]),
            2 => norm(area(0, 1)),
            _ => dot(area(0, 1), unit[2]).abs(),
        };
        // NaN where an edge has no length; a comparison with NaN is false.
        let is_full = volume * volume > FLAT;
        if !is_full {
            return Err(BodyError::FlatEdges);
        }
        // g = e/√12 is half the edge over √3.
        let g: Vec<[f64; 3]> = edges.iter().map(|&edge| scaled(1.0 / 12.0_f64.sqrt(), edge)).collect();
        Body::simplex(mass, centre, &g)
    }

    /// A uniform triangular plate with these corners \[m\]: a third of its mass \[kg\] at the middle of each side.
    ///
    /// # Errors
    /// A mass that is not positive; numbers that are not finite; corners in a line.
    pub fn triangle(mass: f64, corners: [[f64; 3]; 3]) -> Result<Self, BodyError> {
        check(mass, &corners)?;
        let [a, b, c] = corners;
        let (u, v) = (minus(b, a), minus(c, a));
        let is_full = norm(cross(u, v)) > FLAT.sqrt() * norm(u) * norm(v);
        if !is_full {
            return Err(BodyError::FlatEdges);
        }
        let middle = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| 0.5 * a[k] + 0.5 * b[k]);
        Body::complete(vec![middle(a, b), middle(b, c), middle(c, a)], vec![mass / 3.0; 3])
    }

    /// A body in space of a given mass \[kg\], centre \[m\] and inertia tensor about the centre [kg m²].
    ///
    /// # Errors
    /// A mass that is not positive; numbers that are not finite; a tensor that is not symmetric, or that no body has (a
    /// principal moment above the sum of the others, or all zero).
    pub fn from_inertia(mass: f64, centre: [f64; 3], inertia: [[f64; 3]; 3]) -> Result<Self, BodyError> {
        check(mass, inertia.iter().chain([&centre]))?;
        let trace = inertia[0][0] + inertia[1][1] + inertia[2][2];
        let off = |i: usize, j: usize| (inertia[i][j] - inertia[j][i]).abs();
        // The two entries may be sums in different order, which differ by roundoff.
        if [off(0, 1), off(0, 2), off(1, 2)].iter().any(|&off| off > 1e-12 * trace.abs()) {
            return Err(BodyError::NotSymmetric);
        }
        let second = |i: usize, j: usize| if i == j { 0.5 * trace - inertia[i][j] } else { -inertia[i][j] };
        let S = std::array::from_fn(|i| std::array::from_fn(|j| second(i, j) / mass));
        Body::simplex(mass, centre, &factor(S)?)
    }

    /// A body in the plane of a given mass \[kg\], centre \[m\] and moment of inertia about the centre [kg m²]: three
    /// particles at the radius of gyration.
    ///
    /// # Errors
    /// A mass or moment of inertia that is not positive; numbers that are not finite.
    pub fn in_plane(mass: f64, centre: [f64; 2], inertia: f64) -> Result<Self, BodyError> {
        let centre = [centre[0], centre[1], 0.0];
        check(mass, [&centre, &[inertia, 0.0, 0.0]])?;
        if inertia <= 0.0 {
            return Err(BodyError::NoExtent);
        }
        let g = (0.5 * inertia / mass).sqrt();
        Body::simplex(mass, centre, &[[g, 0.0, 0.0], [0.0, g, 0.0]])
    }

    /// A uniform thin bar in the plane with a particle at each end \[m\], so that it can be nailed there.
    ///
    /// Three particles in its line (m/6, 4m/6, m/6) have its moments, too, but rods in one line cannot hold them
    /// without the constraint of [`bar_in_space`](Self::bar_in_space). Here the middle is two particles at ±w beside
    /// the line. w and the masses make the moment of inertia right, which is enough in the plane:
    /// 2 · 11/72 · (L/2)² + 2 · 25/72 · (L/10)² = L²/12. Particles 0 and 1 are the ends.
    ///
    /// # Errors
    /// A mass \[kg\] that is not positive; numbers that are not finite; ends at the same place.
    pub fn bar_in_plane(mass: f64, ends: [[f64; 2]; 2]) -> Result<Self, BodyError> {
        let [a, b] = ends.map(|end| [end[0], end[1], 0.0]);
        check(mass, [&a, &b])?;
        let along = minus(b, a);
        let side = |w: f64| std::array::from_fn(|k| 0.5 * a[k] + 0.5 * b[k] + w * [-along[1], along[0], 0.0][k]);
        let [end, middle] = [11.0 / 72.0 * mass, 25.0 / 72.0 * mass];
        let body = Body {
            points: vec![a, b, side(0.1), side(-0.1)],
            masses: vec![end, end, middle, middle],
            // Four points in the plane need five rods; the sixth, between the two in the middle, would repeat them.
            rods: vec![[0, 1], [0, 2], [2, 1], [0, 3], [3, 1]],
            midpoints: Vec::new(),
        };
        body.told_apart()
    }

    /// A uniform thin bar in space with a particle at each end \[m\], so that it can be nailed there: m/6 at each end,
    /// 4m/6 in the middle.
    ///
    /// The bar has no moment about itself, so its particles lie in one line. Rods cannot hold them: a third rod
    /// repeats the others and leaves the middle free to move sideways. Here one rod holds the ends, and the third
    /// particle [stays in their middle](crate::Relation::midpoint): 9 − 1 − 3 = 5 degrees of freedom. Particles 0 and
    /// 1 are the ends.
    ///
    /// # Errors
    /// A mass \[kg\] that is not positive; numbers that are not finite; ends at the same place.
    pub fn bar_in_space(mass: f64, ends: [[f64; 3]; 2]) -> Result<Self, BodyError> {
        check(mass, &ends)?;
        let [a, b] = ends;
        let body = Body {
            points: vec![a, b, std::array::from_fn(|k| 0.5 * a[k] + 0.5 * b[k])],
            masses: vec![mass / 6.0, mass / 6.0, mass * (2.0 / 3.0)],
            rods: vec![[0, 1]],
            midpoints: vec![[2, 0, 1]],
        };
        body.told_apart()
    }

    /// c \[m\].
    pub fn center(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (&point, &mass) in self.points.iter().zip(&self.masses) {
            add(&mut sum, ParticleId(0), scaled(mass, point));
        }
        scaled(1.0 / self.masses.iter().sum::<f64>(), sum)
    }

    /// v_i = v + ω × (x_i − c) [m/s] for the velocity v of c [m/s] and the angular velocity ω [rad/s].
    pub fn velocities(&self, v: [f64; 3], omega: [f64; 3]) -> Vec<[f64; 3]> {
        let c = self.center();
        let turning = self.points.iter().map(|&x| cross(omega, minus(x, c)));
        turning.map(|turning| std::array::from_fn(|k| v[k] + turning[k])).collect()
    }

    /// The length of a rod \[m\], by its place in [`Body::rods`].
    ///
    /// # Panics
    /// If there is no such rod.
    pub fn length(&self, rod: usize) -> f64 {
        let [a, b] = self.rods[rod];
        norm(minus(self.points[a], self.points[b]))
    }

    /// x_i = c + G s_i.
    fn simplex(mass: f64, c: [f64; 3], g: &[[f64; 3]]) -> Result<Self, BodyError> {
        // √2 (cos 2πi/3, sin 2πi/3) in roots.
        let (half, root) = (0.5_f64.sqrt(), 1.5_f64.sqrt());
        let corners: &[[f64; 3]] = match g.len() {
            1 => &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
            2 => &[[2.0 * half, 0.0, 0.0], [-half, root, 0.0], [-half, -root, 0.0]],
            _ => &[[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
        };
        let place = |s: &[f64; 3]| {
            let component = |k: usize| g.iter().zip(s).fold(c[k], |sum, (g, s)| sum + s * g[k]);
            std::array::from_fn(component)
        };
        Body::complete(corners.iter().map(place).collect(), vec![mass / corners.len() as f64; corners.len()])
    }

    /// The body with a rod between any two particles.
    fn complete(points: Vec<[f64; 3]>, masses: Vec<f64>) -> Result<Self, BodyError> {
        let rods = (1..points.len()).flat_map(|b| (0..b).map(move |a| [a, b])).collect();
        Body { points, masses, rods, midpoints: Vec::new() }.told_apart()
    }

    /// The body itself, if its particles are at different places after rounding.
    fn told_apart(self) -> Result<Self, BodyError> {
        let lengths = (0..self.rods.len()).map(|rod| self.length(rod));
        if self.points.iter().flatten().all(|x| x.is_finite()) && lengths.into_iter().all(|length| length > 0.0) {
            Ok(self)
        } else {
            Err(BodyError::Lost)
        }
    }
}

fn check<'a>(mass: f64, numbers: impl IntoIterator<Item = &'a [f64; 3]>) -> Result<(), BodyError> {
    if !numbers.into_iter().flatten().all(|number| number.is_finite()) {
        return Err(BodyError::NotFinite);
    }
    if mass > 0.0 && mass.is_finite() { Ok(()) } else { Err(BodyError::Mass(mass)) }
}

//! Gears: a sum of integer multiples of the angles of arms and of displacements along directions is held at a value, up
//! to whole turns: meshing wheels, planetary gears, a belt, a rack and pinion, the hands of a clock. In the plane only.
//!
//! ```text
//! d of each arm,   arg d = atan2(d_y, d_x)
//! C = Σ (z arg d + k·d) − α(t)            [rad],  less whole turns so that |C| ≤ π;   λ [N·m]
//! ∂C/∂d = z (−d_y, d_x)/|d|² + k,   C_t = −α̇
//! ```
//!
//! An arm that goes round once adds z whole turns to the sum. z is an integer, so C(q, t) does not depend on the number
//! of turns, and turns need not be counted. Teeth work in the same way: wheels of z₁ and z₂ teeth mesh wherever z₁ φ₁ +
//! z₂ φ₂ has the right value up to whole turns, one turn for each tooth. Angles are counted from the line between the
//! centres. This line goes from c₁ to c₂ in the direction ψ, which may itself turn (a planetary gear):
//!
//! ```text
//! z₁ (φ₁ − ψ) + z₂ (φ₂ − ψ) = α           outside each other; z₂ < 0: one wheel inside the other, or a belt
//! φ − k·d = α, k = e/r, d = x_p − x_c     a rack that moves along e past a pinion of radius r to the left of it
//! ```
//!
//! The z are divided by their greatest common factor. The wheels then mesh at the fewest positions that the ratio
//! allows. The torques on the wheels are λ z₁ and λ z₂, and the rest of the torque acts on the centres.
//!
//! Fails where an arm has no length. C jumps half a tooth away from where C = 0: a step that starts there slips to the
//! next tooth. A ratio that is not a quotient of integers is not possible, because C would have to count turns.

use super::angle::within_half_a_turn;
use super::arms::Arms;
use super::error::ConstraintError;
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::allowed::all_finite;
use crate::driven::Driven;
use crate::number::{Number, dot};
use crate::space::ParticleId;

/// The largest number of teeth, also for the sum of two wheels. With more teeth, two teeth would be less than a
/// thousandth of a turn apart.
const MOST_TEETH: u32 = 1000;

/// The term of one arm in the sum.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    /// z arg d.
    Turn(i32),
    /// k·d, k in rad/m.
    Way([f64; 2]),
}

/// Coupled angles and displacements, in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Gears {
    arms: Arms,
    parts: Vec<Part>,
    pub(crate) angle: Driven,
}

impl Gears {
    /// Two wheels that mesh at α \[rad\]. Each wheel is an arm from its centre to one of its points, with its number of
    /// teeth. One of the numbers is negative if one wheel lies inside the other or a belt connects the wheels.
    pub fn mesh(wheels: [[ParticleId; 2]; 2], teeth: [i32; 2], angle: impl Into<Driven>) -> Self {
        let [[c1, _], [c2, _]] = wheels;
        let common = divisor(teeth[0].unsigned_abs(), teeth[1].unsigned_abs()).max(1) as i32;
        let [z1, z2] = teeth.map(|z| z / common);
        let centres = ([c1, c2], z1.saturating_add(z2).saturating_neg());
        let arms = [(wheels[0], z1), (wheels[1], z2), centres];
        // For equal wheels on a belt, ψ cancels.
        Gears::coupled(if centres.1 == 0 { &arms[..2] } else { &arms }, angle)
    }

    /// Σ z φ = α \[rad\] up to whole turns, over arms whose angles φ count from the x axis: wheels with fixed centres.
    pub fn coupled(arms: &[([ParticleId; 2], i32)], angle: impl Into<Driven>) -> Self {
        let (ends, parts): (Vec<_>, Vec<_>) = arms.iter().map(|&(ends, z)| (ends, Part::Turn(z))).unzip();
        Gears { arms: Arms::new(ends), parts, angle: angle.into() }
    }

    /// A pinion and a rack. The pinion is an arm from its centre to one of its points, has the given radius \[m\], and
    /// is to the left of the direction of the rack, which may have any length. `rack` is a point of the rack.
    pub fn rack(
        pinion: [ParticleId; 2],
        rack: ParticleId,
        along: [f64; 2],
        radius: f64,
        angle: impl Into<Driven>,
    ) -> Self {
        let size = along[0].abs().max(along[1].abs());
        let [x, y] = along.map(|component| component / size);
        let k = -1.0 / (radius * (x * x + y * y).sqrt());
        let parts = vec![Part::Turn(1), Part::Way([k * x, k * y])];
        Gears { arms: Arms::new([pinion, [pinion[0], rack]]), parts, angle: angle.into() }
    }

    /// The arms whose angles are added, each with its z. For two meshing wheels, the arm from centre to centre is one
    /// of them.
    pub fn turns(&self) -> impl Iterator<Item = ([ParticleId; 2], i32)> + '_ {
        self.parts.iter().enumerate().filter_map(|(arm, part)| match *part {
            Part::Turn(z) => Some((self.arms.ends(arm), z)),
            Part::Way(_) => None,
        })
    }

    /// The arms whose displacements are added, from the centre of a pinion to its rack, each with k [rad/m].
    pub fn ways(&self) -> impl Iterator<Item = ([ParticleId; 2], [f64; 2])> + '_ {
        self.parts.iter().enumerate().filter_map(|(arm, part)| match *part {
            Part::Way(k) => Some((self.arms.ends(arm), k)),
            Part::Turn(_) => None,
        })
    }
}

impl Smooth for Gears {
    const ONLY_IN: Option<usize> = Some(2);

    fn particle(&self, i: usize) -> Option<ParticleId> {
        self.arms.particles().get(i).copied()
    }

    fn row<N: Number, const D: usize>(&self, _: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        let (angle, rate) = self.angle.at(at.t);
        let way = |k: [f64; 2]| -> [N; D] { std::array::from_fn(|i| N::constant(k[i])) };
        let mut sum = -angle;
        for (arm, part) in self.parts.iter().enumerate() {
            let d = self.arms.vector(arm, at);
            sum = sum
                + match *part {
                    Part::Turn(z) => N::atan2(d[1], d[0]).times(z.into()),
                    Part::Way(k) => dot(way(k), d),
                };
        }
        let slope = |arm: usize| match self.parts[arm] {
            Part::Turn(z) => {
                let d = self.arms.vector(arm, at);
                let factor = N::constant(z.into()) / dot(d, d);
                std::array::from_fn(|i| if i == 0 { -(factor * d[1]) } else { factor * d[0] })
            }
            Part::Way(k) => way(k),
        };
        self.arms.spread(slope, gradient);
        Residual { C: within_half_a_turn(sum), C_t: -rate }
    }

    fn may_jump(&self) -> bool {
        true
    }

    fn arms(&self) -> Vec<[ParticleId; 2]> {
        self.arms.all()
    }

    fn scale(&self, extent: f64) -> f64 {
        let size = |part: &Part| match *part {
            Part::Turn(z) => f64::from(z).abs(),
            Part::Way([x, y]) => extent * (x * x + y * y).sqrt(),
        };
        self.parts.iter().map(size).fold(1.0, f64::max)
    }

    fn check(&self) -> Result<(), ConstraintError> {
        if self.parts.len() < 2 {
            return Err(ConstraintError::GearArms);
        }
        for (arm, part) in self.parts.iter().enumerate() {
            if self.arms.is_without_length(arm) {
                return Err(ConstraintError::GearArmEnds { arm });
            }
            match *part {
                Part::Turn(z) if z.unsigned_abs() > MOST_TEETH => {
                    return Err(ConstraintError::GearTeeth { most: MOST_TEETH });
                }
                Part::Turn(0) => return Err(ConstraintError::GearWithoutTeeth { arm }),
                Part::Turn(_) => {}
                Part::Way(k) => all_finite("the direction over the radius of a rack", &k)?,
            }
        }
        Ok(self.angle.check("the angle at which gears mesh")?)
    }
}

/// The greatest common divisor.
fn divisor(mut a: u32, mut b: u32) -> u32 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

//! Pose: the place, the turn and the motion of a rigid group of particles.
//!
//! ```text
//! c = Σ m_i x_i / m,   v = Σ m_i v_i / m,   L = Σ m_i (x_i − c) × (v_i − v)            m, m/s, kg m²/s
//! x_i − c = R (X_i − C)                X: the positions to which the turn is relative
//! ω = a × ȧ/|a|² + w a/|a|             a, b: the offsets x_i − c of two particles, ȧ, ḃ their rates
//! w = (a/|a|)·(b' × (ḃ − (a × ȧ) × b/|a|²))/|b'|²         b': the part of b across a
//! ```
//!
//! a is that of the particle farthest from c, and b that of the one farthest across a, both at the positions X. R takes
//! their directions to the present ones. A group in one line has no turn about itself: R is then the shortest turn,
//! and w = 0.

use crate::number::cross;
use crate::point::{add, dot, minus, norm, scaled};
use crate::space::ParticleId;

/// Part of the size of a group below which its particles lie in one line.
const IN_LINE: f64 = 1e-9;

/// Sine of an angle that is roundoff of two unit vectors.
const ROUNDOFF: f64 = 1e-15;

/// The pose and motion of a rigid group of particles. In two dimensions z is 0 and turns are about z.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Pose {
    /// c, the centre of mass \[m\].
    pub center: [f64; 3],
    /// R as a unit quaternion (w, x, y, z), w not negative \[1\].
    pub rotation: [f64; 4],
    /// v, the velocity of the centre of mass [m/s].
    pub velocity: [f64; 3],
    /// ω, the angular velocity [rad/s].
    pub spin: [f64; 3],
    /// L, the angular momentum about the centre of mass [kg m²/s].
    pub angular_momentum: [f64; 3],
}

impl Pose {
    /// The pose of particles of these masses \[kg\] that have moved as a rigid body from some positions \[m\] to
    /// others, with these velocities [m/s].
    ///
    /// ```
    /// use qhat::Pose;
    /// let pose = Pose::new(&[1.0, 1.0], &[[0.0; 3], [2.0, 0.0, 0.0]], &[[5.0, -1.0, 0.0], [5.0, 1.0, 0.0]],
    ///     &[[3.0, 0.0, 0.0], [-3.0, 0.0, 0.0]]);
    /// assert_eq!((pose.center, pose.spin), ([5.0, 0.0, 0.0], [0.0, 0.0, 3.0]));
    /// assert_eq!(pose.angular_momentum, [0.0, 0.0, 6.0]);
    /// assert!((pose.angle() - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    /// ```
    ///
    /// # Panics
    /// If the lists have different lengths.
    pub fn new(masses: &[f64], from: &[[f64; 3]], to: &[[f64; 3]], velocities: &[[f64; 3]]) -> Pose {
        assert!([from.len(), to.len(), velocities.len()] == [masses.len(); 3], "one entry for each particle");
        let (before, center, velocity) = (mean(masses, from), mean(masses, to), mean(masses, velocities));
        let from: Vec<[f64; 3]> = from.iter().map(|&x| minus(x, before)).collect();
        let to: Vec<[f64; 3]> = to.iter().map(|&x| minus(x, center)).collect();
        let rates: Vec<[f64; 3]> = velocities.iter().map(|&v| minus(v, velocity)).collect();
        let mut angular_momentum = [0.0; 3];
        for ((&mass, &x), &rate) in masses.iter().zip(&to).zip(&rates) {
            add(&mut angular_momentum, ParticleId(0), scaled(mass, cross(x, rate)));
        }
        let spread = Spread::of(&from);
        let (rotation, spin) = (spread.rotation(&from, &to), spread.spin(&to, &rates));
        Pose { center, rotation, velocity, spin, angular_momentum }
    }

    /// The angle of the turn about z, between −π and π \[rad\].
    pub fn angle(&self) -> f64 {
        let [w, _, _, z] = self.rotation;
        2.0 * libm::atan2(z, w)
    }
}

fn mean(masses: &[f64], vectors: &[[f64; 3]]) -> [f64; 3] {
    let total: f64 = masses.iter().sum();
    std::array::from_fn(|k| masses.iter().zip(vectors).map(|(m, x)| m * x[k]).sum::<f64>() / total)
}

/// The place of the largest number.
fn largest(numbers: impl Iterator<Item = f64>) -> usize {
    let best = numbers.enumerate().reduce(|best, next| if next.1 > best.1 { next } else { best });
    best.map_or(0, |(place, _)| place)
}

/// The part of a vector across a unit vector.
fn across(x: [f64; 3], unit: [f64; 3]) -> [f64; 3] {
    minus(x, scaled(dot(x, unit), unit))
}

fn unit(x: [f64; 3]) -> [f64; 3] {
    scaled(1.0 / norm(x), x)
}

/// The particles whose directions tell a turn, by their places.
enum Spread {
    /// All particles are in one place.
    Point,
    /// a.
    Line(usize),
    /// a and b.
    Full(usize, usize),
}

impl Spread {
    fn of(offsets: &[[f64; 3]]) -> Self {
        let far = largest(offsets.iter().map(|&x| norm(x)));
        let size = offsets.get(far).map_or(0.0, |&x| norm(x));
        if size == 0.0 {
            return Spread::Point;
        }
        let a = unit(offsets[far]);
        let beside = largest(offsets.iter().map(|&x| norm(across(x, a))));
        if norm(across(offsets[beside], a)) > IN_LINE * size { Spread::Full(far, beside) } else { Spread::Line(far) }
    }

    /// R as a quaternion, from the offsets before and now.
    fn rotation(&self, from: &[[f64; 3]], to: &[[f64; 3]]) -> [f64; 4] {
        match *self {
            Spread::Point => [1.0, 0.0, 0.0, 0.0],
            Spread::Line(a) => shortest(unit(from[a]), unit(to[a])),
            Spread::Full(a, b) => {
                let frame = |offsets: &[[f64; 3]]| {
                    let along = unit(offsets[a]);
                    let second = unit(across(offsets[b], along));
                    [along, second, cross(along, second)]
                };
                let (before, now) = (frame(from), frame(to));
                // R = Σ now_k before_kᵀ.
                let entry = |i: usize, j: usize| (0..3).map(|k| now[k][i] * before[k][j]).sum();
                quaternion(std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))))
            }
        }
    }

    /// ω, from the offsets now and their rates.
    fn spin(&self, offsets: &[[f64; 3]], rates: &[[f64; 3]]) -> [f64; 3] {
        let (Spread::Line(a) | Spread::Full(a, _)) = *self else { return [0.0; 3] };
        let square = dot(offsets[a], offsets[a]);
        let mut omega = scaled(1.0 / square, cross(offsets[a], rates[a]));
        if let Spread::Full(_, b) = *self {
            let along = unit(offsets[a]);
            let aside = across(offsets[b], along);
            let rest = minus(rates[b], cross(omega, offsets[b]));
            let w = dot(along, cross(aside, rest)) / dot(aside, aside);
            add(&mut omega, ParticleId(0), scaled(w, along));
        }
        omega
    }
}

/// The shortest turn from one direction to another.
fn shortest(a: [f64; 3], b: [f64; 3]) -> [f64; 4] {
    // 1 + a·b, without the roundoff of 1 where a and b are almost opposite.
    let sum: [f64; 3] = std::array::from_fn(|k| a[k] + b[k]);
    let (w, [x, y, z]) = (0.5 * dot(sum, sum), cross(a, b));
    let length = (w * w + x * x + y * y + z * z).sqrt();
    if length < ROUNDOFF {
        // Opposite directions: half a turn about an axis across them, in the plane about z.
        let other = if a[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        let axis = unit(across(other, a));
        return [0.0, axis[0], axis[1], axis[2]];
    }
    [w, x, y, z].map(|part| part / length)
}

/// The quaternion of a rotation matrix, by its largest part.
/// Source: Shepperd, Quaternion from rotation matrix, J. Guidance and Control 1 (1978) 223.
fn quaternion(R: [[f64; 3]; 3]) -> [f64; 4] {
    let trace = R[0][0] + R[1][1] + R[2][2];
    let squares = [trace, R[0][0], R[1][1], R[2][2]];
    let place = largest(squares.into_iter());
    let whole = (1.0 + 2.0 * squares[place] - trace).max(0.0).sqrt();
    let half = 0.5 / whole;
    let [yz, zx, xy] = [R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1]];
    let [with_xy, with_zx, with_yz] = [R[0][1] + R[1][0], R[0][2] + R[2][0], R[1][2] + R[2][1]];
    let found = match place {
        0 => [0.5 * whole, half * yz, half * zx, half * xy],
        1 => [half * yz, 0.5 * whole, half * with_xy, half * with_zx],
        2 => [half * zx, half * with_xy, 0.5 * whole, half * with_yz],
        _ => [half * xy, half * with_zx, half * with_yz, 0.5 * whole],
    };
    let length = found.iter().map(|part| part * part).sum::<f64>().sqrt();
    let sign = if found[0] < 0.0 { -1.0 } else { 1.0 };
    found.map(|part| sign * part / length)
}

//! Seeded random numbers and random systems: the same on every machine and every run.

use qhat::{
    Dimension, Distance, DistanceForm, Drag, Feedback, Gravity, MouseSpring, Nail, NailForm, Particle, PointForce,
    Spring, State, System,
};

/// SplitMix64 (Steele, Lea, Flood 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [low, high).
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    pub fn numbers(&mut self, count: usize, low: f64, high: f64) -> Vec<f64> {
        (0..count).map(|_| self.within(low, high)).collect()
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// A random order of 0..count.
    pub fn order(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            order.swap(i, self.below(i + 1));
        }
        order
    }

    /// `count` points of d numbers in [−2, 2]ᵈ, no two nearer than `apart`.
    pub fn points(&mut self, count: usize, d: usize, apart: f64) -> Vec<Vec<f64>> {
        let mut points: Vec<Vec<f64>> = Vec::new();
        while points.len() < count {
            let new = self.numbers(d, -2.0, 2.0);
            if points
                .iter()
                .all(|old| old.iter().zip(&new).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() > apart * apart)
            {
                points.push(new);
            }
        }
        points
    }

    pub fn triple(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.within(-1.0, 1.0))
    }
}

pub fn dimension(d: usize) -> Dimension {
    if d == 2 { Dimension::Two } else { Dimension::Three }
}

/// A tree of rods of either form, a fixed root, a nail of either form, every kind of force and feedback. Neither C nor
/// Ċ is zero, and the rows are independent.
pub fn web(random: &mut Random, d: usize, particles: usize) -> (System, State) {
    let points = random.points(particles, d, if particles > 12 { 0.2 } else { 0.5 });
    let mut builder = System::builder(dimension(d));
    for (i, x) in points.iter().enumerate() {
        let particle = Particle::at(format!("p{i}"), x.clone()).with_mass(random.within(0.3, 3.0));
        let v = random.numbers(d, -1.0, 1.0);
        builder.particle(if i == 0 { particle.fixed() } else { particle.with_velocity(v) });
    }
    for i in 1..particles {
        // The last particle is nailed; on a rod from the fixed root it would be held twice.
        let j = if i + 1 == particles { 1 + random.below(i - 1) } else { random.below(i) };
        let length = random.within(0.5, 2.0);
        let form = if random.below(2) == 0 { DistanceForm::Length } else { DistanceForm::Squared };
        let (a, b) = if random.below(2) == 0 { (i, j) } else { (j, i) };
        builder.constraint(format!("rod{i}"), Distance { form, ..Distance::new(super::id(a), super::id(b), length) });
    }
    let held = super::id(particles - 1);
    let form = if random.below(2) == 0 { NailForm::Vector } else { NailForm::Scalar };
    // Away from the particle, so that the scalar form has a gradient.
    let at = std::array::from_fn(|k| points[held.index()].get(k).map_or(0.0, |x| x + random.within(0.2, 0.8)));
    builder.constraint("nail", Nail { particle: held, at, form });
    builder.force(Gravity { acceleration: random.triple() });
    builder.force(Drag { coefficient: random.within(0.1, 1.0) });
    for _ in 0..particles {
        let a = 1 + random.below(particles - 1);
        let b = random.below(a);
        let (stiffness, damping, rest) = (random.within(1.0, 20.0), random.within(0.1, 2.0), random.within(0.2, 2.0));
        builder.force(Spring { a: super::id(a), b: super::id(b), stiffness, damping, rest });
    }
    builder.force(PointForce { particle: super::id(1), force: random.triple() });
    builder.force(MouseSpring { particle: super::id(1), target: random.triple(), stiffness: 3.0, damping: 0.7 });
    builder.feedback(Feedback { ks: random.within(1.0, 50.0), kd: random.within(1.0, 10.0), ..Feedback::NONE });
    builder.build().unwrap()
}

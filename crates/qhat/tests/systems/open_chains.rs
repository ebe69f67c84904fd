//! Open chains of every kind that the lanes take.

use super::random::Random;
use qhat::{Dimension, Distance, Drag, Gravity, MouseSpring, Nail, Particle, PointForce, Spring, State, System};

/// Up to four open chains with any masses, ends fixed, nailed or free, some rods springs, and every kind of force on
/// any particle, fixed ones among them. `is_general` adds a triangle of rods far away, which no lane takes.
pub fn open_chains(seed: u64, heavy: f64, is_general: bool) -> (System, State) {
    let random = &mut Random::new(seed);
    let dimension = if random.below(2) == 0 { Dimension::Two } else { Dimension::Three };
    let d = dimension.number();
    let mut builder = System::builder(dimension);
    let mut count = 0;
    for chain in 0..1 + random.below(4) {
        let links = [0, 1, 3, 9, 17, 40][random.below(6)];
        let mut x: Vec<f64> = (0..d).map(|_| 3.0 * random.within(-1.0, 1.0)).collect();
        let (first, last) = (random.below(4), random.below(4));
        for i in 0..=links {
            let mass = if random.below(20) == 0 { heavy } else { [0.01, 0.1, 1.0, 10.0, 100.0][random.below(5)] };
            let particle = Particle::at(format!("{chain}-{i}"), x.clone()).with_mass(mass);
            let (is_first, is_last) = (i == 0, i == links && links > 0);
            let is_held = is_first && first == 0 || is_last && last == 0;
            let id = builder.particle(if is_held { particle.fixed() } else { particle });
            count += 1;
            if is_first && first == 1 || is_last && last == 1 {
                builder.constraint(
                    format!("nail {chain}-{i}"),
                    Nail::new(id, std::array::from_fn::<_, 3, _>(|c| *x.get(c).unwrap_or(&0.0))),
                );
            }
            let step: Vec<f64> =
                (0..d).map(|c| 0.3 * random.within(-1.0, 1.0) + if c == 0 { 0.5 } else { 0.0 }).collect();
            let length = step.iter().map(|s| s * s).sum::<f64>().sqrt();
            if i < links {
                let rod = Distance::new(id, super::id(id.index() + 1), length);
                let is_soft = random.below(12) == 0;
                // A single rod between two held ends cannot go into lanes.
                let rod = if is_soft || links == 1 { rod.with_compliance(1e-2, 0.1) } else { rod };
                builder.constraint(format!("rod {chain}-{i}"), rod);
            }
            for (x, step) in x.iter_mut().zip(step) {
                *x += step;
            }
        }
    }
    builder.force(Gravity { acceleration: [0.3, -9.81, 1.0] });
    if random.below(2) == 0 {
        builder.with_force(Drag { coefficient: 0.1 }).force(Drag { coefficient: 0.02 });
    }
    let any = |random: &mut Random| super::id(random.below(count));
    builder.force(PointForce { particle: any(random), force: [0.01, 0.02, 0.03] });
    builder.force(MouseSpring { particle: any(random), target: [1.0, 0.0, 0.0], stiffness: 0.5, damping: 0.01 });
    for _ in 0..3 {
        let (a, b) = (any(random), any(random));
        if a != b {
            builder.force(Spring { a, b, stiffness: 0.3, damping: 0.02, rest: 0.5 });
        }
    }
    if is_general {
        let corners = [[1e3, 0.0, 0.0], [1e3 + 0.5, 0.0, 0.0], [1e3, 0.5, 0.0]];
        let corners = corners.map(|x| {
            count += 1;
            builder.particle(Particle::at(format!("corner {count}"), &x[..d]))
        });
        for (k, length) in [0.5, 0.5 * 2.0_f64.sqrt(), 0.5].into_iter().enumerate() {
            builder.constraint(format!("side {k}"), Distance::new(corners[k], corners[(k + 1) % 3], length));
        }
    }
    builder.build().unwrap()
}

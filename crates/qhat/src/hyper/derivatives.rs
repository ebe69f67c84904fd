//! Derivatives of a function f(x, t) of the positions of some particles and of time, from its values over hyper-dual
//! numbers.
//!
//! ```text
//! both directions (q̇, 1):       f, ḟ = f_a, and the second derivative where q̈ = 0: f_ab
//! two coordinates, or t:        ∂f/∂q and ∂f/∂t, two numbers a call
//! coordinates k and l:          ∂²f/∂q_k∂q_l = f_ab
//! ```

use super::Hyper;
use crate::linalg::block::{Block, zero};
use crate::point::Motion;
use crate::space::ParticleId;

/// The arguments of one call of f.
struct Arguments {
    /// z = 0 in two dimensions.
    x: Vec<[Hyper; 3]>,
    t: Hyper,
}

impl Arguments {
    /// The positions and the time of a motion, without derivatives.
    fn new<const D: usize>(particles: &[ParticleId], motion: Motion<'_, D>) -> Self {
        let place = |&id: &ParticleId| {
            let x = motion.x(id);
            std::array::from_fn(|k| if k < D { x[k].into() } else { Hyper::default() })
        };
        Arguments { x: particles.iter().map(place).collect(), t: motion.t.into() }
    }

    /// The c-th coordinate, D of each particle; t after the last coordinate.
    fn coordinate<const D: usize>(&mut self, c: usize) -> &mut Hyper {
        self.x.get_mut(c / D).map_or(&mut self.t, |place| &mut place[c % D])
    }

    fn of(&self, f: &impl Fn(&[[Hyper; 3]], Hyper) -> Hyper) -> Hyper {
        f(&self.x, self.t)
    }
}

/// f, ḟ and the second derivative of f by time where q̈ = 0.
pub(crate) fn jet<const D: usize>(
    f: impl Fn(&[[Hyper; 3]], Hyper) -> Hyper,
    particles: &[ParticleId],
    motion: Motion<'_, D>,
) -> [f64; 3] {
    let mut arguments = Arguments::new(particles, motion);
    for (place, &id) in arguments.x.iter_mut().zip(particles) {
        for (x, v) in place.iter_mut().zip(motion.v(id)) {
            (x.a, x.b) = (v, v);
        }
    }
    (arguments.t.a, arguments.t.b) = (1.0, 1.0);
    let f = arguments.of(&f);
    [f.value, f.a, f.ab]
}

/// ∂f/∂q, D numbers for each particle, and ∂f/∂t.
pub(crate) fn gradient<const D: usize>(
    f: impl Fn(&[[Hyper; 3]], Hyper) -> Hyper,
    particles: &[ParticleId],
    motion: Motion<'_, D>,
) -> (Vec<f64>, f64) {
    let mut arguments = Arguments::new(particles, motion);
    let count = D * particles.len();
    let (mut slopes, mut by_time) = (vec![0.0; count], 0.0);
    let mut keep = |c: usize, slope: f64| *slopes.get_mut(c).unwrap_or(&mut by_time) = slope;
    for c in (0..=count).step_by(2) {
        let pair = c..=(c + 1).min(count);
        arguments.coordinate::<D>(c).a = 1.0;
        arguments.coordinate::<D>(*pair.end()).b = 1.0;
        let f = arguments.of(&f);
        keep(c, f.a);
        keep(*pair.end(), f.b);
        arguments.coordinate::<D>(c).a = 0.0;
        arguments.coordinate::<D>(*pair.end()).b = 0.0;
    }
    (slopes, by_time)
}

/// Calls `visit(i, j, block)`, i ≤ j counting the particles, with ∂²f/∂x_i∂x_j.
pub(crate) fn hessian_blocks<const D: usize>(
    f: impl Fn(&[[Hyper; 3]], Hyper) -> Hyper,
    particles: &[ParticleId],
    motion: Motion<'_, D>,
    visit: &mut impl FnMut(usize, usize, Block<D>),
) {
    let mut arguments = Arguments::new(particles, motion);
    for i in 0..particles.len() {
        for j in i..particles.len() {
            let mut block: Block<D> = zero();
            for k in 0..D {
                // A block on the diagonal is symmetric: each pair once.
                for l in if i == j { k } else { 0 }..D {
                    arguments.x[i][k].a = 1.0;
                    arguments.x[j][l].b = 1.0;
                    block[k][l] = arguments.of(&f).ab;
                    arguments.x[i][k].a = 0.0;
                    arguments.x[j][l].b = 0.0;
                    if i == j {
                        block[l][k] = block[k][l];
                    }
                }
            }
            visit(i, j, block);
        }
    }
}

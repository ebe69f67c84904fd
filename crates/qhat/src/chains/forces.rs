//! W Q in lanes [m/s²]. Forces are evaluated in the user's order. Forces that are constant over a frame are evaluated
//! once for each frame, and the drag on all particles is one product in lanes.

use crate::force::{Acts, Dependence};
use crate::linalg::eight::{F8, LANES, Wide, vector_unit};
use crate::point::Motion;
use crate::structure::chains::{ChainPlan, ChainSlot};
use crate::system::System;
use pulp::{Simd, WithSimd};

/// The applied forces of one system over a frame.
#[derive(Clone, Debug)]
pub(super) struct Forces {
    /// W Q of the forces that are constant over a frame.
    constant: Vec<F8>,
    /// W Q of all forces.
    WQ: Vec<F8>,
    /// Viscous drag on every particle [N·s/m].
    drag: f64,
    /// The forces that depend on the motion: their indices in the system and the particles that they name.
    varying: Vec<usize>,
    named: Vec<(usize, Option<ChainSlot>)>,
    /// q, q̇ and Q in the user's order; within a frame only the entries of the named particles are kept up to date.
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    Q: Vec<f64>,
}

impl Forces {
    pub(super) fn new(system: &System, plan: &ChainPlan) -> Self {
        let coordinates = || vec![0.0; system.coordinate_count()];
        let lanes = || vec![F8::ZERO; plan.blocks() * system.dimension()];
        Forces {
            constant: lanes(),
            WQ: lanes(),
            drag: 0.0,
            varying: Vec::new(),
            named: Vec::new(),
            q: coordinates(),
            qd: coordinates(),
            Q: coordinates(),
        }
    }

    /// Evaluates the forces that are constant over the frame once, and lists the particles that the other forces depend
    /// on. The fields `q` and `qd` must hold the motion of the state.
    pub(super) fn begin<const D: usize>(&mut self, system: &System, plan: &ChainPlan, t: f64) {
        self.drag = 0.0;
        self.varying.clear();
        self.named.clear();
        self.Q.fill(0.0);
        for (number, force) in system.all_forces().enumerate() {
            match force.dependence() {
                Dependence::Nothing => {
                    force.add(Motion::<D> { q: &self.q, qd: &self.qd, t }, &system.mass, &mut self.Q);
                }
                Dependence::Drag(coefficient) => self.drag += coefficient,
                Dependence::Motion => {
                    self.varying.push(number);
                    let particles = force.particles().into_iter();
                    self.named.extend(particles.map(|particle| (particle.0, plan.home(particle.0))));
                }
            }
        }
        for place in plan.homes.iter().chain(&plan.copies) {
            let w = plan.w[place.block].0[place.lane];
            for c in 0..D {
                self.constant[place.block * D + c].0[place.lane] = w * self.Q[place.particle * D + c];
            }
        }
    }

    /// Writes W Q at a motion and returns the power of the forces without a potential [W].
    pub(super) fn apply<const D: usize>(
        &mut self,
        system: &System,
        plan: &ChainPlan,
        q: &[F8],
        qd: &[F8],
        t: f64,
    ) -> (&[F8], f64) {
        if self.drag == 0.0 && self.varying.is_empty() {
            return (&self.constant, 0.0);
        }
        let drag = Drag::<D> { plan, drag: self.drag, constant: &self.constant, qd, WQ: &mut self.WQ };
        let mut power = vector_unit().dispatch(drag);
        if !self.varying.is_empty() {
            power += self.apply_varying::<D>(system, plan, q, qd, t);
        }
        (&self.WQ, power)
    }

    fn apply_varying<const D: usize>(&mut self, system: &System, plan: &ChainPlan, q: &[F8], qd: &[F8], t: f64) -> f64 {
        for &(particle, home) in &self.named {
            for c in 0..D {
                if let Some(place) = home {
                    self.q[particle * D + c] = q[place.block * D + c].0[place.lane];
                    self.qd[particle * D + c] = qd[place.block * D + c].0[place.lane];
                }
                self.Q[particle * D + c] = 0.0;
            }
        }
        let motion = Motion::<D> { q: &self.q, qd: &self.qd, t };
        let mut power = 0.0;
        for &number in &self.varying {
            let force = system.numbered_force(number);
            force.add(motion, &system.mass, &mut self.Q);
            power += force.power(motion);
        }
        for &(particle, home) in &self.named {
            let Some(place) = home else { continue };
            for c in 0..D {
                // The entry is set to zero after it is read, because several forces may name the same particle.
                let force = std::mem::take(&mut self.Q[particle * D + c]);
                self.WQ[place.block * D + c].0[place.lane] += plan.w[place.block].0[place.lane] * force;
            }
        }
        // The first particle of a lane that continues another is the last particle of the lane before.
        for group in plan.groups.iter().filter(|group| group.is_coupled) {
            for c in 0..D {
                let tail = self.WQ[(group.first + group.rows) * D + c].shifted_up();
                let head = &mut self.WQ[group.first * D + c];
                for lane in (0..LANES).filter(|&lane| group.follows.0[lane] > 0.0) {
                    head.0[lane] = tail.0[lane];
                }
            }
        }
        power
    }
}

/// Writes W Q of the constant forces and of drag; returns the power of the drag.
struct Drag<'a, const D: usize> {
    plan: &'a ChainPlan,
    drag: f64,
    constant: &'a [F8],
    qd: &'a [F8],
    WQ: &'a mut [F8],
}

impl<const D: usize> WithSimd for Drag<'_, D> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let mut squares = Wide::splat(simd, 0.0);
        for (block, (w, counted)) in self.plan.w.iter().zip(&self.plan.counted).enumerate() {
            let (w, counted) = (Wide::load(simd, w), Wide::load(simd, counted));
            for k in block * D..(block + 1) * D {
                let v = Wide::load(simd, &self.qd[k]);
                (Wide::load(simd, &self.constant[k]) - self.drag * (w * v)).store(&mut self.WQ[k]);
                squares = squares + counted * (v * v);
            }
        }
        -self.drag * squares.stored().sum()
    }
}

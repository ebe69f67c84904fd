//! Readings of the present state: positions, tensions, reactions, and every symbol of the equation. A reading changes
//! no later result.

use super::Simulation;
use crate::constraint::Link;
use crate::force::{Acts, Force};
use crate::point::{Motion, Vector, block, dot, first, minus};
use crate::space::{ConstraintId, ParticleId, in_dimension};
use crate::terms::Terms;

impl Simulation {
    /// Every symbol of the equation, with the feedback that the integrator uses.
    pub fn terms(&mut self) -> Terms {
        let feedback = self.feedback_in_use();
        self.workspace.terms(&self.system, &self.state, &feedback)
    }

    /// The position of a particle \[m\]; z is 0 in two dimensions.
    ///
    /// # Panics
    /// If the id is that of another system and this one has no particle with its number.
    pub fn position(&self, particle: ParticleId) -> [f64; 3] {
        self.triple(self.state.positions(), particle)
    }

    /// The velocity of a particle [m/s]; z is 0 in two dimensions.
    ///
    /// # Panics
    /// As [`Simulation::position`].
    pub fn velocity(&self, particle: ParticleId) -> [f64; 3] {
        self.triple(self.state.velocities(), particle)
    }

    fn triple(&self, flat: &[f64], particle: ParticleId) -> [f64; 3] {
        let own = &flat[particle.0 * self.system.dimension()..][..self.system.dimension()];
        std::array::from_fn(|k| own.get(k).copied().unwrap_or(0.0))
    }

    /// The particle nearest to a point \[m\], fixed or not, if it is within a distance \[m\]: the particle under a
    /// cursor.
    pub fn nearest(&self, point: impl Into<Vector>, within: f64) -> Option<ParticleId> {
        let point = point.into().0;
        in_dimension!(self.system.dimension, D => {
            let away = |&particle: &ParticleId| {
                let apart = minus(block::<D>(&self.state.q, particle), first::<D>(&point));
                dot(apart, apart)
            };
            let nearest = self.system.particles().min_by(|a, b| away(a).total_cmp(&away(b)))?;
            (away(&nearest) <= within * within).then_some(nearest)
        })
    }

    /// The signed tension of every link ([`System::links`](crate::System::links): rods, ropes, struts), as applied
    /// \[N\]; positive where the link pulls its ends together.
    pub fn tension(&mut self) -> Vec<f64> {
        let feedback = self.feedback_in_use();
        self.workspace.tension(&self.system, &self.state, &feedback)
    }

    /// For each link whether its tension is unique. Redundant links could carry the load in other ways; their tension
    /// is the share of elastic rods in the limit of infinite stiffness.
    pub fn tension_is_unique(&mut self) -> Vec<bool> {
        self.tension();
        self.workspace.tension_is_unique(&self.system)
    }

    /// Every link with its signed tension \[N\].
    ///
    /// ```
    /// use qhat::{Dimension, Distance, Gravity, Particle, Settings, Simulation, System};
    /// # let mut builder = System::builder(Dimension::Two);
    /// # let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    /// # let load = builder.particle(Particle::at("load", [0.0, -1.0]).with_mass(5.0));
    /// # builder.constraint("wire", Distance::new(hook, load, 1.0));
    /// # builder.force(Gravity { acceleration: [0.0, -10.0, 0.0] });
    /// # let (system, state) = builder.build()?;
    /// # let mut simulation = Simulation::new(system, state, Settings::default())?;
    /// for (link, tension) in simulation.links() {
    ///     assert_eq!((link.name, tension.round()), ("wire", 50.0)); // a load of 5 kg under 10 m/s²
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn links(&mut self) -> impl Iterator<Item = (Link<'_>, f64)> {
        let tension = self.tension();
        self.system.links().zip(tension)
    }

    /// Records the largest tension or thrust of every frame from now on, or stops to. [`StepReport::max_tension`] then
    /// has it, over the ends of all substeps of the frame that were kept; jerks of ropes and impacts are impulses, not
    /// tensions, and do not count. It costs one more solution of the equation a substep, and changes no bit of the
    /// motion.
    ///
    /// [`StepReport::max_tension`]: crate::StepReport::max_tension
    pub fn record_tension(&mut self, is_recorded: bool) {
        self.workspace.watch_tension(&self.system, is_recorded);
    }

    /// The signed tension of one constraint \[N\], positive where it pulls its ends together; `None` if its kind is no
    /// link.
    ///
    /// # Panics
    /// If the id is that of another system and this one has no constraint with its number.
    pub fn tension_of(&mut self, constraint: ConstraintId) -> Option<f64> {
        let constraints = &self.system.constraints;
        constraints[constraint.0].constraint.as_link()?;
        let place = constraints[..constraint.0].iter().filter(|named| named.constraint.as_link().is_some()).count();
        self.tension().get(place).copied()
    }

    /// The multipliers of the rows of one constraint, as applied [J/C]: the constraint pushes each particle i with
    /// Σ λ ∂C/∂x_i. They are 0 while a row is inactive: a slack rope, an open contact, a broken rod.
    ///
    /// | kind | rows | λ is |
    /// |---|---|---|
    /// | [`Distance`](crate::Distance), [`OnSphere`](crate::OnSphere), driven or not | 1 | minus the tension \[N\] |
    /// | [`Limits`](crate::Limits) | longest, shortest | the tension \[N\], the thrust \[N\]; never negative |
    /// | [`Nail`](crate::Nail), [`Relation`](crate::Relation) | x, y, z | the force on the particle (of weight 1) \[N\] |
    /// | [`Obstacle`](crate::Obstacle) | normal, tangents | the push along the outward normal, the friction \[N\] |
    /// | [`OnLine`](crate::OnLine), [`OnPlane`](crate::OnPlane), [`OnCurve`](crate::OnCurve) | normals | the push across \[N\] |
    /// | [`OnCircle`](crate::OnCircle) | radius, axis | the push outwards, the push along the axis \[N\] |
    /// | [`OnEllipse`](crate::OnEllipse) | 1 | the push outwards over the size of its gradient, 1 on a circle \[N\] |
    /// | [`Angle`](crate::Angle), [`Gears`](crate::Gears) | 1 | the torque that turns the angle up [N·m] |
    /// | [`Area`](crate::Area), [`Volume`](crate::Volume) | 1 | the pressure inside [N/m], [N/m²] |
    /// | [`Direction`](crate::Direction) | normals | the push on the second particle across the line \[N\] |
    /// | [`Lengths`](crate::Lengths) | 1 | minus the tension of a segment of weight 1 \[N\] |
    /// | [`ExpressionConstraint`](crate::ExpressionConstraint), [`Custom`](crate::Custom) | 1 | in J/C, with C in its own unit |
    ///
    /// The squared forms of the classic formulation have C in m² and λ in N/m.
    ///
    /// # Panics
    /// If the id is that of another system and this one has no constraint with its number.
    pub fn reaction(&mut self, constraint: ConstraintId) -> Vec<f64> {
        let feedback = self.feedback_in_use();
        let rows = self.system.constraint_of(constraint).rows(self.system.dimension());
        let s = 1.0 - feedback.elasticity;
        in_dimension!(self.system.dimension, D => {
            let equation = self.workspace.solve::<D>(&self.system, &self.state, &feedback);
            // A row that gives way is a force, and no factor acts on it.
            let factor = |row: usize| if self.system.is_rigid(row) { s } else { 1.0 };
            rows.map(|row| factor(row) * equation.lambda[row]).collect()
        })
    }

    /// The force that a fixed particle passes on to the ground \[N\]; z is 0 in two dimensions. It is the sum of all
    /// constraint forces and applied forces on the particle, without gravity: the mass of a fixed particle plays no
    /// part in the motion. The ground pushes back with the opposite force. 0 for a particle that is not fixed.
    ///
    /// # Panics
    /// As [`Simulation::position`].
    pub fn support(&mut self, particle: ParticleId) -> [f64; 3] {
        if !self.system.is_fixed(particle) {
            return [0.0; 3];
        }
        let feedback = self.feedback_in_use();
        in_dimension!(self.system.dimension, D => {
            let motion = Motion::<D> { q: &self.state.q, qd: &self.state.qd, t: self.state.t };
            let mut force = vec![0.0; self.system.coordinate_count()];
            let acting = self.system.acting_forces(&self.state.modes.broken);
            for applied in acting.filter(|force| !matches!(force, Force::Gravity(_))) {
                applied.add(motion, &self.system.mass, &mut force);
            }
            let equation = self.workspace.solve::<D>(&self.system, &self.state, &feedback);
            let (applied, held) = (block::<D>(&force, particle), block::<D>(&equation.Q_hat, particle));
            std::array::from_fn(|k| if k < D { applied[k] + held[k] } else { 0.0 })
        })
    }
}

//! System: which particles, constraints and forces there are. What is connected to what never changes once it is built;
//! the numbers of forces and feedback may.

use crate::constraint::{Constraint, Distance, Formulation, Holds, Layout, Rows, Softness};
use crate::error::BuildError;
use crate::force::{Acts, Force};
use crate::lanes::Plan;
use crate::linalg::Component;
use crate::multiplier::{MatrixPlan, MatrixStructure};
use crate::point::{Motion, block, minus, norm};
use crate::settings::Feedback;
use crate::state::State;
use crate::switching::{Modes, Switches};
use std::collections::HashSet;

/// A factor that would take more is refused [bytes]: 16 GiB, above what computers that show such scenes have to spare.
const MEMORY_LIMIT: u64 = 16 << 30;

/// Number of space dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// The plane.
    Two,
    /// Space.
    Three,
}

impl Dimension {
    /// d as a number.
    pub fn number(self) -> usize {
        match self {
            Dimension::Two => 2,
            Dimension::Three => 3,
        }
    }
}

/// Runs a generic body with `$D` bound to the number of dimensions: the one place where d becomes a constant.
macro_rules! in_dimension {
    ($dimension:expr, $D:ident => $body:expr) => {
        match $dimension {
            $crate::system::Dimension::Two => {
                const $D: usize = 2;
                $body
            }
            $crate::system::Dimension::Three => {
                const $D: usize = 3;
                $body
            }
        }
    };
}
pub(crate) use in_dimension;

/// The number of a particle: its place in the order they were added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ParticleId(pub usize);

/// A point mass, as it is handed to the builder.
#[derive(Clone, Debug, PartialEq)]
pub struct Particle {
    /// Its name, unique in the system.
    pub name: String,
    /// x [m], d numbers.
    pub position: Vec<f64>,
    /// v [m/s], d numbers.
    pub velocity: Vec<f64>,
    /// m [kg], positive.
    pub mass: f64,
    /// Whether it is held where it is (W = 0).
    pub fixed: bool,
}

impl Particle {
    /// A particle of 1 kg at rest at x [m].
    pub fn at(name: impl Into<String>, position: impl Into<Vec<f64>>) -> Self {
        let position = position.into();
        Particle { name: name.into(), velocity: vec![0.0; position.len()], position, mass: 1.0, fixed: false }
    }

    /// The same with another mass [kg].
    pub fn with_mass(self, mass: f64) -> Self {
        Particle { mass, ..self }
    }

    /// The same with a velocity [m/s].
    pub fn with_velocity(self, velocity: impl Into<Vec<f64>>) -> Self {
        Particle { velocity: velocity.into(), ..self }
    }

    /// The same, held where it is.
    pub fn held(self) -> Self {
        Particle { fixed: true, ..self }
    }
}

/// A constraint with its name and its place among the rows.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedConstraint {
    /// Its name, for reports.
    pub name: String,
    /// The constraint.
    pub constraint: Constraint,
    /// Its first row in C, λ and J.
    pub first_row: usize,
}

/// A distance constraint, as faces draw and report it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod<'a> {
    /// Its name.
    pub name: &'a str,
    /// One end.
    pub a: ParticleId,
    /// The other end.
    pub b: ParticleId,
    /// r [m].
    pub length: f64,
    /// Its row in C, λ and J.
    pub row: usize,
}

/// Particles, constraints and forces; see [`System::builder`].
#[derive(Clone, Debug)]
pub struct System {
    pub(crate) dimension: Dimension,
    pub(crate) particle_names: Vec<String>,
    pub(crate) mass: Vec<f64>,
    pub(crate) inverse_mass: Vec<f64>,
    pub(crate) constraints: Vec<NamedConstraint>,
    pub(crate) row_names: Vec<String>,
    pub(crate) row_scale: Vec<f64>,
    pub(crate) softness: Vec<Softness>,
    pub(crate) layout: Layout,
    pub(crate) matrix: MatrixStructure,
    /// Where its chains lie in lanes, if it has nothing else.
    pub(crate) plan: Option<Plan>,
    pub(crate) forces: Vec<Force>,
    /// Constraints that give way, as forces.
    pub(crate) compliant: Vec<Force>,
    pub(crate) feedback: Feedback,
    pub(crate) extent: f64,
    /// Its contacts, and what may break.
    pub(crate) switches: Switches,
}

impl System {
    /// Starts a system of d dimensions.
    pub fn builder(dimension: Dimension) -> SystemBuilder {
        SystemBuilder {
            dimension,
            particles: Vec::new(),
            constraints: Vec::new(),
            forces: Vec::new(),
            feedback: Feedback::NONE,
        }
    }

    /// d, 2 or 3.
    pub fn dimension(&self) -> usize {
        self.dimension.number()
    }

    /// n.
    pub fn particle_count(&self) -> usize {
        self.mass.len()
    }

    /// N = d·n.
    pub fn coordinate_count(&self) -> usize {
        self.dimension() * self.particle_count()
    }

    /// m, the number of scalar constraint rows.
    pub fn row_count(&self) -> usize {
        self.row_names.len()
    }

    /// Names of the particles, n.
    pub fn particle_names(&self) -> &[String] {
        &self.particle_names
    }

    /// Names of the rows, m: the constraint's name, with its component where it has several rows.
    pub fn row_names(&self) -> &[String] {
        &self.row_names
    }

    /// The |C| that counts as a relative error of one, for each row [C]: r for a rod.
    pub fn row_scales(&self) -> &[f64] {
        &self.row_scale
    }

    /// m_i [kg], n.
    pub fn masses(&self) -> &[f64] {
        &self.mass
    }

    /// W as one number a particle [1/kg], n; 0 for a fixed particle.
    pub fn inverse_masses(&self) -> &[f64] {
        &self.inverse_mass
    }

    /// Whether a particle is held where it is.
    pub fn is_fixed(&self, particle: ParticleId) -> bool {
        self.inverse_mass[particle.0] == 0.0
    }

    /// The constraints, in the order they were added.
    pub fn constraints(&self) -> &[NamedConstraint] {
        &self.constraints
    }

    /// The distance constraints, in the order they were added: `tension` has one number for each.
    pub fn rods(&self) -> impl Iterator<Item = Rod<'_>> {
        self.constraints.iter().filter_map(|named| {
            let distance = named.constraint.as_rod()?;
            let Distance { a, b, length, .. } = *distance;
            Some(Rod { name: &named.name, a, b, length, row: named.first_row })
        })
    }

    /// The parts of A = J W Jᵀ that are coupled with no other: how each hangs together, how it is factored and what that costs.
    ///
    /// ```
    /// use qhat::{Dimension, Distance, Kind, Method, Particle, System};
    /// let mut builder = System::builder(Dimension::Two);
    /// let ends = [0.0, 1.0, 2.0].map(|x| builder.particle(Particle::at(format!("{x}"), [x, 0.0])));
    /// builder.constraint("left", Distance::new(ends[0], ends[1], 1.0)).constraint("right", Distance::new(ends[1], ends[2], 1.0));
    /// let (system, _) = builder.build()?;
    /// let [chain] = system.components() else { panic!("one chain") };
    /// assert_eq!((chain.kind, chain.rows, chain.method, chain.entries), (Kind::Path, 2, Method::Dense, 3));
    /// # Ok::<(), qhat::BuildError>(())
    /// ```
    pub fn components(&self) -> &[Component] {
        &self.matrix.components
    }

    /// Whether a row is held at C = 0; a row that gives way (a rod with a compliance) is not.
    pub fn is_rigid(&self, row: usize) -> bool {
        self.softness[row].is_rigid()
    }

    /// The applied forces, in the order they were added.
    pub fn forces(&self) -> &[Force] {
        &self.forces
    }

    /// ks, kd, diagonal drag and elasticity.
    pub fn feedback(&self) -> &Feedback {
        &self.feedback
    }

    /// A length typical of the system [m]: the mean rod, else the size of the whole at the start, else 1.
    pub fn extent(&self) -> f64 {
        self.extent
    }

    /// The same system with every constraint in the forms of a formulation.
    pub fn with_formulation(&self, formulation: Formulation) -> System {
        let constraints = self.constraints.iter();
        let constraints = constraints.map(|named| (named.name.clone(), named.constraint.formulated(formulation)));
        let mut system = self.clone();
        system.set_constraints(constraints.collect());
        system.matrix = MatrixStructure::new(&system.layout, &system.inverse_mass, system.plan_matrix());
        system
    }

    /// The mass [kg] of all particles that hang together with one through constraints.
    pub(crate) fn connected_mass(&self, particle: ParticleId) -> f64 {
        let mut neighbours = vec![Vec::new(); self.particle_count()];
        for row in 0..self.row_count() {
            let particles = &self.layout.particle[self.layout.start[row]..self.layout.start[row + 1]];
            for pair in particles.windows(2) {
                neighbours[pair[0].0].push(pair[1].0);
                neighbours[pair[1].0].push(pair[0].0);
            }
        }
        let mut reached = vec![false; self.particle_count()];
        let mut frontier = vec![particle.0];
        let mut mass = 0.0;
        while let Some(i) = frontier.pop() {
            // What is fixed carries no pull on to others.
            if i < reached.len() && !reached[i] && self.inverse_mass[i] > 0.0 {
                reached[i] = true;
                mass += self.mass[i];
                frontier.extend(&neighbours[i]);
            }
        }
        mass
    }

    pub(crate) fn empty_rows(&self) -> Rows {
        Rows::new(self.layout.clone(), self.dimension(), self.particle_count())
    }

    /// Q without the constraints that give way, for methods that solve their rows.
    pub(crate) fn add_applied_forces<const D: usize>(&self, motion: Motion<'_, D>, Q: &mut [f64]) {
        Q.fill(0.0);
        for force in &self.forces {
            force.add(motion, &self.mass, Q);
        }
    }

    /// Q = Σ of every force, those of constraints that give way among them.
    pub(crate) fn add_forces<const D: usize>(&self, motion: Motion<'_, D>, Q: &mut [f64]) {
        self.add_applied_forces(motion, Q);
        for force in &self.compliant {
            force.add(motion, &self.mass, Q);
        }
    }

    /// Every force, those of constraints that give way among them.
    pub(crate) fn all_forces(&self) -> impl Iterator<Item = &Force> {
        self.forces.iter().chain(&self.compliant)
    }

    /// One of them by its place among them.
    pub(crate) fn force(&self, number: usize) -> &Force {
        self.forces.get(number).unwrap_or_else(|| &self.compliant[number - self.forces.len()])
    }

    /// Writes the constraints and all that follows from what they connect.
    fn set_constraints(&mut self, constraints: Vec<(String, Constraint)>) {
        let dimension = self.dimension();
        self.constraints.clear();
        self.row_names.clear();
        self.row_scale.clear();
        self.softness.clear();
        self.compliant.clear();
        for (name, constraint) in constraints {
            let first_row = self.row_names.len();
            match constraint.row_count(dimension) {
                1 => self.row_names.push(name.clone()),
                rows if constraint.is_vector() => {
                    self.row_names.extend(["x", "y", "z"][..rows].iter().map(|axis| format!("{name}.{axis}")));
                }
                rows => self.row_names.extend((0..rows).map(|k| format!("{name}[{k}]"))),
            }
            self.row_scale.resize(self.row_names.len(), constraint.scale(self.extent));
            self.softness.resize(self.row_names.len(), constraint.softness());
            self.compliant.extend(constraint.as_force());
            self.constraints.push(NamedConstraint { name, constraint, first_row });
        }
        self.layout = Layout::new(self.constraints.iter().map(|named| &named.constraint), dimension);
        self.switches = Switches::new(&self.constraints, self.row_names.len(), dimension);
        self.plan = Plan::new(self);
    }

    fn plan_matrix(&self) -> MatrixPlan {
        MatrixPlan::new(&self.layout, &self.inverse_mass, &self.softness, self.dimension())
    }
}

/// Collects particles, constraints and forces and checks them in [`SystemBuilder::build`].
#[derive(Clone, Debug)]
pub struct SystemBuilder {
    dimension: Dimension,
    particles: Vec<Particle>,
    constraints: Vec<(String, Constraint)>,
    forces: Vec<Force>,
    feedback: Feedback,
}

impl SystemBuilder {
    /// Adds a particle; its id is its place.
    pub fn particle(&mut self, particle: Particle) -> ParticleId {
        self.particles.push(particle);
        ParticleId(self.particles.len() - 1)
    }

    /// m [kg] of a particle that was added.
    ///
    /// # Panics
    /// Where there is none with this id.
    pub fn mass(&self, particle: ParticleId) -> f64 {
        self.particles[particle.0].mass
    }

    /// The name of a particle that was added.
    ///
    /// # Panics
    /// Where there is none with this id.
    pub fn name(&self, particle: ParticleId) -> &str {
        &self.particles[particle.0].name
    }

    /// Adds a constraint under a name that reports will use.
    pub fn constraint(&mut self, name: impl Into<String>, constraint: impl Into<Constraint>) -> &mut Self {
        self.constraints.push((name.into(), constraint.into()));
        self
    }

    /// Adds a force.
    pub fn force(&mut self, force: impl Into<Force>) -> &mut Self {
        self.forces.push(force.into());
        self
    }

    /// Sets ks, kd, diagonal drag and elasticity (all off by default).
    pub fn feedback(&mut self, feedback: Feedback) -> &mut Self {
        self.feedback = feedback;
        self
    }

    /// The system and the state it starts from.
    ///
    /// # Errors
    /// A name used twice, a number that is not finite or not allowed, a particle of the wrong dimension or that does not
    /// exist, a fixed particle that moves, so many constraints so closely connected that their factor would not fit.
    pub fn build(self) -> Result<(System, State), BuildError> {
        self.check()?;
        let q: Vec<f64> = self.particles.iter().flat_map(|particle| particle.position.iter().copied()).collect();
        let qd: Vec<f64> = self.particles.iter().flat_map(|particle| particle.velocity.iter().copied()).collect();
        let extent = in_dimension!(self.dimension, D => extent::<D>(&self.constraints, &q));
        let mut system = System {
            dimension: self.dimension,
            mass: self.particles.iter().map(|particle| particle.mass).collect(),
            inverse_mass: self.particles.iter().map(|p| if p.fixed { 0.0 } else { 1.0 / p.mass }).collect(),
            particle_names: self.particles.into_iter().map(|particle| particle.name).collect(),
            constraints: Vec::new(),
            row_names: Vec::new(),
            row_scale: Vec::new(),
            softness: Vec::new(),
            layout: Layout::default(),
            matrix: MatrixStructure::default(),
            plan: None,
            forces: self.forces,
            compliant: Vec::new(),
            feedback: self.feedback,
            extent,
            switches: Switches::default(),
        };
        system.set_constraints(self.constraints);
        let plan = system.plan_matrix();
        if plan.memory() > MEMORY_LIMIT {
            return Err(BuildError::TooLarge { memory: plan.memory(), limit: MEMORY_LIMIT });
        }
        system.matrix = MatrixStructure::new(&system.layout, &system.inverse_mass, plan);
        let state = State { modes: Modes::at_first(&system.switches), ..State::new(q, qd) };
        Ok((system, state))
    }

    fn check(&self) -> Result<(), BuildError> {
        let mut names = HashSet::new();
        for particle in &self.particles {
            let wrong = |message: String| BuildError::Particle { name: particle.name.clone(), message };
            if !names.insert(&particle.name) {
                return Err(wrong("the name is used twice".into()));
            }
            let d = self.dimension.number();
            if particle.position.len() != d || particle.velocity.len() != d {
                return Err(wrong(format!("position and velocity must have {d} components")));
            }
            if !particle.position.iter().chain(&particle.velocity).all(|x| x.is_finite()) {
                return Err(wrong("position and velocity must be finite numbers".into()));
            }
            if !(particle.mass.is_finite() && particle.mass > 0.0 && (1.0 / particle.mass).is_finite()) {
                return Err(wrong(format!("the mass must be positive and finite, but is {:?} kg", particle.mass)));
            }
            if particle.fixed && particle.velocity.iter().any(|&v| v != 0.0) {
                return Err(wrong("a fixed particle cannot have a velocity".into()));
            }
        }
        let exists = |ids: Vec<ParticleId>| match ids.into_iter().find(|id| id.0 >= self.particles.len()) {
            Some(id) => Err(format!("there is no particle number {}", id.0)),
            None => Ok(()),
        };
        let fits = |wanted: Option<usize>| match wanted.filter(|d| *d != self.dimension.number()) {
            Some(d) => Err(format!("it is written for {d} dimensions, but the system has {}", self.dimension.number())),
            None => Ok(()),
        };
        for (name, constraint) in &self.constraints {
            let outcome = exists(constraint.particles()).and_then(|()| constraint.fits(self.dimension.number()));
            let outcome = outcome.and_then(|()| constraint.check());
            outcome.map_err(|message| BuildError::Constraint { name: name.clone(), message })?;
        }
        for (index, force) in self.forces.iter().enumerate() {
            let outcome = exists(force.particles()).and_then(|()| fits(force.dimension()));
            let outcome = outcome.and_then(|()| force.check());
            outcome.map_err(|message| BuildError::Force { index, message })?;
        }
        self.feedback.check()?;
        Ok(())
    }
}

/// The mean rod length, else the diagonal of the box around all particles, else 1 [m].
fn extent<const D: usize>(constraints: &[(String, Constraint)], q: &[f64]) -> f64 {
    let lengths = constraints.iter().filter_map(|(_, constraint)| Some(constraint.as_rod()?.length));
    let (sum, count) = lengths.fold((0.0, 0.0), |(sum, count), length| (sum + length, count + 1.0));
    if count > 0.0 {
        return sum / count;
    }
    let mut low = [f64::INFINITY; D];
    let mut high = [f64::NEG_INFINITY; D];
    for i in 0..q.len() / D {
        let x = block::<D>(q, ParticleId(i));
        low = std::array::from_fn(|k| low[k].min(x[k]));
        high = std::array::from_fn(|k| high[k].max(x[k]));
    }
    let diagonal = norm(minus(high, low));
    if diagonal.is_finite() && diagonal > 0.0 { diagonal } else { 1.0 }
}

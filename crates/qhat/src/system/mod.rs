//! System: its particles, constraints and forces. Constraints keep the particles that they connect from `build` on, so
//! that the structure of A is found once. A simulation may change forces and feedback.

mod builder;
mod error;
mod lookup;
mod parameters;
mod particle;
mod second_order;

pub use builder::SystemBuilder;
pub(crate) use builder::check_force;
use builder::extent;
pub use error::{BuildError, ParticleError};
pub use parameters::{BindError, Parameter, ParameterUse, Quantity, Refused};
pub use particle::Particle;

use crate::constraint::{Constraint, Formulation, Holds, Layout, Link, NamedConstraint, OnCurve, Rows, Softness};
use crate::force::{Acts, Force};
use crate::linalg::Component;
use crate::point::Motion;
use crate::settings::Feedback;
use crate::space::{ConstraintId, Dimension, ParticleId};
use crate::state::State;
use crate::structure::{ChainPlan, Contacts, FlatClique, MatrixPlan, MatrixStructure};
use parameters::Parameters;

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
    /// The plan of its open chains, if the system consists of nothing else.
    pub(crate) chains: Option<ChainPlan>,
    pub(crate) forces: Vec<Force>,
    /// The names of the forces that the builder was given; forces that a simulation adds later have no place here.
    pub(crate) force_names: Vec<Option<String>>,
    /// Constraints that give way, as forces.
    compliant: Vec<Compliant>,
    pub(crate) feedback: Feedback,
    pub(crate) extent: f64,
    parameters: Parameters,
    /// q [m] and q̇ [m/s] at the start, as the builder was given them or as they follow from the parameters.
    start_q: Vec<f64>,
    start_qd: Vec<f64>,
    /// The contacts and the breakable constraints.
    pub(crate) contacts: Contacts,
    /// The cliques whose joints rods hold only to second order, as a simulation finds them at its start.
    pub(crate) second_order: Vec<FlatClique>,
    /// The rods of these cliques, ascending.
    second_order_rods: Vec<ConstraintId>,
    /// Those of them whose lengths follow from the other rows, ascending.
    following_rods: Vec<ConstraintId>,
    /// The rows of those, ascending.
    following: Vec<u32>,
    /// The number of constraints that the user gave; those behind them hold cliques, and are not shown.
    given: usize,
    /// The constraints whose gradient may jump, by their places.
    pub(crate) jumpy: Vec<usize>,
    /// The beads on curves, by their places among the constraints.
    pub(crate) bead_places: Vec<usize>,
}

/// A constraint that gives way, as the force that stands for it.
#[derive(Clone, Debug)]
struct Compliant {
    force: Force,
    /// Its index among the breakable constraints, if it is breakable.
    breakable: Option<usize>,
}

impl System {
    /// Starts a system of d dimensions.
    pub fn builder(dimension: Dimension) -> SystemBuilder {
        SystemBuilder::new(dimension)
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
        self.constraints.get(self.given).map_or(self.all_row_count(), |hidden| hidden.first_row)
    }

    /// The number of rows, with those that hold joints which rods hold only to second order.
    pub(crate) fn all_row_count(&self) -> usize {
        self.row_names.len()
    }

    /// Names of the particles, n.
    pub fn particle_names(&self) -> &[String] {
        &self.particle_names
    }

    /// Names of the rows, m: the constraint's name, with its component where it has several rows.
    pub fn row_names(&self) -> &[String] {
        &self.row_names[..self.row_count()]
    }

    /// The |C| that counts as a relative error of one, for each row \[C\]: r for a rod.
    pub fn row_scales(&self) -> &[f64] {
        &self.row_scale[..self.row_count()]
    }

    /// m_i \[kg\], n.
    pub fn masses(&self) -> &[f64] {
        &self.mass
    }

    /// W as one number a particle [1/kg], n; 0 for a fixed particle.
    pub fn inverse_masses(&self) -> &[f64] {
        &self.inverse_mass
    }

    /// Whether a particle is fixed.
    ///
    /// # Panics
    /// If the id is that of another system and this one has no particle with its number.
    pub fn is_fixed(&self, particle: ParticleId) -> bool {
        self.inverse_mass[particle.0] == 0.0
    }

    /// The constraints, in the order of addition.
    pub fn constraints(&self) -> &[NamedConstraint] {
        &self.constraints[..self.given]
    }

    /// The links: constraints that act along the line of two particles (rods, ropes, struts), in the order of addition.
    /// [`Simulation::tension`](crate::Simulation::tension) has one number for each.
    pub fn links(&self) -> impl Iterator<Item = Link<'_>> {
        self.constraints
            .iter()
            .filter_map(|named| Some(named.constraint.as_link()?.link(&named.name, named.rows(self.dimension()))))
    }

    /// The broken links, by their places among [`System::links`].
    pub fn broken_links(&self, state: &State) -> Vec<usize> {
        // Breakables, like links, are in the order of constraints, so that their rows ascend.
        let breakables = self.contacts.breakables.iter().zip(&state.modes.broken);
        let broken: Vec<usize> =
            breakables.filter(|&(_, &broken)| broken).map(|(breakable, _)| breakable.rows.start).collect();
        let links = self.links().enumerate();
        links.filter(|(_, link)| broken.binary_search(&link.rows.start).is_ok()).map(|(place, _)| place).collect()
    }

    /// The parts of A = J W Jᵀ that are coupled with no other part: for each its shape, the method that factors it and
    /// the cost.
    ///
    /// ```
    /// use qhat::{ComponentKind, Dimension, Distance, FactorMethod, Particle, System};
    /// let mut builder = System::builder(Dimension::Two);
    /// let ends = [0.0, 1.0, 2.0].map(|x| builder.particle(Particle::at(format!("{x}"), [x, 0.0])));
    /// builder.constraint("left", Distance::new(ends[0], ends[1], 1.0));
    /// builder.constraint("right", Distance::new(ends[1], ends[2], 1.0));
    /// let (system, _) = builder.build()?;
    /// let [chain] = system.components() else { panic!("one chain") };
    /// assert_eq!((chain.kind, chain.method), (ComponentKind::Path, FactorMethod::Dense));
    /// assert_eq!((chain.rows, chain.entries), (2, 3));
    /// # Ok::<(), qhat::BuildError>(())
    /// ```
    pub fn components(&self) -> &[Component] {
        &self.matrix.components
    }

    /// Whether a row is held at C = 0; a row that gives way (a rod with a compliance) is not.
    pub fn is_rigid(&self, row: usize) -> bool {
        self.softness[row].is_rigid()
    }

    /// The applied forces, in the order of addition.
    pub fn forces(&self) -> &[Force] {
        &self.forces
    }

    /// ks, kd, diagonal drag and elasticity.
    pub fn feedback(&self) -> &Feedback {
        &self.feedback
    }

    /// A length typical of the system \[m\]: the mean length of its rods, else its size at the start, else 1.
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
        for row in 0..self.all_row_count() {
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
            // A fixed particle passes no pull on to others.
            if i < reached.len() && !reached[i] && self.inverse_mass[i] > 0.0 {
                reached[i] = true;
                mass += self.mass[i];
                frontier.extend(&neighbours[i]);
            }
        }
        mass
    }

    /// The beads on curves, each with its first row.
    pub(crate) fn beads(&self) -> Vec<(usize, &OnCurve)> {
        let beads = self.bead_places.iter().map(|&place| &self.constraints[place]);
        let beads = beads.filter_map(|named| match &named.constraint {
            Constraint::OnCurve(bead) => Some((named.first_row, bead)),
            _ => None,
        });
        beads.collect()
    }

    /// Moves the feet of beads in some rows on to a motion that was kept, and writes them to those of a state.
    pub(crate) fn follow_feet<const D: usize>(&self, rows: &mut Rows, motion: Motion<'_, D>, feet: &mut Vec<f64>) {
        if !self.bead_places.is_empty() {
            rows.feet.follow(&self.beads(), motion);
            feet.clear();
            feet.extend_from_slice(rows.feet.parameters());
        }
    }

    pub(crate) fn empty_rows(&self) -> Rows {
        Rows::new(self.layout.clone(), self.dimension(), self.particle_count())
    }

    /// The name of the first particle that can move, or of the first.
    pub(crate) fn first_moving(&self) -> String {
        let particles = self.particle_names.iter().zip(&self.inverse_mass);
        let moving = particles.clone().find(|&(_, &w)| w > 0.0).or(particles.clone().next());
        moving.map(|(name, _)| name.clone()).unwrap_or_default()
    }

    /// The rows evaluated at a state.
    pub(crate) fn rows_at<const D: usize>(&self, state: &State) -> Rows {
        let mut rows = self.empty_rows();
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        rows.feet.place(&self.beads(), motion, &state.feet);
        self.evaluate_rows(motion, &mut rows);
        rows
    }

    /// C, Ċ, γ, C_t and J of every row at one motion.
    #[inline]
    pub(crate) fn evaluate_rows<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut Rows) {
        rows.evaluate(self.constraints.iter().map(|named| &named.constraint), motion);
    }

    /// Q without the constraints that give way, for methods that solve their rows.
    pub(crate) fn add_applied_forces<const D: usize>(&self, motion: Motion<'_, D>, Q: &mut [f64]) {
        Q.fill(0.0);
        for force in &self.forces {
            force.add(motion, &self.mass, Q);
        }
    }

    /// Q, the sum of all forces that act, with those of constraints that give way and are not broken; `broken` as in
    /// [`System::acting_forces`].
    pub(crate) fn add_forces<const D: usize>(&self, motion: Motion<'_, D>, broken: &[bool], Q: &mut [f64]) {
        Q.fill(0.0);
        for force in self.acting_forces(broken) {
            force.add(motion, &self.mass, Q);
        }
    }

    /// All forces, with those of constraints that give way, whether they are broken or not.
    pub(crate) fn all_forces(&self) -> impl Iterator<Item = &Force> {
        self.forces.iter().chain(self.compliant.iter().map(|compliant| &compliant.force))
    }

    /// The forces that act, with those of constraints that give way and are not broken. `broken` says of each breakable
    /// constraint whether it is broken; none is if the list is empty.
    pub(crate) fn acting_forces<'a>(&'a self, broken: &'a [bool]) -> impl Iterator<Item = &'a Force> {
        let is_broken = |breakable: usize| broken.get(breakable).is_some_and(|&broken| broken);
        let whole = self.compliant.iter().filter(move |compliant| !compliant.breakable.is_some_and(is_broken));
        self.forces.iter().chain(whole.map(|compliant| &compliant.force))
    }

    /// The force that stands for a breakable constraint that gives way.
    pub(crate) fn breakable_force(&self, breakable: usize) -> Option<&Force> {
        let compliant = self.compliant.iter().find(|compliant| compliant.breakable == Some(breakable));
        compliant.map(|compliant| &compliant.force)
    }

    /// A force by its place in `all_forces`.
    pub(crate) fn numbered_force(&self, number: usize) -> &Force {
        self.forces.get(number).unwrap_or_else(|| &self.compliant[number - self.forces.len()].force)
    }

    /// Writes the constraints, of which those from `given` on hold cliques, their rows, and the structure that follows
    /// from them.
    fn set_constraints(&mut self, constraints: Vec<(String, Constraint)>) {
        let dimension = self.dimension();
        self.constraints.clear();
        self.row_names.clear();
        self.row_scale.clear();
        self.softness.clear();
        for (name, constraint) in constraints {
            let first_row = self.row_names.len();
            match constraint.row_count(dimension) {
                1 => self.row_names.push(name.clone()),
                rows if self.constraints.len() >= self.given => {
                    self.row_names.extend(std::iter::repeat_n(name.clone(), rows));
                }
                rows if constraint.is_vector() => {
                    self.row_names.extend(["x", "y", "z"][..rows].iter().map(|axis| format!("{name}.{axis}")));
                }
                rows => self.row_names.extend((0..rows).map(|k| format!("{name}[{k}]"))),
            }
            self.row_scale.resize(self.row_names.len(), constraint.scale(self.extent));
            self.softness.resize(self.row_names.len(), constraint.softness());
            self.constraints.push(NamedConstraint { name, constraint, first_row });
        }
        self.layout = Layout::new(self.constraints.iter().map(|named| &named.constraint), dimension);
        self.following = self.following_rods.iter().map(|id| self.constraints[id.0].first_row as u32).collect();
        self.contacts = Contacts::new(&self.constraints, dimension);
        let constraints = self.constraints.iter().enumerate();
        let breakables = &self.contacts.breakables;
        let compliant = constraints.clone().filter_map(|(place, named)| {
            let breakable = breakables.binary_search_by_key(&place, |breakable| breakable.constraint).ok();
            Some(Compliant { force: named.constraint.as_force()?, breakable })
        });
        self.compliant = compliant.collect();
        self.jumpy =
            constraints.clone().filter(|(_, named)| named.constraint.may_jump()).map(|(place, _)| place).collect();
        let beads = constraints.filter(|(_, named)| matches!(named.constraint, Constraint::OnCurve(_)));
        self.bead_places = beads.map(|(place, _)| place).collect();
        self.chains = ChainPlan::new(&self.constraints, &self.inverse_mass);
    }

    fn plan_matrix(&self) -> MatrixPlan {
        MatrixPlan::new(&self.layout, &self.inverse_mass, &self.softness, self.dimension())
    }
}

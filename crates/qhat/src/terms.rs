//! Terms: every symbol of one evaluation of the equation, in the order in which they are computed. The glass box.

use crate::constraint::Jacobian;
use crate::integrate::Workspace;
use crate::linalg::SymmetricMatrix;
use crate::multiplier::Equation;
use crate::report::Warning;
use crate::settings::Feedback;
use crate::space::in_dimension;
use crate::state::State;
use crate::system::System;

/// Every symbol of one evaluation. n particles in d dimensions, N = d·n, m rows, SI units; [`NOTATION`] lists them.
///
/// Where rods hold joints only to second order, rows of the engine's own take part in the equation and are not among
/// the m. Q̂ and q̈ contain their forces, which Jᵀλ and A λ lack.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Terms {
    /// t \[s\].
    pub time: f64,
    /// q, N \[m\].
    pub positions: Vec<f64>,
    /// q̇, N [m/s].
    pub velocities: Vec<f64>,
    /// W, one number a particle, n [1/kg].
    pub inverse_masses: Vec<f64>,
    /// Q, those of rods that give way included, N \[N\].
    pub applied_forces: Vec<f64>,
    /// C, m \[C\].
    pub residual: Vec<f64>,
    /// Ċ, m [C/s].
    pub residual_rate: Vec<f64>,
    /// J, m × N [C/m].
    pub jacobian: Jacobian,
    /// γ = J̇q̇, m [C/s²].
    pub acceleration_bias: Vec<f64>,
    /// A = J W Jᵀ, m × m, without ε [C²/(m² kg)].
    pub constraint_matrix: SymmetricMatrix,
    /// −γ, m [C/s²].
    pub rhs_bias: Vec<f64>,
    /// −J W Q, m [C/s²].
    pub rhs_forces: Vec<f64>,
    /// −ks C, m [C/s²].
    pub rhs_stiffness: Vec<f64>,
    /// −kd Ċ, m [C/s²].
    pub rhs_damping: Vec<f64>,
    /// b, the sum of the four, m [C/s²].
    pub right_hand_side: Vec<f64>,
    /// λ, m [J/C]; in the tangential rows of a sliding contact −μ λ_n d, d the direction of the slip.
    pub multipliers: Vec<f64>,
    /// Q̂ = s Jᵀλ over the rigid rows, as applied, friction included, N \[N\].
    pub constraint_forces: Vec<f64>,
    /// q̈ = W (Q + Q̂), N [m/s²].
    pub accelerations: Vec<f64>,
    /// Signed tension of every link ([`System::links`]: rods, ropes, struts), as applied \[N\]; positive if it pulls
    /// its ends together.
    pub tension: Vec<f64>,
    /// For each link whether its tension is unique: whether no other tensions do the same. A tension that is not unique
    /// is the share of elastic rods in the limit of infinite stiffness.
    pub tension_is_unique: Vec<bool>,
    /// For each row whether its multiplier is unique, m.
    pub multiplier_is_unique: Vec<bool>,
    /// Whether a row is inactive: of an open contact, of friction unless the contact sticks, of a broken constraint; m.
    pub is_open: Vec<bool>,
    /// Rank of A; where rods hold joints only to second order, that of the rows that hold them. `None` where A is
    /// singular and too large for the rank to be counted.
    pub rank: Option<usize>,
    /// The warnings of this solve.
    pub warnings: Vec<Warning>,
}

/// One row of the notation table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Notation {
    /// The symbol in derivations.
    pub symbol: &'static str,
    /// The letters in equation files.
    pub letters: &'static str,
    /// The word in the API: the field of [`Terms`].
    pub word: &'static str,
    /// Its shape.
    pub shape: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The file of the engine that computes it.
    pub file: &'static str,
}

const fn row(
    symbol: &'static str,
    letters: &'static str,
    word: &'static str,
    shape: &'static str,
    unit: &'static str,
    file: &'static str,
) -> Notation {
    Notation { symbol, letters, word, shape, unit, file }
}

/// The symbols of [`Terms`], in the order of its fields.
pub const NOTATION: [Notation; 23] = [
    row("t", "t", "time", "1", "s", "state.rs"),
    row("q", "q", "positions", "N", "m", "state.rs"),
    row("q̇", "qd", "velocities", "N", "m/s", "state.rs"),
    row("W", "W", "inverse_masses", "n", "1/kg", "system/mod.rs"),
    row("Q", "Q", "applied_forces", "N", "N", "force/mod.rs"),
    row("C", "C", "residual", "m", "[C]", "constraint/rows.rs"),
    row("Ċ", "Cd", "residual_rate", "m", "[C]/s", "constraint/rows.rs"),
    row("J", "J", "jacobian", "m × N", "[C]/m", "constraint/rows.rs"),
    row("γ", "gamma", "acceleration_bias", "m", "[C]/s²", "constraint/rows.rs"),
    row("A", "A", "constraint_matrix", "m × m", "[C]²/(m² kg)", "multiplier/matrix.rs"),
    row("−γ", "bias", "rhs_bias", "m", "[C]/s²", "multiplier/rhs.rs"),
    row("−J W Q", "forces", "rhs_forces", "m", "[C]/s²", "multiplier/rhs.rs"),
    row("−ks C", "stiffness", "rhs_stiffness", "m", "[C]/s²", "multiplier/rhs.rs"),
    row("−kd Ċ", "damping", "rhs_damping", "m", "[C]/s²", "multiplier/rhs.rs"),
    row("b", "b", "right_hand_side", "m", "[C]/s²", "multiplier/rhs.rs"),
    row("λ", "lambda", "multipliers", "m", "J/[C]", "multiplier/factor.rs"),
    row("Q̂", "Q_hat", "constraint_forces", "N", "N", "multiplier/reaction.rs"),
    row("q̈", "qdd", "accelerations", "N", "m/s²", "multiplier/reaction.rs"),
    row("T", "tension", "tension", "links", "N", "constraint/link.rs"),
    row("T unique", "is_unique", "tension_is_unique", "links", "1", "multiplier/share/mod.rs"),
    row("λ unique", "is_unique", "multiplier_is_unique", "m", "1", "multiplier/share/mod.rs"),
    row("λ off", "off", "is_open", "m", "1", "modes.rs"),
    row("rank A", "rank", "rank", "1", "1", "multiplier/factor.rs"),
];

/// Evaluates the equation at a state, with the system's own feedback.
///
/// ```
/// use qhat::{Dimension, Gravity, Nail, Particle, System, evaluate};
/// let mut builder = System::builder(Dimension::Two);
/// let bob = builder.particle(Particle::at("bob", [0.0, 0.0]).with_mass(3.0));
/// builder.with_constraint("nail", Nail::new(bob, [0.0; 3])).force(Gravity { acceleration: [0.0, -10.0, 0.0] });
/// let (system, state) = builder.build()?;
/// let reaction = evaluate(&system, &state).multipliers; // the nail carries m g, to roundoff
/// assert!(reaction[0] == 0.0 && (reaction[1] - 30.0).abs() < 1e-13);
/// # Ok::<(), qhat::BuildError>(())
/// ```
pub fn evaluate(system: &System, state: &State) -> Terms {
    Workspace::new(system).terms(system, state, &system.feedback)
}

impl Workspace {
    /// Every symbol at a state. Integrators that project see the bare equation: their feedback is none.
    pub(crate) fn terms(&mut self, system: &System, state: &State, feedback: &Feedback) -> Terms {
        self.follow(system);
        let tension = self.tension(system, state, feedback);
        let terms = collect(system, state, self.equation(), tension);
        let links = self.tension_is_unique(system);
        let rows = self.multiplier_is_unique()[..system.row_count()].to_vec();
        Terms { tension_is_unique: links, multiplier_is_unique: rows, ..terms }
    }
}

/// The symbols of an equation that was solved at a state, with the tensions that belong to it. Rows behind those that
/// the user gave are left out.
fn collect(system: &System, state: &State, equation: &Equation, tension: Vec<f64>) -> Terms {
    let (rank, m) = (Some(equation.solver.rank(&system.matrix)), system.row_count());
    let given = |all: &[f64]| all[..m].to_vec();
    let warnings = equation.warnings(system);
    let jacobian = equation.rows.J.first_rows(m);
    let constraint_matrix =
        in_dimension!(system.dimension, D => system.matrix.in_given_order::<D>(&jacobian, &system.inverse_mass));
    let is_open = (0..m).map(|row| equation.is_inactive(row)).collect();
    Terms {
        time: state.t,
        positions: state.q.clone(),
        velocities: state.qd.clone(),
        inverse_masses: system.inverse_mass.clone(),
        applied_forces: equation.Q.clone(),
        residual: given(&equation.rows.C),
        residual_rate: given(&equation.rows.Cd),
        jacobian,
        acceleration_bias: given(&equation.rows.gamma),
        constraint_matrix,
        rhs_bias: given(&equation.b.bias),
        rhs_forces: given(&equation.b.forces),
        rhs_stiffness: given(&equation.b.stiffness),
        rhs_damping: given(&equation.b.damping),
        right_hand_side: given(&equation.b.sum),
        multipliers: given(&equation.lambda),
        constraint_forces: equation.Q_hat.clone(),
        accelerations: equation.qdd.clone(),
        tension,
        tension_is_unique: Vec::new(),
        multiplier_is_unique: Vec::new(),
        is_open,
        rank,
        warnings,
    }
}

//! Expressions: C(q, t), a component of a force, a potential or a function of time as text, with exact derivatives.
//!
//! ```
//! use qhat::{Dimension, Expression, Particle, Purpose, Scope, System};
//!
//! let bob = System::builder(Dimension::Two).particle(Particle::at("bob", [1.0, 0.0]));
//! let particle = |name: &str| (name == "bob").then_some(bob);
//! let scope = Scope::new(Purpose::Constraint, Dimension::Two, &particle);
//! let circle = Expression::parse("bob.x^2 + bob.y^2 - (1 + sin(3*t)/10)^2", &scope)?;
//!
//! let mut J = [0.0; 2];
//! let (C, _) = circle.jet_and_gradient(&[0.6, 0.8], &[0.8, -0.6], 0.0, &mut J);
//! assert!(C.value.abs() < 1e-15);
//! assert_eq!(J, [1.2, 1.6]);
//! # Ok::<(), qhat::ExpressionError>(())
//! ```
//!
//! Stages of a text: tokens → tree (operator precedence) → tape (names resolved, points in components, constants
//! folded, equal parts shared) → passes over the tape.
//!
//! Text may come from anyone. Each stage limits the size of its input before it begins, and no stage recurses deeper
//! than [`MAX_DEPTH`] brackets allow. Evaluation cannot fail; it may give inf or NaN, which the caller reports.
//! `docs/method/expressions.md` has the language.

mod error;
mod evaluate;
mod functions;
mod lower;
mod names;
mod operation;
mod scope;
mod syntax;
mod tape;
mod token;

pub use error::{ExpressionError, ParameterError};
pub use evaluate::Jet;
pub use scope::{Purpose, Scope, check_parameter};

use crate::linalg::block::Block;
use crate::point::Motion;
use crate::space::{Dimension, ParticleId};
pub(crate) use operation::Operation;

use evaluate::{At, with_room};
use std::fmt;
use std::sync::Arc;
use tape::{Input, Tape};

/// The largest text \[bytes\].
pub const MAX_BYTES: usize = 4096;
/// The largest number of numbers, names and operations, as written.
pub const MAX_NODES: usize = 512;
/// The largest number of different names of particles and parameters.
pub const MAX_NAMES: usize = 64;
/// The length of the longest gradient: d = 3 numbers for each particle.
pub(crate) const LONGEST_GRADIENT: usize = 3 * MAX_NAMES;
/// The largest number of brackets, signs and powers open at once, which is the depth of the recursion. Unoptimised,
/// 64 with a summand and a factor before each bracket overflowed a stack of 512 kB, and 32 fit; a page has 1 MB.
pub const MAX_DEPTH: usize = 32;
/// The largest number of scalar operations, after points are taken apart in components. 512 nodes of volumes could
/// grow to many more; this number takes 64 kB of stack.
pub const MAX_INSTRUCTIONS: usize = 2048;
/// The largest integer exponent whose power is a product, of at most 20 factors.
pub(crate) const MAX_PRODUCT: f64 = 1024.0;

/// A parsed expression: a number that depends on positions, velocities and time. Clones share it.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    parsed: Arc<Parsed>,
}

#[derive(Debug, PartialEq)]
struct Parsed {
    text: String,
    dimension: usize,
    tape: Tape,
}

impl Expression {
    /// Parses a text with the names of a scope.
    ///
    /// # Errors
    /// With the place in the text: no expression, a name or type that is not allowed there, too large.
    pub fn parse(text: &str, scope: &Scope<'_>) -> Result<Self, ExpressionError> {
        if text.len() > MAX_BYTES {
            let message = format!("the expression has {} bytes; at most {MAX_BYTES} are allowed", text.len());
            return Err(
                ExpressionError::new(0..text.len(), message).with_help("split it into several constraints or forces")
            );
        }
        let tokens = token::tokens(text)?;
        let tree = syntax::tree(text, &tokens)?;
        let tape = lower::tape(text, tree, scope)?;
        Ok(Expression { parsed: Arc::new(Parsed { text: text.into(), dimension: scope.dimension.number(), tape }) })
    }

    /// A number that depends on parameters alone, by their names; `suggest` as in [`Scope`]. [`Expression::value`]
    /// takes the values of the parameters, in their order, in the place of positions.
    ///
    /// ```
    /// use qhat::Expression;
    /// let area = Expression::of_parameters("pi*r^2/4", &["h", "r"], &|_, _| None)?;
    /// assert_eq!(area.value(&[7.0, 2.0], &[], 0.0), std::f64::consts::PI);
    /// # Ok::<(), qhat::ExpressionError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Expression::parse`].
    pub fn of_parameters(
        text: &str,
        names: &[&str],
        suggest: &dyn Fn(&str, &[&'static str]) -> Option<String>,
    ) -> Result<Self, ExpressionError> {
        let place = |name: &str| names.iter().position(|known| *known == name).map(ParticleId);
        let scope = Scope { suggest, ..Scope::new(Purpose::Parameters, Dimension::Two, &place) };
        Expression::parse(text, &scope)
    }

    /// Whether an expression of parameters depends on the parameter at a place.
    pub(crate) fn reads(&self, parameter: usize) -> bool {
        self.tape().instructions.contains(&tape::Instruction::Position(parameter))
    }

    /// Whether the value is the same for all arguments.
    pub fn is_constant(&self) -> bool {
        let tape = self.tape();
        tape.time.is_none() && tape.positions.is_empty() && tape.velocities.is_empty()
    }

    /// The text it was parsed from.
    pub fn text(&self) -> &str {
        &self.parsed.text
    }

    /// The particles that the expression depends on, each once, in the order of first use. The blocks of a gradient
    /// have the same order.
    pub fn particles(&self) -> &[ParticleId] {
        &self.tape().particles
    }

    /// The length of a gradient: d numbers for each particle of the expression.
    pub fn gradient_len(&self) -> usize {
        self.parsed.dimension * self.tape().particles.len()
    }

    /// Whether the expression depends on t.
    pub fn uses_time(&self) -> bool {
        self.tape().time.is_some()
    }

    /// Whether the expression depends on velocities.
    pub fn uses_velocities(&self) -> bool {
        !self.tape().velocities.is_empty()
    }

    /// The cost of one evaluation: its scalar operations and inputs.
    pub fn instruction_count(&self) -> usize {
        self.tape().instructions.len()
    }

    /// The value at q \[m\], q̇ [m/s] (flat, d numbers a particle of the system) and t \[s\]. q̇ may be empty if no
    /// velocity is used.
    pub fn value(&self, q: &[f64], qd: &[f64], t: f64) -> f64 {
        self.run(|tape, room| tape.values(At { q, qd, t }, room))
    }

    /// C, Ċ and γ: value and derivatives along (q + τ q̇, t + τ). A function of time alone takes empty q and q̇.
    pub fn jet(&self, q: &[f64], qd: &[f64], t: f64) -> Jet {
        self.run(|tape, room| tape.jets(At { q, qd, t }, room))
    }

    /// The same, and C_t [C/s]. J [C/m] is written to `gradient`, d numbers for each particle of the expression.
    ///
    /// # Panics
    /// Where `gradient` is shorter than [`Expression::gradient_len`].
    pub fn jet_and_gradient(&self, q: &[f64], qd: &[f64], t: f64, gradient: &mut [f64]) -> (Jet, f64) {
        self.run(|tape, room| {
            let jet = tape.jets(At { q, qd, t }, room);
            tape.adjoints(room);
            self.write(&tape.positions, room, gradient);
            (jet, tape.time_slope(room))
        })
    }

    /// The value. Its derivatives by positions and by velocities are written, d numbers for each particle of the
    /// expression. `by_velocity` may be empty if no velocity is used.
    ///
    /// # Panics
    /// If an array of derivatives is shorter than [`Expression::gradient_len`].
    pub fn gradient(&self, q: &[f64], qd: &[f64], t: f64, by_position: &mut [f64], by_velocity: &mut [f64]) -> f64 {
        self.run(|tape, room| {
            let value = tape.values(At { q, qd, t }, room);
            tape.adjoints(room);
            self.write(&tape.positions, room, by_position);
            if self.uses_velocities() {
                self.write(&tape.velocities, room, by_velocity);
            }
            value
        })
    }

    /// Writes ∂²C/∂x² [C/m²], n × n with n = [`Expression::gradient_len`], symmetric.
    ///
    /// # Panics
    /// Where `hessian` is shorter.
    pub fn hessian(&self, q: &[f64], qd: &[f64], t: f64, hessian: &mut [f64]) {
        self.run(|tape, room| tape.hessian(At { q, qd, t }, room, self.gradient_len(), hessian));
    }

    /// Calls `visit(i, j, block)`, i ≤ j counting its particles, with each block of ∂²C/∂x² [C/m²] that is not zero.
    pub(crate) fn hessian_blocks<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(usize, usize, Block<D>),
    ) {
        let Motion { q, qd, t } = motion;
        self.run(|tape, room| tape.hessian_blocks(At { q, qd, t }, room, visit));
    }

    /// The number of dimensions of the scope.
    pub(crate) fn dimension(&self) -> usize {
        self.parsed.dimension
    }

    fn write(&self, inputs: &[Input], room: &[evaluate::Numbers], gradient: &mut [f64]) {
        gradient[..self.gradient_len()].fill(0.0);
        for input in inputs {
            gradient[input.place] = room[input.slot][evaluate::ADJOINT];
        }
    }

    fn run<R>(&self, body: impl FnOnce(&Tape, &mut [evaluate::Numbers]) -> R) -> R {
        with_room(self.instruction_count(), |room| body(self.tape(), room))
    }

    fn tape(&self) -> &Tape {
        &self.parsed.tape
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}

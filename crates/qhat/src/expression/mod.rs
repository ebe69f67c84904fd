//! Expressions: C(q, t), a component of a force, a potential or a function of time, written as text, with exact derivatives.
//!
//! ```
//! use qhat::{Dimension, Expression, ParticleId, Purpose, Scope};
//!
//! let particle = |name: &str| (name == "bob").then_some(ParticleId(0));
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
//! The way of a text: tokens → tree (operator precedence) → tape (names resolved, points in components, constants folded, equal
//! parts shared) → passes over the tape. Text may come from anyone: its size is limited before each stage begins, no stage recurses
//! deeper than [`MAX_DEPTH`] brackets allow, and evaluation cannot fail; it may give inf or nan, which the caller reports.
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
use crate::space::ParticleId;
use evaluate::{At, with_room};
use std::fmt;
use std::sync::Arc;
use tape::{Input, Tape};

/// Bytes of text.
pub const MAX_BYTES: usize = 4096;
/// Numbers, names and operations, as written.
pub const MAX_NODES: usize = 512;
/// Different names of particles and parameters.
pub const MAX_NAMES: usize = 64;
/// Numbers of the longest gradient: d = 3 of each particle.
pub(crate) const LONGEST_GRADIENT: usize = 3 * MAX_NAMES;
/// Brackets, signs and powers open at once. Parsing recurses so deep: unoptimised, 64 with a summand and a factor before each bracket
/// overflowed a stack of 512 kB and 32 fit; a page has 1 MB.
pub const MAX_DEPTH: usize = 32;
/// Scalar operations after points are taken apart: what 512 nodes of volumes could grow to is cut here, at 64 kB of stack.
pub const MAX_INSTRUCTIONS: usize = 2048;
/// Up to this integer exponent a power is a product, of at most 20 factors.
const MAX_PRODUCT: f64 = 1024.0;

/// A parsed expression: a number that depends on positions, velocities and time. Cloning shares it.
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
    /// Parses a text whose names the scope knows.
    ///
    /// # Errors
    /// With the place in the text, where it is no expression, uses a name or type it may not, or is too large.
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

    /// The text it was parsed from.
    pub fn text(&self) -> &str {
        &self.parsed.text
    }

    /// The particles it depends on, each once, in the order of first use: the order of the blocks of a gradient.
    pub fn particles(&self) -> &[ParticleId] {
        &self.tape().particles
    }

    /// Length of a gradient: d numbers for each of its particles.
    pub fn gradient_len(&self) -> usize {
        self.parsed.dimension * self.tape().particles.len()
    }

    /// Whether it depends on t.
    pub fn uses_time(&self) -> bool {
        self.tape().time.is_some()
    }

    /// Whether it depends on velocities.
    pub fn uses_velocities(&self) -> bool {
        !self.tape().velocities.is_empty()
    }

    /// Scalar operations and inputs of one evaluation: what it costs.
    pub fn instruction_count(&self) -> usize {
        self.tape().instructions.len()
    }

    /// Its value at q [m], q̇ [m/s], flat, d numbers a particle of the system, and t [s]. q̇ may be empty where it is not used.
    pub fn value(&self, q: &[f64], qd: &[f64], t: f64) -> f64 {
        self.run(|tape, room| tape.values(At { q, qd, t }, room))
    }

    /// C, Ċ and γ: value and derivatives along (q + τ q̇, t + τ). A function of time alone takes empty q and q̇.
    pub fn jet(&self, q: &[f64], qd: &[f64], t: f64) -> Jet {
        self.run(|tape, room| tape.jets(At { q, qd, t }, room))
    }

    /// The same, with J [C/m] written to `gradient`, d numbers for each of its particles, and C_t [C/s] returned.
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

    /// Its value, with its derivatives by positions and by velocities written, d numbers for each of its particles. `by_velocity` may be
    /// empty where no velocity is used.
    ///
    /// # Panics
    /// Where one of them is shorter than [`Expression::gradient_len`].
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

    /// Calls `visit(i, j, block)`, i ≤ j counting its particles, with the blocks of ∂²C/∂x² [C/m²]; not where one is zero.
    pub(crate) fn hessian_blocks<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(usize, usize, Block<D>),
    ) {
        let Motion { q, qd, t } = motion;
        self.run(|tape, room| tape.hessian_blocks(At { q, qd, t }, room, visit));
    }

    /// d of the scope it was parsed in.
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

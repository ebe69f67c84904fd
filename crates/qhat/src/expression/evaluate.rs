//! Passes over the tape. f stands for one instruction with operands a and b, f_a … for its partial derivatives.
//!
//! Value: f(a, b), from the first instruction to the last.
//!
//! Jet: along the curve (q + τ q̇, t + τ) a coordinate is (q, q̇, 0) and time (t, 1, 0); then, by the chain rule,
//!
//! ```text
//! f' = f_a a' + f_b b'
//! f" = f_a a" + f_b b" + f_aa a'² + 2 f_ab a' b' + f_bb b'²
//! ```
//!
//! and the last instruction holds C, Ċ = J q̇ + C_t and γ = (∂(Jq̇)/∂q) q̇ + 2 J_t q̇ + C_tt: C̈ where q̈ = 0.
//!
//! Gradient: the adjoint f̄ = ∂C/∂f is 1 at the last instruction; from there back to the first,
//!
//! ```text
//! ā += f̄ f_a,   b̄ += f̄ f_b
//! ```
//!
//! so one pass gives J and C_t, whatever the number of coordinates.
//!
//! Hessian: with a', b' along one coordinate x_j and f̄' the change of f̄ along it,
//!
//! ```text
//! ā' += f̄' f_a + f̄ (f_aa a' + f_ab b'),   b̄' += f̄' f_b + f̄ (f_ab a' + f_bb b')
//! ```
//!
//! leaves column j of ∂²C/∂x² in the adjoints' changes of the coordinates.
//!
//! The jet keeps velocities constant, as the definition of γ does, and a gradient by velocities is a pass of its own.
//! An adjoint of zero is not passed on, so that an inactive branch of least and greatest may have infinite
//! derivatives.
//!
//! Nothing is allocated: the numbers of a tape lie on the stack, in the smallest of three sizes that holds them.
//!
//! Source: A. Griewank, A. Walther, Evaluating Derivatives (2008), chapters 3, 5 and 10.

use super::operation::Operation;
use super::tape::Instruction::*;
use super::tape::{Input, Tape};
use super::{MAX_INSTRUCTIONS, MAX_NAMES};
use crate::linalg::block::{Block, zero};

/// Value and derivatives along the curve (q + τ q̇, t + τ), at τ = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// C.
    pub value: f64,
    /// Ċ = J q̇ + C_t.
    pub first: f64,
    /// γ: the second derivative where q̈ = 0.
    pub second: f64,
}

/// The motion at which an expression is evaluated.
#[derive(Clone, Copy, Debug)]
pub(super) struct At<'a> {
    pub(super) q: &'a [f64],
    /// Empty where everything is at rest.
    pub(super) qd: &'a [f64],
    pub(super) t: f64,
}

impl At<'_> {
    /// The rate of one coordinate.
    #[inline(always)]
    fn rate(&self, i: usize) -> f64 {
        if self.qd.is_empty() { 0.0 } else { self.qd[i] }
    }
}

/// The numbers of one instruction: its value, two of its derivatives, and its adjoint. Of a Hessian: the value, the
/// change of the value, the change of the adjoint, and the adjoint.
pub(super) type Numbers = [f64; 4];

pub(super) const ADJOINT: usize = 3;
/// Of a Hessian.
const ADJOINT_CHANGE: usize = 2;

/// Runs `body` with room for `count` instructions.
pub(super) fn with_room<R>(count: usize, body: impl FnOnce(&mut [Numbers]) -> R) -> R {
    // A rod takes 13 instructions and a volume 37. Clearing room for the largest expression would slow all others.
    match count {
        0..=32 => on_stack::<32, R>(count, body),
        33..=256 => on_stack::<256, R>(count, body),
        _ => on_stack::<MAX_INSTRUCTIONS, R>(count, body),
    }
}

/// A stack frame of its own, so that a small expression does not take the stack of a large one.
#[inline(never)]
fn on_stack<const N: usize, R>(count: usize, body: impl FnOnce(&mut [Numbers]) -> R) -> R {
    body(&mut [[0.0; 4]; N][..count])
}

impl Tape {
    /// The value of every instruction; returns that of the last.
    pub(super) fn values(&self, at: At<'_>, room: &mut [Numbers]) -> f64 {
        let mut v = 0.0;
        for (k, instruction) in self.instructions.iter().enumerate() {
            v = match *instruction {
                Constant(bits) => f64::from_bits(bits),
                Position(i) => at.q[i],
                Velocity(i) => at.rate(i),
                Time => at.t,
                Apply(operation, a, b) => operation.value(room[usize::from(a)][0], room[usize::from(b)][0]),
            };
            room[k][0] = v;
        }
        v
    }

    /// The jet of every instruction; returns that of the last.
    pub(super) fn jets(&self, at: At<'_>, room: &mut [Numbers]) -> Jet {
        let mut jet = Jet::default();
        for (k, instruction) in self.instructions.iter().enumerate() {
            jet = match *instruction {
                Constant(bits) => Jet { value: f64::from_bits(bits), first: 0.0, second: 0.0 },
                Position(i) => Jet { value: at.q[i], first: at.rate(i), second: 0.0 },
                Velocity(i) => Jet { value: at.rate(i), first: 0.0, second: 0.0 },
                Time => Jet { value: at.t, first: 1.0, second: 0.0 },
                Apply(operation, a, b) => {
                    let [a, a1, a2, _] = room[usize::from(a)];
                    let [b, b1, b2, _] = room[usize::from(b)];
                    let value = operation.value(a, b);
                    let [first, second] = match operation {
                        Operation::Least | Operation::Greatest if operation.takes_first(a, b) => [a1, a2],
                        Operation::Least | Operation::Greatest => [b1, b2],
                        _ => {
                            let slopes = operation.first(a, b, value);
                            let [f_a, f_b] = slopes;
                            let [f_aa, f_ab, f_bb] = operation.second(a, b, value, slopes);
                            if operation.is_binary() {
                                let bends = f_aa * a1 * a1 + 2.0 * f_ab * a1 * b1 + f_bb * b1 * b1;
                                [f_a * a1 + f_b * b1, f_a * a2 + f_b * b2 + bends]
                            } else {
                                [f_a * a1, f_a * a2 + f_aa * a1 * a1]
                            }
                        }
                    };
                    Jet { value, first, second }
                }
            };
            room[k][..3].copy_from_slice(&[jet.value, jet.first, jet.second]);
        }
        jet
    }

    /// The adjoint of every instruction, from its values.
    pub(super) fn adjoints(&self, room: &mut [Numbers]) {
        let last = room.len() - 1;
        room[last][ADJOINT] = 1.0;
        for k in (0..=last).rev() {
            let (value, adjoint) = (room[k][0], room[k][ADJOINT]);
            if let (Apply(operation, a, b), true) = (self.instructions[k], adjoint != 0.0) {
                let (a, b) = (usize::from(a), usize::from(b));
                let [f_a, f_b] = operation.first(room[a][0], room[b][0], value);
                if f_a != 0.0 {
                    room[a][ADJOINT] += adjoint * f_a;
                }
                if f_b != 0.0 {
                    room[b][ADJOINT] += adjoint * f_b;
                }
            }
        }
    }

    /// ∂C/∂t, from the adjoints.
    pub(super) fn time_slope(&self, room: &[Numbers]) -> f64 {
        self.time.map_or(0.0, |slot| room[usize::from(slot)][ADJOINT])
    }

    /// Writes ∂²C/∂x², n × n, of the n coordinates of its particles.
    pub(super) fn hessian(&self, at: At<'_>, room: &mut [Numbers], n: usize, H: &mut [f64]) {
        H[..n * n].fill(0.0);
        self.values(at, room);
        self.adjoints(room);
        for j in &self.positions {
            self.column(room, j);
            // Each pair once: the two agree but for roundoff, and H is symmetric to the bit.
            for i in self.positions.iter().filter(|i| i.place <= j.place) {
                let entry = room[i.slot][ADJOINT_CHANGE];
                H[i.place * n + j.place] = entry;
                H[j.place * n + i.place] = entry;
            }
        }
    }

    /// Calls `visit(i, j, block)`, i ≤ j, with each block of ∂²C/∂x² between its particles that is not zero.
    pub(super) fn hessian_blocks<const D: usize>(
        &self,
        at: At<'_>,
        room: &mut [Numbers],
        visit: &mut impl FnMut(usize, usize, Block<D>),
    ) {
        self.values(at, room);
        self.adjoints(room);
        let mut above = [zero::<D>(); MAX_NAMES];
        for (j, _) in self.particles.iter().enumerate() {
            above[..=j].fill(zero());
            for column in self.positions.iter().filter(|input| input.place / D == j) {
                self.column(room, column);
                for row in self.positions.iter().filter(|input| input.place <= column.place) {
                    let (entry, k, l) = (room[row.slot][ADJOINT_CHANGE], row.place % D, column.place % D);
                    above[row.place / D][k][l] = entry;
                    if row.place / D == j {
                        above[j][l][k] = entry;
                    }
                }
            }
            for (i, block) in above[..=j].iter().enumerate().filter(|(_, block)| **block != zero()) {
                visit(i, j, *block);
            }
        }
    }

    /// The changes of values and adjoints along coordinate j.
    fn column(&self, room: &mut [Numbers], j: &Input) {
        for (k, instruction) in self.instructions.iter().enumerate() {
            let change = match *instruction {
                Apply(operation, a, b) => {
                    let ([a, a1, ..], [b, b1, ..]) = (room[usize::from(a)], room[usize::from(b)]);
                    let [f_a, f_b] = operation.first(a, b, room[k][0]);
                    product(f_a, a1) + product(f_b, b1)
                }
                _ => f64::from(u8::from(k == j.slot)),
            };
            room[k][1] = change;
            room[k][ADJOINT_CHANGE] = 0.0;
        }
        for k in (0..room.len()).rev() {
            let [value, _, adjoint_change, adjoint] = room[k];
            if let Apply(operation, a, b) = self.instructions[k] {
                let (a, b) = (usize::from(a), usize::from(b));
                let ([x, x1, ..], [y, y1, ..]) = (room[a], room[b]);
                let slopes = operation.first(x, y, value);
                let [f_a, f_b] = slopes;
                let [f_aa, f_ab, f_bb] = operation.second(x, y, value, slopes);
                let along_a = product(f_aa, x1) + product(f_ab, y1);
                let along_b = product(f_ab, x1) + product(f_bb, y1);
                room[a][ADJOINT_CHANGE] += product(f_a, adjoint_change) + product(adjoint, along_a);
                room[b][ADJOINT_CHANGE] += product(f_b, adjoint_change) + product(adjoint, along_b);
            }
        }
    }
}

/// x y, and 0 where one factor is 0: a part that does not depend on a coordinate stays independent where the other
/// factor is infinite.
#[inline(always)]
fn product(x: f64, y: f64) -> f64 {
    if x == 0.0 || y == 0.0 { 0.0 } else { x * y }
}

//! Tape: the scalar instructions of an expression, each after its operands. Equal instructions are stored once, and
//! an instruction on constants alone is a constant.

use super::MAX_INSTRUCTIONS;
use super::operation::Operation::{self, *};
use crate::space::ParticleId;
use std::collections::BTreeMap;

/// The place of an instruction on the tape.
pub(super) type Slot = u16;

/// One scalar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Instruction {
    /// The bits of a number.
    Constant(u64),
    /// q[k].
    Position(usize),
    /// q̇[k].
    Velocity(usize),
    /// t.
    Time,
    /// f(a, b).
    Apply(Operation, Slot, Slot),
}

use Instruction::*;

/// The reason for which an instruction was not appended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Refusal {
    /// The tape is full.
    TooMany,
    /// The instruction is a constant and not finite.
    NotFinite,
}

/// A tape while it grows.
#[derive(Debug, Default)]
pub(super) struct Builder {
    instructions: Vec<Instruction>,
    places: BTreeMap<Instruction, Slot>,
}

impl Builder {
    /// The slot of this instruction.
    pub(super) fn push(&mut self, instruction: Instruction) -> Result<Slot, Refusal> {
        if let Some(slot) = self.places.get(&instruction) {
            return Ok(*slot);
        }
        if self.instructions.len() == MAX_INSTRUCTIONS {
            return Err(Refusal::TooMany);
        }
        let slot = self.instructions.len() as Slot;
        self.instructions.push(instruction);
        self.places.insert(instruction, slot);
        Ok(slot)
    }

    pub(super) fn constant(&mut self, value: f64) -> Result<Slot, Refusal> {
        if value.is_finite() { self.push(Constant(value.to_bits())) } else { Err(Refusal::NotFinite) }
    }

    /// The number that a slot holds, if it is a constant.
    pub(super) fn known(&self, slot: Slot) -> Option<f64> {
        match self.instructions[usize::from(slot)] {
            Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// f(a).
    pub(super) fn unary(&mut self, operation: Operation, a: Slot) -> Result<Slot, Refusal> {
        self.binary(operation, a, a)
    }

    /// f(a, b).
    pub(super) fn binary(&mut self, operation: Operation, a: Slot, b: Slot) -> Result<Slot, Refusal> {
        if let (Some(a), Some(b)) = (self.known(a), self.known(b)) {
            return self.constant(operation.value(a, b));
        }
        if operation == Divide && self.known(b) == Some(0.0) {
            return Err(Refusal::NotFinite);
        }
        let (a, b) = if operation.commutes() && b < a { (b, a) } else { (a, b) };
        self.push(Apply(operation, a, b))
    }

    /// The instructions that `root` needs.
    pub(super) fn finish(self, root: Slot, dimension: usize) -> Tape {
        let root = usize::from(root);
        let mut needed = vec![false; root + 1];
        needed[root] = true;
        for k in (0..=root).rev() {
            if let (true, Apply(_, a, b)) = (needed[k], self.instructions[k]) {
                needed[usize::from(a)] = true;
                needed[usize::from(b)] = true;
            }
        }
        let mut moved = vec![0; root + 1];
        let mut tape = Tape::default();
        for k in (0..=root).filter(|k| needed[*k]) {
            moved[k] = tape.instructions.len() as Slot;
            tape.append(
                match self.instructions[k] {
                    Apply(operation, a, b) => Apply(operation, moved[usize::from(a)], moved[usize::from(b)]),
                    leaf => leaf,
                },
                dimension,
            );
        }
        tape
    }
}

/// The finished tape; its last instruction is the expression.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Tape {
    pub(super) instructions: Vec<Instruction>,
    /// The particles that the expression depends on, in the order of first use.
    pub(super) particles: Vec<ParticleId>,
    /// The slots that positions are written to.
    pub(super) positions: Vec<Input>,
    /// The slots that velocities are written to.
    pub(super) velocities: Vec<Input>,
    /// The slot that t is written to.
    pub(super) time: Option<Slot>,
}

/// A coordinate that the tape reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Input {
    pub(super) slot: usize,
    /// Its place in a gradient: d numbers for each of `particles`.
    pub(super) place: usize,
}

impl Tape {
    fn append(&mut self, instruction: Instruction, dimension: usize) {
        let slot = self.instructions.len();
        self.instructions.push(instruction);
        match instruction {
            Position(k) | Velocity(k) => {
                let particle = ParticleId(k / dimension);
                let number = self.particles.iter().position(|known| *known == particle).unwrap_or_else(|| {
                    self.particles.push(particle);
                    self.particles.len() - 1
                });
                let input = Input { slot, place: number * dimension + k % dimension };
                if matches!(instruction, Position(_)) {
                    self.positions.push(input)
                } else {
                    self.velocities.push(input)
                }
            }
            Time => self.time = Some(slot as Slot),
            Constant(_) | Apply(..) => {}
        }
    }
}

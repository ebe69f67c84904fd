//! Saved: states and simulations as bytes that another process, on any target, goes on from with the same bits.
//!
//! ```text
//! "qhat" · kind, 4 bytes · version, u32 · four fingerprints of the system, u64 each · content · checksum, u64
//! ```
//!
//! Numbers are little-endian. The content is in the format postcard, which keeps every bit of a float. A fingerprint
//! is a hash (FNV-1a, 64 bits) of the particles, the constraints, the forces or the feedback with all their numbers;
//! the checksum is the same hash of all bytes before it. Hash and checksum find mistakes and damage. They are no
//! protection against bytes that were made to deceive.

use crate::state::State;
use crate::system::System;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::{self, Write};
use thiserror::Error;

const MAGIC: &[u8; 4] = b"qhat";

/// The version of the format. Any change of the types that are saved makes a new one.
const VERSION: u32 = 2;

/// The parts of a system that have a fingerprint each.
const PARTS: [&str; 4] = ["particles", "constraints", "forces", "feedback"];

/// The length of everything before the content [bytes].
const HEAD: usize = 4 + 4 + 4 + 8 * PARTS.len();

/// The type that bytes are of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    State,
    Simulation,
}

impl Kind {
    fn tag(self) -> &'static [u8; 4] {
        match self {
            Kind::State => b"stat",
            Kind::Simulation => b"simu",
        }
    }
}

/// The reason for which nothing is restored from bytes.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RestoreError {
    /// The bytes are of another kind.
    #[error("these bytes are no {what} that qhat saved")]
    NotSaved {
        /// The word `state` or `simulation`.
        what: &'static str,
    },
    /// The bytes are of another version of the format.
    #[error("these bytes have version {found} of the format, and this qhat reads version {VERSION}: compute them anew")]
    Version {
        /// Their version.
        found: u32,
    },
    /// The bytes are cut or changed.
    #[error("these bytes are damaged: they were cut or changed after they were saved")]
    Damaged,
    /// The bytes belong to a system that differs.
    #[error("these bytes belong to a system with other {part}")]
    Differs {
        /// The word `particles`, `constraints`, `forces` or `feedback`, in which numbers count, too.
        part: &'static str,
    },
    /// The start of the simulation is refused.
    #[error(transparent)]
    Start(#[from] crate::error::StepError),
}

/// The bytes of a value of a system.
pub(crate) fn to_bytes(kind: Kind, system: &System, value: &impl Serialize) -> Vec<u8> {
    let mut bytes = Vec::new();
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(kind.tag());
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    fingerprints(system).iter().for_each(|hash| bytes.extend_from_slice(&hash.to_le_bytes()));
    let content = postcard::to_allocvec(value).expect("numbers, lists and texts are always written");
    bytes.extend_from_slice(&content);
    let sum = Hash::of(&bytes);
    bytes.extend_from_slice(&sum.to_le_bytes());
    bytes
}

/// The value of such bytes.
pub(crate) fn from_bytes<T: DeserializeOwned>(kind: Kind, system: &System, bytes: &[u8]) -> Result<T, RestoreError> {
    let what = match kind {
        Kind::State => "state",
        Kind::Simulation => "simulation",
    };
    if bytes.len() < 12 || !bytes.starts_with(MAGIC) || &bytes[4..8] != kind.tag() {
        return Err(RestoreError::NotSaved { what });
    }
    let found = u32::from_le_bytes(bytes[8..12].try_into().expect("4 bytes"));
    if found != VERSION {
        return Err(RestoreError::Version { found });
    }
    let Some((before, sum)) = bytes.split_last_chunk::<8>() else { return Err(RestoreError::Damaged) };
    if before.len() < HEAD || u64::from_le_bytes(*sum) != Hash::of(before) {
        return Err(RestoreError::Damaged);
    }
    let hashes = before[12..HEAD].chunks_exact(8).map(|hash| u64::from_le_bytes(hash.try_into().expect("8 bytes")));
    let own = fingerprints(system);
    if let Some((part, _)) = PARTS.iter().zip(hashes.zip(own)).find(|(_, (saved, own))| saved != own) {
        return Err(RestoreError::Differs { part });
    }
    postcard::from_bytes(&before[HEAD..]).map_err(|_| RestoreError::Damaged)
}

impl State {
    /// The state as bytes, which [`State::from_bytes`] reads in another process, on any target, in the same version of
    /// qhat. A run that goes on from there gives the same bits. The system is compared by the numbers of its parts;
    /// functions of custom constraints and forces are not compared.
    pub fn to_bytes(&self, system: &System) -> Vec<u8> {
        to_bytes(Kind::State, system, self)
    }

    /// The state of a system from its bytes.
    ///
    /// ```
    /// # use qhat::{Dimension, Particle, State, System};
    /// let build = || System::builder(Dimension::Two).with_particle(Particle::at("stone", [0.0, 10.0])).build();
    /// let (system, state) = build()?;
    /// let bytes = state.to_bytes(&system);
    /// let (same, _) = build()?;
    /// assert_eq!(State::from_bytes(&same, &bytes)?, state);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Bytes that are no state, of another version or damaged; those of a system in which a part or a number differs.
    pub fn from_bytes(system: &System, bytes: &[u8]) -> Result<State, RestoreError> {
        let state: State = from_bytes(Kind::State, system, bytes)?;
        if fits(&state, system) { Ok(state) } else { Err(RestoreError::Damaged) }
    }
}

/// Whether all arrays of a state have the lengths that its system asks for.
pub(crate) fn fits(state: &State, system: &System) -> bool {
    let (coordinates, rows) = (system.coordinate_count(), system.all_row_count());
    let motion = [&state.q, &state.qd].into_iter().all(|array| array.len() == coordinates);
    let modes = state.modes.contacts.len() == system.contacts.list.len()
        && state.modes.broken.len() == system.contacts.breakables.len();
    let feet = state.feet.is_empty() || state.feet.len() == system.bead_places.len();
    // Readers compare the number of rows of a rank and of multipliers: a simulation may add rows for joints that rods
    // hold only to second order.
    let rank = state.rank.as_ref().is_none_or(|rank| {
        rank.rows != rows
            || (rank.inactive.is_empty() || rank.inactive.len() == rows)
                && rank.dependent.iter().all(|&row| (row as usize) < rows)
    });
    let carry = state.carry.as_ref().is_none_or(|carry| {
        carry.previous.as_ref().is_none_or(|it| [&it.q, &it.qd].iter().all(|array| array.len() == coordinates))
    });
    motion && modes && feet && rank && carry
}

/// The fingerprint of each part of a system.
fn fingerprints(system: &System) -> [u64; PARTS.len()] {
    let of = |write: &dyn Fn(&mut Hash) -> fmt::Result| {
        let mut hash = Hash::new();
        // Writing to a hash cannot fail.
        let _ = write(&mut hash);
        hash.0
    };
    [
        of(&|hash| {
            write!(
                hash,
                "{:?}{:?}{:?}{:?}",
                system.dimension(),
                system.mass,
                system.inverse_mass,
                system.particle_names
            )
        }),
        of(&|hash| system.constraints().iter().try_for_each(|it| write!(hash, "{:?}{:?}", it.name, it.constraint))),
        of(&|hash| system.forces.iter().try_for_each(|force| write!(hash, "{force:?}"))),
        of(&|hash| write!(hash, "{:?}", system.feedback)),
    ]
}

/// FNV-1a with 64 bits.
/// Source: Fowler, Noll, Vo and Eastlake, The FNV Non-Cryptographic Hash Algorithm, IETF draft (2019).
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Hash(0xcbf2_9ce4_8422_2325)
    }

    fn of(bytes: &[u8]) -> u64 {
        let mut hash = Hash::new();
        hash.add(bytes);
        hash.0
    }

    fn add(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.add(text.as_bytes());
        Ok(())
    }
}

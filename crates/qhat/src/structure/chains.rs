//! The plan of chains: the lane and the block of every particle, found once when a System is built.
//!
//! A system qualifies if every constraint is a rod in the length form or a nail, and if its rods, cut at fixed and
//! nailed particles, form open chains (a free particle is a chain without links). Up to eight chains of similar length
//! are placed side by side, each in a lane of its own; a single long chain is cut into eight stretches. A group of
//! eight lanes with S rows has S + 1 blocks of particles: block i of a lane is the particle at the end of its row i,
//! block 0 the particle at which its first row begins.

use crate::constraint::{Constraint, DistanceForm, NailForm, NamedConstraint};
use crate::linalg::eight::{F8, LANES};
use std::ops::Range;

/// Least number of links of a chain that is cut into stretches. On a shorter chain the coupling of the stretches costs
/// more than the lanes save.
const WORTH_CUTTING: usize = 16;

/// Eight lanes with the same number of rows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Group {
    /// The block with the first particle of every lane.
    pub(crate) first: usize,
    /// S, the number of rows of each lane.
    pub(crate) rows: usize,
    /// Whether any lane continues another.
    pub(crate) is_coupled: bool,
    /// 1 in a lane that continues the lane before, else 0.
    pub(crate) follows: F8,
}

impl Group {
    /// The blocks of the group.
    #[inline(always)]
    pub(crate) fn blocks(&self) -> Range<usize> {
        self.first..self.first + self.rows + 1
    }

    /// The range of the group in arrays with D entries for each block.
    #[inline(always)]
    pub(crate) fn coordinates<const D: usize>(&self) -> Range<usize> {
        self.first * D..(self.first + self.rows + 1) * D
    }
}

/// The fixed numbers of one group; see [`ChainPlan`].
#[derive(Clone, Copy)]
pub(crate) struct Stretch<'a> {
    pub(crate) group: &'a Group,
    pub(crate) w: &'a [F8],
    pub(crate) rod: &'a [F8],
    pub(crate) padding: &'a [F8],
    pub(crate) r: &'a [F8],
    pub(crate) inverse_r: &'a [F8],
}

/// One particle in one lane of one block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChainSlot {
    pub(crate) particle: usize,
    pub(crate) block: usize,
    pub(crate) lane: usize,
}

/// The lanes of a whole system. Arrays have one entry for each block. An entry of an array of rows belongs to the row
/// that ends at the block.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ChainPlan {
    pub(crate) groups: Vec<Group>,
    /// w [1/kg], 0 for fixed and nailed particles.
    pub(crate) w: Vec<F8>,
    /// 1 for a particle that can move, counted once; 0 for copies, fixed and nailed particles, and padding.
    pub(crate) counted: Vec<F8>,
    /// r [m], 0 in padding.
    pub(crate) r: Vec<F8>,
    /// 1/r [1/m], 0 in padding.
    pub(crate) inverse_r: Vec<F8>,
    /// 1 for a rod, 0 in padding, whose particles may drift anywhere.
    pub(crate) rod: Vec<F8>,
    /// 1 in padding, 0 for a rod; added to the diagonal, so that no pivot in padding is zero.
    pub(crate) padding: Vec<F8>,
    /// The slot of each moving particle.
    pub(crate) homes: Vec<ChainSlot>,
    /// All other slots: fixed or nailed particles at the ends of chains, first particles of stretches (copies of the
    /// last particle of the stretch before), padding.
    pub(crate) copies: Vec<ChainSlot>,
    /// Particles held by nails, with their points, in the order of constraints.
    pub(crate) nailed: Vec<(usize, [f64; 3])>,
    /// The block and the lane of each rod, with the place of its constraint.
    links: Vec<(usize, usize, usize)>,
    /// Whether a chain is held at both ends: its rows depend on each other where it is straight.
    pub(crate) may_lose_rank: bool,
}

/// An open chain: its particles in order and the rods between them, by the places of their constraints.
struct Chain {
    particles: Vec<usize>,
    rods: Vec<usize>,
}

impl ChainPlan {
    /// The plan of a system; `None` if the system does not consist of open chains.
    pub(crate) fn new(constraints: &[NamedConstraint], inverse_mass: &[f64]) -> Option<ChainPlan> {
        let mut plan = ChainPlan::default();
        let mut is_held: Vec<bool> = inverse_mass.iter().map(|&w| w == 0.0).collect();
        for named in constraints {
            if let Constraint::Nail(nail) = &named.constraint {
                // A second nail, or a nail in a fixed particle, is redundant or a contradiction: the general path
                // decides which of the two.
                if nail.form != NailForm::Vector || is_held[nail.particle.0] {
                    return None;
                }
                is_held[nail.particle.0] = true;
                plan.nailed.push((nail.particle.0, nail.at));
            }
        }
        let mut chains = chains(constraints, &is_held)?;
        let ends = |chain: &Chain| {
            [chain.particles.first(), chain.particles.last()].map(|end| end.is_some_and(|&p| is_held[p]))
        };
        plan.may_lose_rank = chains.iter().any(|chain| ends(chain) == [true, true]);
        chains.sort_by_key(|chain| std::cmp::Reverse(chain.rods.len()));
        let mut rest = &chains[..];
        while let Some(longest) = rest.first().map(|chain| chain.rods.len()) {
            let alike = rest.iter().take(LANES).filter(|chain| 2 * chain.rods.len() >= longest).count();
            if longest >= WORTH_CUTTING && alike < LANES {
                plan.cut(inverse_mass, &is_held, &rest[0]);
                rest = &rest[1..];
            } else {
                let lanes = rest.len().min(LANES);
                plan.side_by_side(inverse_mass, &is_held, &rest[..lanes]);
                rest = &rest[lanes..];
            }
        }
        plan.homes.sort_by_key(|place| place.particle);
        plan.renew(constraints, inverse_mass);
        Some(plan)
    }

    /// Takes the numbers of the constraints and the inverse masses [1/kg]; the structure is the same.
    pub(crate) fn renew(&mut self, constraints: &[NamedConstraint], inverse_mass: &[f64]) {
        for place in self.homes.iter().chain(&self.copies) {
            let w = &mut self.w[place.block].0[place.lane];
            if *w > 0.0 {
                *w = inverse_mass[place.particle];
            }
        }
        for &(block, lane, place) in &self.links {
            if let Some(rod) = constraints[place].constraint.as_rod() {
                self.r[block].0[lane] = rod.length;
                self.inverse_r[block].0[lane] = 1.0 / rod.length;
            }
        }
        let nails = constraints.iter().filter_map(|named| match &named.constraint {
            Constraint::Nail(nail) => Some(nail.at),
            _ => None,
        });
        self.nailed.iter_mut().zip(nails).for_each(|((_, at), nail)| *at = nail);
    }

    /// Number of blocks.
    pub(crate) fn blocks(&self) -> usize {
        self.w.len()
    }

    /// The groups, each with its part of every array.
    #[inline(always)]
    pub(crate) fn stretches<'a>(&'a self, groups: &'a [Group]) -> impl Iterator<Item = Stretch<'a>> {
        groups.iter().map(
            #[inline(always)]
            |group| {
                let blocks = group.blocks();
                Stretch {
                    group,
                    w: &self.w[blocks.clone()],
                    rod: &self.rod[blocks.clone()],
                    padding: &self.padding[blocks.clone()],
                    r: &self.r[blocks.clone()],
                    inverse_r: &self.inverse_r[blocks],
                }
            },
        )
    }

    /// The slot of a moving particle; `None` for a fixed or nailed one.
    pub(crate) fn home(&self, particle: usize) -> Option<ChainSlot> {
        let found = self.homes.binary_search_by_key(&particle, |place| place.particle);
        found.ok().map(|k| self.homes[k])
    }

    fn cut(&mut self, inverse_mass: &[f64], is_held: &[bool], chain: &Chain) {
        let rows = chain.rods.len().div_ceil(LANES);
        let stretches: Vec<(&[usize], &[usize])> = chain
            .rods
            .chunks(rows)
            .enumerate()
            .map(|(k, rods)| (&chain.particles[k * rows..=k * rows + rods.len()], rods))
            .collect();
        self.group(inverse_mass, is_held, &stretches, true);
    }

    fn side_by_side(&mut self, inverse_mass: &[f64], is_held: &[bool], chains: &[Chain]) {
        let stretches: Vec<(&[usize], &[usize])> =
            chains.iter().map(|chain| (&chain.particles[..], &chain.rods[..])).collect();
        self.group(inverse_mass, is_held, &stretches, false);
    }

    /// A group of up to eight stretches, the first of which is the longest.
    fn group(&mut self, inverse_mass: &[f64], is_held: &[bool], stretches: &[(&[usize], &[usize])], is_coupled: bool) {
        let (first, rows) = (self.w.len(), stretches[0].1.len());
        let end = first + rows + 1;
        for array in [&mut self.w, &mut self.counted, &mut self.r, &mut self.inverse_r, &mut self.rod] {
            array.resize(end, F8::ZERO);
        }
        self.padding.resize(end, F8::splat(1.0));
        let mut follows = F8::ZERO;
        for lane in 0..LANES {
            // An empty lane is padded with fixed copies of the first particle of the group.
            let (particles, rods) = stretches.get(lane).copied().unwrap_or((&stretches[0].0[..1], &[]));
            let is_empty = lane >= stretches.len();
            if is_coupled && lane > 0 && !is_empty {
                follows.0[lane] = 1.0;
            }
            for i in 0..=rows {
                let block = first + i;
                let place = ChainSlot { particle: particles[i.min(rods.len())], block, lane };
                let is_padding = is_empty || i > rods.len();
                let moves = !is_padding && !is_held[place.particle];
                if moves {
                    self.w[block].0[lane] = inverse_mass[place.particle];
                }
                if moves && !(i == 0 && follows.0[lane] > 0.0) {
                    self.counted[block].0[lane] = 1.0;
                    self.homes.push(place);
                } else {
                    self.copies.push(place);
                }
                if i > 0 && !is_padding {
                    self.links.push((block, lane, rods[i - 1]));
                    self.rod[block].0[lane] = 1.0;
                    self.padding[block].0[lane] = 0.0;
                }
            }
        }
        self.groups.push(Group { first, rows, is_coupled, follows });
    }
}

/// The open chains between fixed and nailed particles, walked from their ends; `None` if a chain branches or closes.
fn chains(constraints: &[NamedConstraint], is_held: &[bool]) -> Option<Vec<Chain>> {
    let mut rods = Vec::new();
    let mut touching = vec![[usize::MAX; 2]; is_held.len()];
    for (place, named) in constraints.iter().enumerate() {
        let Some(rod) = named.constraint.as_rod() else {
            if matches!(named.constraint, Constraint::Nail(_)) {
                continue;
            }
            return None;
        };
        if rod.breaks_at.is_some() || rod.breaks_at_impulse.is_some() {
            return None;
        }
        if rod.compliance > 0.0 {
            // A compliant rod acts as a spring and has no row.
            continue;
        }
        if rod.form != DistanceForm::Length || (is_held[rod.a.0] && is_held[rod.b.0]) {
            return None;
        }
        for end in [rod.a.0, rod.b.0] {
            if !is_held[end] {
                let free = touching[end].iter().position(|&rod| rod == usize::MAX)?;
                touching[end][free] = rods.len();
            }
        }
        rods.push((rod.a.0, rod.b.0, place));
    }
    let mut chains = Vec::new();
    for particle in 0..is_held.len() {
        if !is_held[particle] && touching[particle][0] == usize::MAX {
            chains.push(Chain { particles: vec![particle], rods: Vec::new() });
        }
    }
    let mut is_walked = vec![false; rods.len()];
    for start in 0..rods.len() {
        let (a, b, _) = rods[start];
        let is_end = |particle: usize| is_held[particle] || touching[particle][1] == usize::MAX;
        let Some(end) = [a, b].into_iter().find(|&particle| is_end(particle)) else { continue };
        if is_walked[start] {
            continue;
        }
        let mut chain = Chain { particles: vec![end], rods: Vec::new() };
        let (mut rod, mut particle) = (start, end);
        loop {
            is_walked[rod] = true;
            let (a, b, place) = rods[rod];
            particle = if a == particle { b } else { a };
            chain.particles.push(particle);
            chain.rods.push(place);
            if is_end(particle) {
                break;
            }
            let [one, other] = touching[particle];
            rod = if one == rod { other } else { one };
        }
        chains.push(chain);
    }
    is_walked.iter().all(|&walked| walked).then_some(chains)
}

//! Resolution of an event: the constraint that breaks, the impact, the modes in which the motion goes on, and the
//! events for the report.
//!
//! Two contacts of one body may hit in turn for ever, each impact too slow to matter (a rocking block, two ropes). So
//! if contacts separate so slowly that the applied forces would close them again within the rest time, the separation
//! is suppressed: the contact stays closed, and the remaining velocity is projected out in the mass metric. This can
//! only remove energy.

use super::complementarity::{along, size};
use super::following::close_following;
use super::rest::{RestThresholds, rest_speed};
use super::{EventCause, Impact, NoConsistentModes, SAME_WAY, Touching, hold, settle};
use crate::modes::{Mode, Modes};
use crate::multiplier::Equation;
use crate::point::{Motion, largest};
use crate::report::{Event, Warning};
use crate::settings::Feedback;
use crate::system::System;

/// Rounds of one resolution. Holding one contact may make another close; more rounds than this are a chain without an
/// end.
const ROUNDS: usize = 100;

/// 3D only. When the slip along its old direction reaches zero, the transverse remainder is treated as zero if it is
/// below `STOPS` × the rest speed. At that speed the force decides the direction, not the slip.
const STOPS: f64 = 1000.0;

/// τ of a shock (`impact.rs`), in frames: a time in which nothing else happens.
const SHOCK: f64 = 1e-3;

/// The report of a resolution.
#[derive(Clone, Debug, Default)]
pub(crate) struct Resolved {
    /// Energy lost [J]: kinetic energy in impacts, and the energy that elastic links held when they broke.
    pub(crate) lost: f64,
    /// Impacts, in which a contact closed faster than the bounce speed; then the changes of modes.
    pub(crate) events: Vec<Event>,
    /// Contacts that were struck at once.
    pub(crate) warnings: Vec<Warning>,
}

/// A system at the time of an event.
pub(crate) struct EventResolution<'a, const D: usize> {
    pub(crate) equation: &'a mut Equation,
    pub(crate) system: &'a System,
    pub(crate) q: &'a [f64],
    pub(crate) qd: &'a mut [f64],
    pub(crate) t: f64,
    pub(crate) thresholds: RestThresholds,
}

impl<const D: usize> EventResolution<'_, D> {
    /// Decides the modes, and changes q̇ where there is an impact. Leaves rows and forces evaluated, and A factored
    /// for the modes.
    pub(crate) fn resolve(
        &mut self,
        modes: &mut Modes,
        cause: Option<EventCause>,
    ) -> Result<Resolved, NoConsistentModes> {
        let mut resolved = Resolved::default();
        let at_first = modes.clone();
        let next_slip = self.next_slip(cause);
        if let Some(EventCause::Break(breakable)) = cause {
            resolved.lost += self.break_link(modes, breakable);
        }
        let mut last = 0;
        for round in 0..ROUNDS {
            self.evaluate();
            let mut near = self.near(modes, cause);
            let closing = self.closing(modes, &near);
            if !closing.is_empty() {
                self.collide(modes, &near, &closing, &mut resolved)?;
                self.evaluate();
                // Without the links that the impact broke.
                near = self.near(modes, cause);
            }
            let stopping = cause.filter(|_| round == 0);
            let touching = self.open_separating(modes, near, closing.is_empty(), stopping);
            if round == 0 {
                self.apply(cause, next_slip, modes);
            }
            let before = modes.clone();
            if self.settle(modes, &touching).is_err() {
                *modes = before;
                resolved.lost += self.shock(modes, touching)?;
                continue;
            }
            // A contact that stays closed must not separate, however slowly; holding it may make another contact close.
            let closed = touching.iter().filter(|touching| modes.contacts[touching.contact].is_closed());
            let separates = |touching: &&Touching| self.rate(touching.contact).abs() > self.rest_speed();
            let Some(separating) = closed.into_iter().find(separates) else {
                self.write_changes(&at_first, modes, &mut resolved.events);
                return Ok(resolved);
            };
            last = separating.contact;
            resolved.lost += hold::<D>(self.equation, self.system, self.qd);
        }
        Err(NoConsistentModes { contact: last })
    }

    /// The modes under the applied forces.
    fn settle(&mut self, modes: &mut Modes, touching: &[Touching]) -> Result<(), NoConsistentModes> {
        let EventResolution { equation, system, thresholds, .. } = self;
        equation.b.assemble::<D>(&equation.rows, &equation.WQ, &Feedback::NONE);
        settle::<D>(equation, system, modes, touching)?;
        close_following::<D>(equation, system, modes, touching, thresholds.touch_distance);
        Ok(())
    }

    /// The impulse where friction forces have no answer. Returns the energy lost [J].
    fn shock(&mut self, modes: &mut Modes, mut touching: Vec<Touching>) -> Result<f64, NoConsistentModes> {
        if let Some(first) = touching.first().filter(|_| touching.iter().all(|touching| touching.slip.is_none())) {
            return Err(NoConsistentModes { contact: first.contact });
        }
        touching.iter_mut().for_each(|touching| touching.may_stick = true);
        let EventResolution { equation, system, qd, thresholds, .. } = self;
        equation.b.assemble::<D>(&equation.rows, &equation.WQ, &Feedback::NONE);
        Impact::<D> { equation, system, touching: &touching, qd }.shock(modes, SHOCK * thresholds.frame)
    }

    pub(super) fn evaluate(&mut self) {
        let motion = Motion::<D> { q: self.q, qd: self.qd, t: self.t };
        self.equation.apply_forces(self.system, motion);
        self.equation.constrain_all(self.system, motion);
    }

    fn rest_speed(&self) -> f64 {
        rest_speed(self.qd, &self.equation.WQ, self.thresholds.frame)
    }

    /// The speed below which a flight under the applied forces is shorter than the rest time [m/s].
    pub(super) fn bounce_speed(&self) -> f64 {
        let strongest = largest(&self.equation.WQ);
        self.thresholds.shortest_flight.map_or(f64::INFINITY, |flight| 0.5 * flight * strongest)
    }

    /// Ċ of a contact: the speed at which it separates.
    pub(super) fn rate(&self, k: usize) -> f64 {
        self.equation.rows.Cd[self.system.contacts.list[k].normal]
    }

    /// The contacts that are closed or touch.
    fn near(&self, modes: &mut Modes, cause: Option<EventCause>) -> Vec<usize> {
        let mut near = Vec::new();
        for (k, contact) in self.system.contacts.list.iter().enumerate() {
            let gap = self.equation.rows.C[contact.normal];
            if modes.is_gone(contact) || cause == Some(EventCause::Singular(k)) {
                modes.contacts[k] = Mode::Open;
            } else if modes.contacts[k].is_closed()
                || gap <= self.thresholds.touch_distance * self.system.row_scale[contact.normal]
            {
                near.push(k);
            }
        }
        near
    }

    /// Those of the contacts near that are open and closing.
    fn closing(&self, modes: &Modes, near: &[usize]) -> Vec<usize> {
        let rest_speed = self.rest_speed();
        let closes = |&k: &usize| modes.contacts[k] == Mode::Open && -self.rate(k) > rest_speed;
        near.iter().copied().filter(closes).collect()
    }

    /// A touching contact with its slip; a slip that is `stopping` counts as zero up to `STOPS` × the rest speed.
    pub(super) fn touching(&self, k: usize, may_stick: bool, stopping: bool) -> Touching {
        let tangents = &self.system.contacts.list[k].tangents;
        let slip = along(tangents.clone().map(|row| self.equation.rows.Cd[row]));
        let speed = size(slip);
        let rest_speed = if stopping { STOPS * self.rest_speed() } else { self.rest_speed() };
        let slip = (speed > rest_speed).then(|| slip.map(|component| component / speed));
        Touching { contact: k, slip, may_stick: may_stick || slip.is_none(), is_rough: !tangents.is_empty() }
    }

    /// Opens the contacts that separate faster than the bounce speed, after an impact the closed ones, too. Returns the
    /// other contacts, with the modes of their slips brought up to date: the complementarity problem decides them.
    fn open_separating(
        &self,
        modes: &mut Modes,
        near: Vec<usize>,
        is_without_impact: bool,
        stopping: Option<EventCause>,
    ) -> Vec<Touching> {
        let bounce_speed = self.bounce_speed();
        let mut undecided = Vec::new();
        for k in near {
            let may_open = !is_without_impact || modes.contacts[k] == Mode::Open;
            if may_open && self.rate(k) > bounce_speed {
                modes.contacts[k] = Mode::Open;
                continue;
            }
            let touching = self.touching(k, false, D == 3 && stopping == Some(EventCause::Friction(k)));
            let mode = &mut modes.contacts[k];
            match (*mode, touching.slip) {
                // A slow slip keeps its direction, however roundoff turns it (`integrate/events/slip.rs`).
                (Mode::Sliding(kept), Some(slip))
                    if kept.direction[0] * slip[0] + kept.direction[1] * slip[1] > SAME_WAY => {}
                (Mode::Sliding(_) | Mode::Sticking, Some(direction)) => *mode = Mode::sliding(direction),
                (Mode::Sliding(_), None) => *mode = Mode::Sticking,
                (Mode::Open | Mode::Smooth, _) | (Mode::Sticking, None) => {}
            }
            undecided.push(touching);
        }
        undecided
    }

    /// The direction in which a sticking contact will slip: against the force that held it.
    fn next_slip(&self, cause: Option<EventCause>) -> Option<[f64; 2]> {
        let Some(EventCause::Friction(k)) = cause else { return None };
        let tangents = self.system.contacts.list[k].tangents.clone();
        let lambda_t = along(tangents.map(|row| self.equation.lambda[row]));
        let size = size(lambda_t);
        (size > 0.0).then(|| lambda_t.map(|component| -component / size))
    }

    /// Changes the mode whose event function has just reached zero.
    fn apply(&self, cause: Option<EventCause>, next_slip: Option<[f64; 2]>, modes: &mut Modes) {
        match cause {
            Some(EventCause::Normal(k)) if modes.contacts[k].is_closed() => {
                modes.contacts[k] = Mode::Open;
            }
            Some(EventCause::Friction(k)) if modes.contacts[k] == Mode::Sticking => {
                if let Some(direction) = next_slip {
                    modes.contacts[k] = Mode::sliding(direction);
                }
            }
            // Every other change is decided by the complementarity problem.
            Some(
                EventCause::Normal(_)
                | EventCause::Friction(_)
                | EventCause::Turn(_)
                | EventCause::Break(_)
                | EventCause::Singular(_),
            )
            | None => {}
        }
    }
}

//! What follows an event: what breaks, the impact, and the modes in which it goes on.
//!
//! Two contacts of one body may hit in turn for ever, each impact too rest_speed to matter (a rocking block, two ropes). So a parting so rest_speed
//! that the flight would not last is none: what the forces would close again is held at once. That takes energy and never gives any:
//! q̇ is projected in the mass metric.

use super::complementarity::{along, size};
use super::{EventCause, NoConsistentModes, SAME_WAY, Touching, collide, hold, settle, shock};
use crate::modes::{Mode, Modes};
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::settings::Feedback;
use crate::system::System;

/// What parts slowly is held, which may push something else to close in; more rounds than this are a chain without an end.
const ROUNDS: usize = 100;

/// Where a slip ceases along its direction, what is left of it across, in space, is none if it is this many times slower than what counts
/// as none: at so rest_speed a slip the direction is that in which it is pulled.
const STOPS: f64 = 1000.0;

/// τ of a shock, in frames: a time in which nothing else happens.
const SHOCK: f64 = 1e-3;

/// What is open and nearer than this many tolerances touch_distance: twice what a margin may be off at its event.
pub(crate) const TOUCH_DISTANCE: f64 = 2.0;

/// By what a resolved measures.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestThresholds {
    /// What is open and nearer than this, relative to the row's scale, touches.
    pub(crate) touch_distance: f64,
    /// A flight shorter than this is none [s]: such an impact gives nothing back. `None`: no impact does.
    pub(crate) shortest_flight: Option<f64>,
    /// The length of a frame [s].
    pub(crate) frame: f64,
}

/// A slip or approach slower than this is none [m/s]: a billionth of the fastest particle, or of what the applied forces do to the
/// velocity in one frame, so that what rests is at rest.
pub(crate) fn rest_speed(qd: &[f64], WQ: &[f64], frame: f64) -> f64 {
    let largest = |numbers: &[f64]| numbers.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    1e-9 * largest(qd).max(frame * largest(WQ))
}

/// What happened.
#[derive(Clone, Debug, Default)]
pub(crate) struct Resolved {
    /// Kinetic energy lost in impacts [J].
    pub(crate) lost: f64,
    /// Contacts that closed in faster than what rests, and how fast [m/s].
    pub(crate) impacts: Vec<(usize, f64)>,
}

/// A system at the resolution of an event.
pub(crate) struct EventResolution<'a, const D: usize> {
    pub(crate) equation: &'a mut Equation,
    pub(crate) system: &'a System,
    pub(crate) q: &'a [f64],
    pub(crate) qd: &'a mut [f64],
    pub(crate) t: f64,
    pub(crate) thresholds: RestThresholds,
}

impl<const D: usize> EventResolution<'_, D> {
    /// Decides the modes, and changes q̇ where there is an impact. Leaves rows and forces evaluated, and A factored for the modes.
    pub(crate) fn resolve(
        &mut self,
        modes: &mut Modes,
        cause: Option<EventCause>,
    ) -> Result<Resolved, NoConsistentModes> {
        let mut resolved = Resolved::default();
        let slips = self.slips(cause);
        if let Some(EventCause::Break(breakable)) = cause {
            modes.broken[breakable] = true;
        }
        let mut last = 0;
        for round in 0..ROUNDS {
            self.evaluate();
            let near = self.near(modes, cause);
            let hits = self.hits(modes, &near);
            if !hits.is_empty() {
                self.collide(modes, &near, &hits, &mut resolved)?;
                self.evaluate();
            }
            let stops = cause.filter(|_| round == 0);
            let asked = self.ask(modes, near, hits.is_empty(), stops);
            if round == 0 {
                self.turn(modes, cause, slips);
            }
            let before = modes.clone();
            if self.settle(modes, &asked).is_err() {
                *modes = before;
                resolved.lost += self.shock(modes, asked)?;
                continue;
            }
            // What holds from now on must not part, however slowly; what that pushes may close in elsewhere.
            let closed = asked.iter().filter(|touching| modes.contacts[touching.contact].is_closed());
            let parts = |touching: &&Touching| self.rate(touching.contact).abs() > self.rest_speed();
            let Some(parting) = closed.into_iter().find(parts) else { return Ok(resolved) };
            last = parting.contact;
            resolved.lost += hold::<D>(self.equation, self.system, self.qd);
        }
        Err(NoConsistentModes { contact: last })
    }

    fn settle(&mut self, modes: &mut Modes, asked: &[Touching]) -> Result<(), NoConsistentModes> {
        let EventResolution { equation, system, .. } = self;
        equation.b.assemble::<D>(&equation.rows, &equation.WQ, &Feedback::NONE);
        settle::<D>(equation, system, modes, asked)
    }

    fn shock(&mut self, modes: &mut Modes, mut asked: Vec<Touching>) -> Result<f64, NoConsistentModes> {
        if let Some(touching) = asked.first().filter(|_| asked.iter().all(|touching| touching.slip.is_none())) {
            return Err(NoConsistentModes { contact: touching.contact });
        }
        asked.iter_mut().for_each(|touching| touching.may_stick = true);
        let EventResolution { equation, system, qd, thresholds, .. } = self;
        equation.b.assemble::<D>(&equation.rows, &equation.WQ, &Feedback::NONE);
        shock::<D>(equation, system, modes, &asked, SHOCK * thresholds.frame, qd)
    }

    fn evaluate(&mut self) {
        let motion = Motion::<D> { q: self.q, qd: self.qd, t: self.t };
        self.equation.apply_forces(self.system, motion);
        self.equation.constrain_all(self.system, motion);
    }

    fn rest_speed(&self) -> f64 {
        rest_speed(self.qd, &self.equation.WQ, self.thresholds.frame)
    }

    /// The speed below which a flight under the applied forces does not last [m/s].
    fn bounce_speed(&self) -> f64 {
        let pull = self.equation.WQ.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
        self.thresholds.shortest_flight.map_or(f64::INFINITY, |flight| 0.5 * flight * pull)
    }

    /// Ċ of a contact.
    fn rate(&self, contact: usize) -> f64 {
        self.equation.rows.Cd[self.system.contacts.list[contact].normal]
    }

    /// Which contacts hold, or touch.
    fn near(&self, modes: &mut Modes, cause: Option<EventCause>) -> Vec<usize> {
        let mut near = Vec::new();
        for (place, contact) in self.system.contacts.list.iter().enumerate() {
            let gap = self.equation.rows.C[contact.normal];
            if modes.is_gone(contact) || cause == Some(EventCause::Singular(place)) {
                modes.contacts[place] = Mode::Open;
            } else if modes.contacts[place].is_closed()
                || gap <= self.thresholds.touch_distance * self.system.row_scale[contact.normal]
            {
                near.push(place);
            }
        }
        near
    }

    /// Which of them close in.
    fn hits(&self, modes: &Modes, near: &[usize]) -> Vec<usize> {
        let rest_speed = self.rest_speed();
        let closes = |&place: &usize| modes.contacts[place] == Mode::Open && -self.rate(place) > rest_speed;
        near.iter().copied().filter(closes).collect()
    }

    fn touching(&self, place: usize, may_stick: bool, stops: bool) -> Touching {
        let tangents = &self.system.contacts.list[place].tangents;
        let slip = along(tangents.clone().map(|row| self.equation.rows.Cd[row]));
        let speed = size(slip);
        let rest_speed = if stops { STOPS * self.rest_speed() } else { self.rest_speed() };
        let slip = (speed > rest_speed).then(|| slip.map(|component| component / speed));
        Touching { contact: place, slip, may_stick: may_stick || slip.is_none() }
    }

    fn collide(
        &mut self,
        modes: &Modes,
        near: &[usize],
        hits: &[usize],
        resolved: &mut Resolved,
    ) -> Result<(), NoConsistentModes> {
        let bounce_speed = self.bounce_speed();
        let speeds = hits.iter().map(|&place| (place, -self.rate(place)));
        resolved.impacts.extend(speeds.filter(|&(_, speed)| speed > bounce_speed));
        let touching: Vec<Touching> = near.iter().map(|&place| self.touching(place, true, false)).collect();
        let gives_back: Vec<bool> = near.iter().map(|&place| -self.rate(place) > bounce_speed).collect();
        let mut during = modes.clone();
        for touching in touching.iter().filter(|touching| hits.contains(&touching.contact)) {
            let has_friction = !self.system.contacts.list[touching.contact].tangents.is_empty();
            during.contacts[touching.contact] = match touching.slip {
                _ if !has_friction => Mode::Smooth,
                Some(direction) => Mode::Sliding(direction),
                None => Mode::Sticking,
            };
        }
        let EventResolution { equation, system, qd, .. } = self;
        resolved.lost += collide::<D>(equation, system, &mut during, &touching, &gives_back, qd)?;
        Ok(())
    }

    /// What goes apart is open; the rest is asked. What parts so slowly that it would be back at once is asked, too.
    fn ask(&self, modes: &mut Modes, near: Vec<usize>, is_smooth: bool, cause: Option<EventCause>) -> Vec<Touching> {
        let bounce_speed = self.bounce_speed();
        let mut asked = Vec::new();
        for place in near {
            let may_part = !is_smooth || modes.contacts[place] == Mode::Open;
            if may_part && self.rate(place) > bounce_speed {
                modes.contacts[place] = Mode::Open;
                continue;
            }
            let touching = self.touching(place, false, D == 3 && cause == Some(EventCause::Friction(place)));
            let mode = &mut modes.contacts[place];
            match (*mode, touching.slip) {
                // What slips slowly keeps its direction, however roundoff turns the slip (`multiplier/friction.rs`).
                (Mode::Sliding(kept), Some(slip)) if kept[0] * slip[0] + kept[1] * slip[1] > SAME_WAY => {}
                (Mode::Sliding(_) | Mode::Sticking, Some(direction)) => *mode = Mode::Sliding(direction),
                (Mode::Sliding(_), None) => *mode = Mode::Sticking,
                _ => {}
            }
            asked.push(touching);
        }
        asked
    }

    /// The direction in which what has stuck will slip: against the force that held it.
    fn slips(&self, cause: Option<EventCause>) -> Option<[f64; 2]> {
        let Some(EventCause::Friction(contact)) = cause else { return None };
        let tangents = self.system.contacts.list[contact].tangents.clone();
        let pull = along(tangents.map(|row| self.equation.lambda[row]));
        let size = size(pull);
        (size > 0.0).then(|| pull.map(|component| -component / size))
    }

    /// Does what the cause says: its margin has just vanished.
    fn turn(&self, modes: &mut Modes, cause: Option<EventCause>, slips: Option<[f64; 2]>) {
        match cause {
            Some(EventCause::Normal(contact)) if modes.contacts[contact].is_closed() => {
                modes.contacts[contact] = Mode::Open;
            }
            Some(EventCause::Friction(contact)) if modes.contacts[contact] == Mode::Sticking => {
                if let Some(direction) = slips {
                    modes.contacts[contact] = Mode::Sliding(direction);
                }
            }
            _ => {}
        }
    }
}

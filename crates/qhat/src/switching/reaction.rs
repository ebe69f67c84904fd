//! What follows an event: what breaks, the impact, and the modes in which it goes on.
//!
//! Two contacts of one body may hit in turn for ever, each impact too slow to matter (a rocking block, two ropes). So a parting so slow
//! that the flight would not last is none: what the forces would close again is held at once. That takes energy and never gives any:
//! q̇ is projected in the mass metric.

use super::complementarity::{along, size};
use super::{Jam, Mode, Modes, SAME_WAY, Touching, Trigger, collide, hold, settle, shock};
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::settings::Feedback;
use crate::system::System;

/// What parts slowly is held, which may push something else to close in; more rounds than this are a chain without an end.
const ROUNDS: usize = 100;

/// Where a slip ceases along its direction, what is left of it across, in space, is none if it is this many times slower than what counts
/// as none: at so slow a slip the direction is that in which it is pulled.
const STOPS: f64 = 1000.0;

/// τ of a shock, in frames: a time in which nothing else happens.
const SHOCK: f64 = 1e-3;

/// What is open and nearer than this many tolerances touches: twice what a margin may be off at its event.
pub(crate) const TOUCHES: f64 = 2.0;

/// By what a reaction measures.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    /// What is open and nearer than this, relative to the row's scale, touches.
    pub(crate) touches: f64,
    /// A flight shorter than this is none [s]: such an impact gives nothing back. `None`: no impact does.
    pub(crate) rest: Option<f64>,
    /// The length of a frame [s].
    pub(crate) frame: f64,
}

/// A slip or approach slower than this is none [m/s]: a billionth of the fastest particle, or of what the applied forces do to the
/// velocity in one frame, so that what rests is at rest.
pub(crate) fn still(qd: &[f64], WQ: &[f64], frame: f64) -> f64 {
    let largest = |numbers: &[f64]| numbers.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    1e-9 * largest(qd).max(frame * largest(WQ))
}

/// What happened.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reaction {
    /// Kinetic energy lost in impacts [J].
    pub(crate) lost: f64,
    /// Contacts that closed in faster than what rests, and how fast [m/s].
    pub(crate) impacts: Vec<(usize, f64)>,
}

/// A system at the moment of an event.
pub(crate) struct Moment<'a, const D: usize> {
    pub(crate) equation: &'a mut Equation,
    pub(crate) system: &'a System,
    pub(crate) q: &'a [f64],
    pub(crate) qd: &'a mut [f64],
    pub(crate) t: f64,
    pub(crate) pace: Pace,
}

impl<const D: usize> Moment<'_, D> {
    /// Decides the modes, and changes q̇ where there is an impact. Leaves rows and forces evaluated, and A factored for the modes.
    pub(crate) fn react(&mut self, modes: &mut Modes, trigger: Option<Trigger>) -> Result<Reaction, Jam> {
        let mut reaction = Reaction::default();
        let slips = self.slips(trigger);
        if let Some(Trigger::Break(breakable)) = trigger {
            modes.broken[breakable] = true;
        }
        let mut last = 0;
        for round in 0..ROUNDS {
            self.evaluate();
            let near = self.near(modes, trigger);
            let hits = self.hits(modes, &near);
            if !hits.is_empty() {
                self.collide(modes, &near, &hits, &mut reaction)?;
                self.evaluate();
            }
            let stops = trigger.filter(|_| round == 0);
            let asked = self.ask(modes, near, hits.is_empty(), stops);
            if round == 0 {
                self.turn(modes, trigger, slips);
            }
            let before = modes.clone();
            if self.settle(modes, &asked).is_err() {
                *modes = before;
                reaction.lost += self.shock(modes, asked)?;
                continue;
            }
            // What holds from now on must not part, however slowly; what that pushes may close in elsewhere.
            let closed = asked.iter().filter(|touching| modes.contacts[touching.contact].is_closed());
            let parts = |touching: &&Touching| self.rate(touching.contact).abs() > self.slow();
            let Some(parting) = closed.into_iter().find(parts) else { return Ok(reaction) };
            last = parting.contact;
            reaction.lost += hold::<D>(self.equation, self.system, self.qd);
        }
        Err(Jam { contact: last })
    }

    fn settle(&mut self, modes: &mut Modes, asked: &[Touching]) -> Result<(), Jam> {
        let Moment { equation, system, .. } = self;
        equation.b.assemble::<D>(&equation.rows, &equation.WQ, &Feedback::NONE);
        settle::<D>(equation, system, modes, asked)
    }

    fn shock(&mut self, modes: &mut Modes, mut asked: Vec<Touching>) -> Result<f64, Jam> {
        if let Some(touching) = asked.first().filter(|_| asked.iter().all(|touching| touching.slip.is_none())) {
            return Err(Jam { contact: touching.contact });
        }
        asked.iter_mut().for_each(|touching| touching.may_stick = true);
        let Moment { equation, system, qd, pace, .. } = self;
        equation.b.assemble::<D>(&equation.rows, &equation.WQ, &Feedback::NONE);
        shock::<D>(equation, system, modes, &asked, SHOCK * pace.frame, qd)
    }

    fn evaluate(&mut self) {
        let motion = Motion::<D> { q: self.q, qd: self.qd, t: self.t };
        self.equation.apply_forces(self.system, motion);
        self.equation.constrain_all(self.system, motion);
    }

    fn slow(&self) -> f64 {
        still(self.qd, &self.equation.WQ, self.pace.frame)
    }

    /// The speed below which a flight under the applied forces does not last [m/s].
    fn rest_speed(&self) -> f64 {
        let pull = self.equation.WQ.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
        self.pace.rest.map_or(f64::INFINITY, |flight| 0.5 * flight * pull)
    }

    /// Ċ of a contact.
    fn rate(&self, contact: usize) -> f64 {
        self.equation.rows.Cd[self.system.switches.contacts[contact].normal]
    }

    /// Which contacts hold, or touch.
    fn near(&self, modes: &mut Modes, trigger: Option<Trigger>) -> Vec<usize> {
        let mut near = Vec::new();
        for (place, contact) in self.system.switches.contacts.iter().enumerate() {
            let gap = self.equation.rows.C[contact.normal];
            if modes.is_gone(contact) || trigger == Some(Trigger::Singular(place)) {
                modes.contacts[place] = Mode::Open;
            } else if modes.contacts[place].is_closed()
                || gap <= self.pace.touches * self.system.row_scale[contact.normal]
            {
                near.push(place);
            }
        }
        near
    }

    /// Which of them close in.
    fn hits(&self, modes: &Modes, near: &[usize]) -> Vec<usize> {
        let slow = self.slow();
        let closes = |&place: &usize| modes.contacts[place] == Mode::Open && -self.rate(place) > slow;
        near.iter().copied().filter(closes).collect()
    }

    fn touching(&self, place: usize, may_stick: bool, stops: bool) -> Touching {
        let tangents = &self.system.switches.contacts[place].tangents;
        let slip = along(tangents.clone().map(|row| self.equation.rows.Cd[row]));
        let speed = size(slip);
        let slow = if stops { STOPS * self.slow() } else { self.slow() };
        let slip = (speed > slow).then(|| slip.map(|component| component / speed));
        Touching { contact: place, slip, may_stick: may_stick || slip.is_none() }
    }

    fn collide(&mut self, modes: &Modes, near: &[usize], hits: &[usize], reaction: &mut Reaction) -> Result<(), Jam> {
        let rest_speed = self.rest_speed();
        let speeds = hits.iter().map(|&place| (place, -self.rate(place)));
        reaction.impacts.extend(speeds.filter(|&(_, speed)| speed > rest_speed));
        let touching: Vec<Touching> = near.iter().map(|&place| self.touching(place, true, false)).collect();
        let gives_back: Vec<bool> = near.iter().map(|&place| -self.rate(place) > rest_speed).collect();
        let mut during = modes.clone();
        for touching in touching.iter().filter(|touching| hits.contains(&touching.contact)) {
            let has_friction = !self.system.switches.contacts[touching.contact].tangents.is_empty();
            during.contacts[touching.contact] = match touching.slip {
                _ if !has_friction => Mode::Smooth,
                Some(direction) => Mode::Sliding(direction),
                None => Mode::Sticking,
            };
        }
        let Moment { equation, system, qd, .. } = self;
        reaction.lost += collide::<D>(equation, system, &mut during, &touching, &gives_back, qd)?;
        Ok(())
    }

    /// What goes apart is open; the rest is asked. What parts so slowly that it would be back at once is asked, too.
    fn ask(&self, modes: &mut Modes, near: Vec<usize>, is_smooth: bool, trigger: Option<Trigger>) -> Vec<Touching> {
        let rest_speed = self.rest_speed();
        let mut asked = Vec::new();
        for place in near {
            let may_part = !is_smooth || modes.contacts[place] == Mode::Open;
            if may_part && self.rate(place) > rest_speed {
                modes.contacts[place] = Mode::Open;
                continue;
            }
            let touching = self.touching(place, false, D == 3 && trigger == Some(Trigger::Friction(place)));
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
    fn slips(&self, trigger: Option<Trigger>) -> Option<[f64; 2]> {
        let Some(Trigger::Friction(contact)) = trigger else { return None };
        let tangents = self.system.switches.contacts[contact].tangents.clone();
        let pull = along(tangents.map(|row| self.equation.lambda[row]));
        let size = size(pull);
        (size > 0.0).then(|| pull.map(|component| -component / size))
    }

    /// Does what the trigger says: its margin has just vanished.
    fn turn(&self, modes: &mut Modes, trigger: Option<Trigger>, slips: Option<[f64; 2]>) {
        match trigger {
            Some(Trigger::Normal(contact)) if modes.contacts[contact].is_closed() => {
                modes.contacts[contact] = Mode::Open;
            }
            Some(Trigger::Friction(contact)) if modes.contacts[contact] == Mode::Sticking => {
                if let Some(direction) = slips {
                    modes.contacts[contact] = Mode::Sliding(direction);
                }
            }
            _ => {}
        }
    }
}

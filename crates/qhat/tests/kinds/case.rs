//! A case: a kind of constraint, the same constraint written as expressions (its twin), and the states in which the two
//! are compared.

use crate::systems::random::{Random, dimension};
use std::sync::LazyLock;

use qhat::{
    Constraint, Driven, Expression, ExpressionConstraint, Particle, ParticleId, Purpose, Scope, State, System,
    SystemBuilder, Terms, evaluate,
};

pub(crate) static P: LazyLock<[ParticleId; 6]> = LazyLock::new(|| std::array::from_fn(crate::systems::id));

/// The start positions of the particles p0 … p6; z is ignored in two dimensions.
pub(crate) const PLACES: [[f64; 3]; 7] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.2],
    [0.2, 1.1, -0.1],
    [-0.9, 0.4, 1.2],
    [-0.5, -0.7, -0.9],
    [3.0, 0.0, 0.0],
    [4.0, 0.0, 0.0],
];

/// The states in which the rows of a case are compared.
#[derive(Clone, Copy, PartialEq)]
enum Tried {
    /// The start, with random velocities. For a wire in space, whose rows are exact only on the wire.
    AtStart,
    /// Up to 0.1 m from the start along each axis.
    Nearby,
    /// Half of the states as in `Nearby`, the others anywhere within 2 m of the origin.
    Anywhere,
}

/// A kind of constraint, and its twin: the same constraint as expressions.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) d: usize,
    /// Particles that do not start at their position in `PLACES`, so that the constraints hold.
    at: &'static [(usize, [f64; 3])],
    /// The constraints, driven by `Clock::s` if their kind can be driven.
    make: fn(&Clock) -> Vec<Constraint>,
    /// The residuals of the twin. S makes a residual zero at the start, and then follows `drive`. The kind has the S of
    /// the last residual; where none has an S, it is `drive` alone.
    twin: &'static [&'static str],
    /// A function of t, 0 at the start.
    drive: &'static str,
    tried: Tried,
    /// Whether the rows of the twin equal the rows of the kind. Otherwise they hold the same positions in other units.
    pub(crate) same_rows: bool,
    /// Whether C is defined up to whole turns.
    pub(crate) turns: bool,
    /// Whether the kind and its twin hold C = 0 over a motion, so that their motions can be compared.
    pub(crate) moves: bool,
    /// Whether it acts on one side only. Away from a run its rows are inactive, and terms show nothing of them.
    pub(crate) one_sided: bool,
}

pub(crate) const fn driven(
    name: &'static str,
    d: usize,
    at: &'static [(usize, [f64; 3])],
    make: fn(&Clock) -> Vec<Constraint>,
    twin: &'static [&'static str],
    drive: &'static str,
) -> Case {
    let tried = Tried::Nearby;
    Case { name, d, at, make, twin, drive, tried, same_rows: true, turns: false, moves: true, one_sided: false }
}

/// A case that is not driven, except by expressions of t in the case itself.
pub(crate) const fn twin(
    name: &'static str,
    d: usize,
    at: &'static [(usize, [f64; 3])],
    make: fn(&Clock) -> Vec<Constraint>,
    twin: &'static [&'static str],
) -> Case {
    driven(name, d, at, make, twin, "0")
}

impl Case {
    pub(crate) const fn anywhere(self) -> Case {
        Case { tried: Tried::Anywhere, ..self }
    }

    pub(crate) const fn at_start(self) -> Case {
        Case { tried: Tried::AtStart, ..self }
    }

    pub(crate) const fn other_rows(self) -> Case {
        Case { same_rows: false, ..self }
    }

    pub(crate) const fn turns(self) -> Case {
        Case { turns: true, ..self }
    }

    pub(crate) const fn without_motion(self) -> Case {
        Case { moves: false, ..self }
    }

    pub(crate) const fn one_sided(self) -> Case {
        Case { moves: false, one_sided: true, ..self }
    }

    /// q at the start.
    pub(crate) fn positions(&self) -> Vec<f64> {
        let place = |i: usize| self.at.iter().find(|(moved, _)| *moved == i).map_or(PLACES[i], |(_, place)| *place);
        (0..PLACES.len()).flat_map(|i| place(i)[..self.d].to_vec()).collect()
    }

    /// The clock of a row of the twin, `later` seconds after the start.
    fn clock_of(&self, text: &str, later: f64) -> Clock {
        let mut start = 0.0;
        if text.contains('S') {
            let q = self.positions();
            let typed = ExpressionConstraint::new(parse(&text.replace('S', "0"), Purpose::Constraint, self.d), &q);
            start = Constraint::from(typed).residual(dimension(self.d), &q)[0];
        }
        Clock { start, drive: self.drive, later, d: self.d }
    }

    /// The clock of the kind: that of the last row which has an S.
    fn clock(&self, later: f64) -> Clock {
        self.clock_of(self.twin.iter().rev().find(|text| text.contains('S')).unwrap_or(&""), later)
    }

    /// The constraints as they are `later` seconds after the start.
    pub(crate) fn constraints(&self, later: f64) -> Vec<Constraint> {
        (self.make)(&self.clock(later))
    }

    /// The expressions of the twin.
    pub(crate) fn typed(&self) -> Vec<Expression> {
        let row = |text: &&str| parse(&self.clock_of(text, 0.0).text(text), Purpose::Constraint, self.d);
        self.twin.iter().map(row).collect()
    }

    /// Whether time changes the constraints.
    pub(crate) fn is_driven(&self) -> bool {
        self.constraints(0.0) != self.constraints(1.0)
    }

    /// The system of these constraints alone, `later` seconds after the start.
    pub(crate) fn system(&self, later: f64) -> (System, State) {
        let mut builder = self.particles(|_, particle| particle);
        for (k, constraint) in self.constraints(later).into_iter().enumerate() {
            builder.constraint(format!("c{k}"), constraint);
        }
        builder.build().unwrap_or_else(|error| panic!("{}: {error}", self.name))
    }

    /// The particles at the start, each changed by `change`.
    pub(crate) fn particles(&self, change: impl Fn(usize, Particle) -> Particle) -> SystemBuilder {
        let mut builder = System::builder(dimension(self.d));
        for (i, x) in self.positions().chunks(self.d).enumerate() {
            builder.particle(change(i, Particle::at(format!("p{i}"), x).with_mass(mass(i))));
        }
        builder
    }

    /// Random q and q̇ for which the rows can be compared: no jump of a turn is near, nor arms in line in space.
    pub(crate) fn states(&self, random: &mut Random, count: usize) -> Vec<(Vec<f64>, Vec<f64>)> {
        let (system, start) = self.system(LATER);
        let s = self.clock(LATER).s().value(0.0);
        let mut states = Vec::new();
        while states.len() < count {
            let v = random.numbers(start.velocities().len(), -0.5, 0.5);
            let q = if self.tried == Tried::Anywhere && states.len() % 2 == 1 {
                random.points(PLACES.len(), self.d, 0.8).concat()
            } else {
                let off = if self.tried == Tried::AtStart { 0.0 } else { 0.1 };
                start.positions().iter().map(|x| x + random.within(-off, off)).collect()
            };
            let terms = evaluate(&system, &start.with_motion(q.clone(), v.clone()));
            let jumps = self.turns && terms.residual[0].abs() > 3.0;
            let is_in_line = self.turns && self.d == 3 && libm::sin(terms.residual[0] + s) < 0.5;
            if !jumps && !is_in_line {
                states.push((q, v));
            }
        }
        states
    }
}

/// A time after the start at which no drive of the table is at rest [s].
pub(crate) const LATER: f64 = 0.37;

/// The particles with these numbers.
pub(crate) fn mass(i: usize) -> f64 {
    1.0 + 0.3 * i as f64
}

/// The drive of a case, with t counted from some time after the start.
pub(crate) struct Clock {
    start: f64,
    drive: &'static str,
    later: f64,
    d: usize,
}

impl Clock {
    /// S.
    pub(crate) fn s(&self) -> Driven {
        if self.drive == "0" { self.start.into() } else { self.of("S") }
    }

    /// The time after the start from which t counts [s].
    pub(crate) fn later(&self) -> f64 {
        self.later
    }

    /// A function of t.
    pub(crate) fn of(&self, text: &str) -> Driven {
        parse(&self.text(text), Purpose::Time, 2).into()
    }

    /// A residual that may have S in it.
    pub(crate) fn row(&self, text: &str) -> Constraint {
        let q: Vec<f64> = PLACES.iter().flat_map(|place| place[..self.d].to_vec()).collect();
        ExpressionConstraint::new(parse(&self.text(text), Purpose::Constraint, self.d), &q).into()
    }

    /// The text with S inserted and t counted from a later time.
    fn text(&self, text: &str) -> String {
        let text = text.replace('S', &format!("({:?} + {})", self.start, self.drive));
        if self.later == 0.0 {
            return text;
        }
        let mut counted = String::new();
        let is_part = |c: Option<&char>| c.is_some_and(|c| c.is_alphanumeric() || *c == '_' || *c == '.');
        let letters: Vec<char> = text.chars().collect();
        for (i, letter) in letters.iter().enumerate() {
            let before = i.checked_sub(1).and_then(|i| letters.get(i));
            if *letter == 't' && !is_part(before) && !is_part(letters.get(i + 1)) {
                counted += &format!("(t + ({:?}))", self.later);
            } else {
                counted.push(*letter);
            }
        }
        counted
    }
}

pub(crate) fn parse(text: &str, purpose: Purpose, d: usize) -> Expression {
    let particle = |name: &str| name.strip_prefix('p')?.parse().ok().map(crate::systems::id);
    let scope = Scope::new(purpose, dimension(d), &particle);
    Expression::parse(text, &scope).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// C_t of every row: Ċ − J q̇.
pub(crate) fn slopes_in_time(terms: &Terms) -> Vec<f64> {
    let moved = crate::systems::dense::multiply(&terms.jacobian.to_dense(), &terms.velocities);
    terms.residual_rate.iter().zip(moved).map(|(rate, moved)| rate - moved).collect()
}

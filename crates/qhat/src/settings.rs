//! Every number that a user may tune, with unit, default and valid range.

use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// The method that carries a state over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Integrator {
    /// Explicit Euler, order 1. It drifts off the constraints and gains energy: it shows why [`Feedback`] exists.
    Euler,
    /// Velocities first, then positions with the new velocities, order 1. Keeps energy bounded where Euler does not.
    SymplecticEuler,
    /// The classical Runge–Kutta method, order 4. Drifts slowly off the constraints.
    Rk4,
    /// [`Integrator::Dop853`], or [`Integrator::Radau5`] where damping or stiffness bounds its substeps, or
    /// [`Integrator::Bdf2`] where neither can follow a frame with the work allowed.
    #[default]
    Auto,
    /// Störmer–Verlet on C(q) = 0 with velocities on Ċ = 0, order 2, symmetric; substeps of its own choosing.
    Rattle,
    /// Runge–Kutta of order 5 on the equation, projected after each step; substeps of its own choosing.
    Dopri5,
    /// Runge–Kutta of order 8 on the equation, projected after each step; substeps of its own choosing.
    Dop853,
    /// Radau IIA of order 5, solved at the end of each substep, projected; substeps of its own choosing, which no
    /// stiffness bounds.
    Radau5,
    /// Backward Euler solved at the end of the step, order 1, projected: takes any load at any h, and dissipates.
    #[cfg_attr(feature = "serde", serde(alias = "backward-euler"))]
    Implicit,
    /// The backward differentiation formula of order 2, projected, with backward Euler for its hard steps.
    Bdf2,
}

impl Integrator {
    /// All of them.
    pub const ALL: [Integrator; 10] = [
        Integrator::Euler,
        Integrator::SymplecticEuler,
        Integrator::Rk4,
        Integrator::Auto,
        Integrator::Rattle,
        Integrator::Dopri5,
        Integrator::Dop853,
        Integrator::Radau5,
        Integrator::Implicit,
        Integrator::Bdf2,
    ];

    /// Names beside those of [`Integrator::name`]: the name of the method in books, beside the word of scenes.
    const SYNONYMS: [(&str, Integrator); 1] = [("backward-euler", Integrator::Implicit)];

    /// Every name by which a scene or a command may choose an integrator, with the integrator. The names that reports
    /// use come first.
    pub fn names() -> impl Iterator<Item = (&'static str, Integrator)> {
        Integrator::ALL.into_iter().map(|integrator| (integrator.name(), integrator)).chain(Integrator::SYNONYMS)
    }

    /// The name in scene files and commands.
    pub fn name(self) -> &'static str {
        match self {
            Integrator::Euler => "euler",
            Integrator::SymplecticEuler => "symplectic-euler",
            Integrator::Rk4 => "rk4",
            Integrator::Auto => "auto",
            Integrator::Rattle => "rattle",
            Integrator::Dopri5 => "dopri5",
            Integrator::Dop853 => "dop853",
            Integrator::Radau5 => "radau5",
            Integrator::Implicit => "implicit",
            Integrator::Bdf2 => "bdf2",
        }
    }

    /// Whether the integrator chooses its own substeps within a frame of h; otherwise its steps are exactly h.
    pub fn is_adaptive(self) -> bool {
        matches!(
            self,
            Integrator::Auto | Integrator::Rattle | Integrator::Dopri5 | Integrator::Dop853 | Integrator::Radau5
        )
    }

    /// Whether the integrator finds the time of an event, such as a contact that closes or a rod that breaks.
    pub fn finds_events(self) -> bool {
        matches!(self, Integrator::Auto | Integrator::Dopri5 | Integrator::Dop853)
    }

    /// Whether a frame of h is one step, solved at its end and halved only in need.
    pub fn is_implicit(self) -> bool {
        matches!(self, Integrator::Implicit | Integrator::Bdf2)
    }

    /// Whether the integrator holds C = 0 and Ċ = 0 itself; otherwise it relies on [`Feedback`].
    pub fn projects(self) -> bool {
        self.is_adaptive() || self.is_implicit()
    }

    /// What keeps more of the energy where this integrator lost or gained some, as the end of a sentence.
    pub fn energy_advice(self) -> &'static str {
        if self.is_adaptive() {
            "a smaller tolerance keeps more of it"
        } else if self.is_implicit() {
            "this method damps motion that is fast for its h, a smaller h damps less, and dop853 follows such motion"
        } else {
            "h is too long for this motion, a smaller h keeps more of it, and auto chooses its own substeps"
        }
    }

    /// Global order of convergence in h; of auto that of dop853.
    pub fn order(self) -> u32 {
        match self {
            Integrator::Euler | Integrator::SymplecticEuler | Integrator::Implicit => 1,
            Integrator::Rattle | Integrator::Bdf2 => 2,
            Integrator::Rk4 => 4,
            Integrator::Dopri5 | Integrator::Radau5 => 5,
            Integrator::Dop853 | Integrator::Auto => 8,
        }
    }
}

impl fmt::Display for Integrator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Integrator {
    type Err = SettingsError;

    fn from_str(name: &str) -> Result<Self, SettingsError> {
        let found = Integrator::names().find(|(known, _)| *known == name).map(|(_, integrator)| integrator);
        found.ok_or_else(|| SettingsError::UnknownIntegrator { name: name.to_owned() })
    }
}

/// The terms that keep a drifting integrator near C = 0 (ks and kd) and soften the constraints (diagonal drag and
/// elasticity). Integrators that project use none of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
pub struct Feedback {
    /// ks [1/s²], ≥ 0, default 0: pulls C to zero.
    pub ks: f64,
    /// kd [1/s], ≥ 0, default 0: pulls Ċ to zero.
    pub kd: f64,
    /// ε [units of A], ≥ 0, default 0: added to the diagonal of A, so that a singular A can be solved; softens every
    /// row.
    pub diagonal_drag: f64,
    /// In [0, 1), default 0: the constraint force is scaled by s = 1 − elasticity.
    pub elasticity: f64,
}

impl Feedback {
    /// The bare equation.
    pub const NONE: Feedback = Feedback { ks: 0.0, kd: 0.0, diagonal_drag: 0.0, elasticity: 0.0 };

    /// Whether every number is in its range.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(&self) -> Result<(), SettingsError> {
        let terms = [("ks", self.ks), ("kd", self.kd), ("diagonal_drag", self.diagonal_drag)];
        for (name, value) in terms {
            in_range(name, value, value >= 0.0, "finite and not negative")?;
        }
        in_range("elasticity", self.elasticity, (0.0..1.0).contains(&self.elasticity), "at least 0 and below 1")
    }
}

/// The settings of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
pub struct Settings {
    /// h \[s\], > 0, default 0.01: the step of a fixed-step integrator, the frame of an adaptive one.
    pub h: f64,
    /// Default [`Integrator::Auto`].
    pub integrator: Integrator,
    /// Of adaptive integrators: relative error of a substep, in (0, 1), default 1e-7.
    pub tolerance: f64,
    /// Of every projection: |C| relative to the row's own scale (a rod's length), in [1e-14, 1e-2], default 1e-10.
    pub constraint_tolerance: f64,
    /// Of adaptive integrators: substeps in one frame after which they give up, ≥ 1, default 200 000.
    pub max_substeps: usize,
    /// Of implicit and bdf2: Newton iterations a frame, ≥ 1, default 10 000. A count and not a time, so that the same
    /// input gives the same bits; when it is spent the frame ends with what was reached, and a warning says how far
    /// that is.
    pub frame_budget: usize,
    /// Of auto: row solves a frame before bdf2 takes the place of dop853 and radau5, ≥ 1, default 20 million. A row
    /// takes some 5 ns in a chain, and counts sixteenfold in anything else: at the default a frame waits for some
    /// tenths of a second. A page that is to be in time takes a million.
    pub frame_work: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            h: 0.01,
            integrator: Integrator::default(),
            tolerance: 1e-7,
            constraint_tolerance: 1e-10,
            max_substeps: 200_000,
            frame_budget: 10_000,
            frame_work: 20_000_000,
        }
    }
}

impl Settings {
    /// The feedback that acts: that of the system, or none under an integrator that projects.
    pub(crate) fn feedback_in_use(&self, feedback: Feedback) -> Feedback {
        if self.integrator.projects() { Feedback::NONE } else { feedback }
    }

    /// Whether every number is in its range.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(&self) -> Result<(), SettingsError> {
        in_range("h", self.h, self.h > 0.0, "finite and positive")?;
        in_range("tolerance", self.tolerance, self.tolerance > 0.0 && self.tolerance < 1.0, "between 0 and 1")?;
        let tolerance = self.constraint_tolerance;
        in_range("constraint_tolerance", tolerance, (1e-14..=1e-2).contains(&tolerance), "from 1e-14 to 1e-2")?;
        let substeps = self.max_substeps;
        in_range("max_substeps", substeps as f64, substeps >= 1, "at least 1")?;
        let budget = self.frame_budget;
        in_range("frame_budget", budget as f64, budget >= 1, "at least 1")?;
        let work = self.frame_work;
        in_range("frame_work", work as f64, work >= 1, "at least 1")
    }

    /// The number of steps of h in a frame \[s\], for an integrator with fixed steps.
    ///
    /// # Errors
    /// If they do not fill the frame, to a billionth of a step (a frame is a quotient of two numbers a user typed).
    pub fn steps_in(&self, frame: f64) -> Result<usize, SettingsError> {
        let steps = (frame / self.h).round();
        if steps >= 1.0 && (frame / self.h - steps).abs() <= 1e-9 * steps {
            Ok(steps as usize)
        } else {
            Err(SettingsError::FrameNotMultiple { frame, h: self.h })
        }
    }
}

/// `Ok` if a setting is finite and within its range; otherwise an error that names the setting and the range.
fn in_range(name: &'static str, value: f64, allowed: bool, range: &'static str) -> Result<(), SettingsError> {
    if value.is_finite() && allowed { Ok(()) } else { Err(SettingsError::OutOfRange { name, value, range }) }
}

/// The reason for which a setting is refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SettingsError {
    /// A number outside its range.
    #[error("{name} must be {range}, but is {value}")]
    OutOfRange {
        /// The setting.
        name: &'static str,
        /// The value that was given.
        value: f64,
        /// The values that are allowed, in words.
        range: &'static str,
    },
    /// An integrator that does not exist.
    #[error("there is no integrator `{name}`; use one of {}", Integrator::ALL.map(Integrator::name).join(", "))]
    UnknownIntegrator {
        /// The name that was given.
        name: String,
    },
    /// A frame that steps of h do not fill.
    #[error("a frame of {frame} s is no multiple of the step h = {h} s: choose an h that divides it")]
    FrameNotMultiple {
        /// Length of the frame \[s\].
        frame: f64,
        /// The step \[s\].
        h: f64,
    },
}

//! The settings under which qhat is measured. To measure another integrator or tolerance, add it here.

use crate::workload::Workload;
use qhat::{Integrator, Settings};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// Integrators that hold C = 0, each with tolerances from loose to tight.
pub const SETTINGS: [(Integrator, &[f64]); 6] = [
    (Integrator::Rattle, &[1e-3, 1e-4, 1e-5]),
    (Integrator::Dopri5, &[1e-3, 1e-4, 1e-6]),
    (Integrator::Dop853, &[1e-3, 1e-4, 1e-6]),
    (Integrator::Radau5, &[1e-3, 1e-4, 1e-6]),
    // These integrators ignore the tolerance; their step is the frame.
    (Integrator::Implicit, &[1e-4]),
    (Integrator::Bdf2, &[1e-4]),
];

/// An integrator and its tolerance. Written `dop853:1e-4`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The integrator.
    pub integrator: Integrator,
    /// Relative error of a substep.
    pub tolerance: f64,
}

/// The tolerance of large workloads.
const OF_LARGE: f64 = 1e-4;

/// The settings of a workload, in the order of [`SETTINGS`]. A large workload has one tolerance only, because it
/// measures the cost of a step.
pub fn settings(workload: &Workload) -> Vec<Setting> {
    let each = |(integrator, tolerances): (Integrator, &'static [f64])| {
        tolerances.iter().map(move |&tolerance| Setting { integrator, tolerance })
    };
    let wanted = |setting: &Setting| !workload.is_large() || setting.tolerance == OF_LARGE;
    SETTINGS.into_iter().flat_map(each).filter(wanted).collect()
}

impl Setting {
    /// The settings for frames of this length \[s\].
    pub fn settings(&self, frame: f64) -> Settings {
        Settings { h: frame, integrator: self.integrator, tolerance: self.tolerance, ..Settings::default() }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&format!("{}:{:e}", self.integrator, self.tolerance))
    }
}

/// The error for words that are no setting.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("`{words}` is no setting; write an integrator and a tolerance as in dop853:1e-4")]
pub struct UnknownSetting {
    /// The words that were given.
    pub words: String,
}

impl FromStr for Setting {
    type Err = UnknownSetting;

    fn from_str(words: &str) -> Result<Self, UnknownSetting> {
        let unknown = || UnknownSetting { words: words.to_owned() };
        let (integrator, tolerance) = words.split_once(':').ok_or_else(unknown)?;
        let integrator = integrator.parse().map_err(|_| unknown())?;
        let tolerance = tolerance.parse().map_err(|_| unknown())?;
        let setting = Setting { integrator, tolerance };
        setting.settings(1.0).check().map_err(|_| unknown())?;
        Ok(setting)
    }
}

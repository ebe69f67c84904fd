//! Touch and rest: the distances, times and speeds below which a contact counts as touching or at rest.

use crate::point::largest;

/// Gap below which an open contact touches, in constraint tolerances: twice what its event function may be off at the
/// event.
pub(crate) const TOUCH_DISTANCE: f64 = 2.0;

/// The distances, times and speeds below which a contact counts as touching or at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestThresholds {
    /// Gap below which an open contact touches, relative to the row's scale.
    pub(crate) touch_distance: f64,
    /// The rest time [s]: an impact whose flight would be shorter gives nothing back. `None`: no impact gives
    /// anything back.
    pub(crate) shortest_flight: Option<f64>,
    /// The length of a frame [s].
    pub(crate) frame: f64,
}

/// The rest speed [m/s]: a billionth of the fastest particle, or of the change of velocity by the applied forces in one
/// frame. A slower slip or approach counts as zero.
pub(crate) fn rest_speed(qd: &[f64], WQ: &[f64], frame: f64) -> f64 {
    1e-9 * largest(qd).max(frame * largest(WQ))
}

//! The numbers of an event that every format writes.

use qhat::{Event, EventKind};

/// The closing speed of an impact [m/s]; 0 for an event of another kind.
pub(super) fn speed(event: &Event) -> f64 {
    if let EventKind::Impact { speed } = event.kind { speed } else { 0.0 }
}

//! Crossing: substeps that lead across a position where the rank of A drops.
//!
//! Such a position lies on the way of a parallelogram that is folded flat. The motion is smooth there, but near it the
//! multipliers are ill determined: at an angle σ between a row and the others, an error δ of C changes q by δ/σ, q̇ by
//! δ/σ² and q̈ by δ/σ³ times the rate at which σ changes. So no stage of a substep should come near it. The stages of a
//! pair leave gaps, and the position is put into the middle of the longest one:
//!
//! ```text
//! t                 t + T                    t + H
//! |──────────────────×────────────────────────|        T = m H      m: the middle of the longest gap, as a part of H
//! ```
//!
//! A substep before it ends where T = m H holds for an H that the error estimate allows and the frame has room for.

/// A substep up to this part longer than proposed is taken at once.
const STRETCH: f64 = 1.05;

/// Part of a substep below which only its first stage is near: the second is at a twentieth or later.
const CLOSE: f64 = 0.01;

/// The length of the next substep, `time` before a singular position, where `h` is proposed; `None` where it is not
/// near.
pub(super) fn crossing(time: f64, h: f64, remaining: f64, middle: f64) -> Option<f64> {
    if time >= remaining || time >= (1.0 + middle) * h || time < CLOSE * h {
        return None;
    }
    let across = h.min((remaining - time) / (1.0 - middle));
    if time <= STRETCH * middle * across {
        return Some(time / middle);
    }
    Some((time - middle * across).min(h))
}

//! Numbers that a user gave, held against what is allowed.

/// `Ok` if the number is finite; otherwise a sentence that names it.
pub(crate) fn finite(what: &str, value: f64) -> Result<(), String> {
    if value.is_finite() { Ok(()) } else { Err(format!("{what} must be a finite number, not {value}")) }
}

/// `Ok` if the number is finite and not negative; otherwise a sentence that names it.
pub(crate) fn not_negative(what: &str, value: f64) -> Result<(), String> {
    finite(what, value)?;
    if value >= 0.0 { Ok(()) } else { Err(format!("{what} must not be negative, but is {value}")) }
}

/// Refuses any number of dimensions but one.
pub(crate) fn only_in(wanted: usize, dimension: usize) -> Result<(), String> {
    if wanted == dimension {
        Ok(())
    } else {
        Err(format!("it is written for {wanted} dimensions, but the system has {dimension}"))
    }
}

pub(crate) fn check_restitution(restitution: f64) -> Result<(), String> {
    if (0.0..=1.0).contains(&restitution) {
        Ok(())
    } else {
        Err(format!("a restitution must lie between 0 (no bounce) and 1 (nothing lost), but is {restitution}"))
    }
}

pub(crate) fn check_strength(breaks_at: Option<f64>) -> Result<(), String> {
    match breaks_at {
        Some(limit) if !(limit.is_finite() && limit > 0.0) => {
            Err(format!("the tension at which something breaks must be positive and finite, but is {limit}"))
        }
        _ => Ok(()),
    }
}

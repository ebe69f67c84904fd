//! Numbers for people: few digits, a typographic minus sign, and powers of ten in place of long rows of zeros.

const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// A number with the given number of digits.
pub(super) fn format(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    if (1e-3..1e5).contains(&value.abs()) {
        let rounded: f64 = scientific.parse().unwrap_or(value);
        return rounded.to_string().replace('-', "−");
    }
    let trimmed = mantissa.trim_end_matches('0').trim_end_matches('.');
    let power: String = exponent.chars().map(|c| c.to_digit(10).map_or('⁻', |d| SUPERSCRIPTS[d as usize])).collect();
    format!("{trimmed}·10{power}").replace('-', "−")
}

/// The least of the numbers 1, 2, 5 × 10ⁿ that is not below a size: the end of a scale.
pub(super) fn nice_ceiling(size: f64) -> f64 {
    if !(size > 0.0 && size.is_finite()) {
        return 1.0;
    }
    // Rust prints the shortest decimal form and reads it back exactly. Powers computed with `powi` could be rounded.
    let scientific = format!("{size:e}");
    let exponent: i32 = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    let steps = [(1, exponent), (2, exponent), (5, exponent), (1, exponent + 1)];
    let candidates = steps.map(|(step, exponent)| format!("{step}e{exponent}").parse().unwrap_or(size));
    // A size that equals such a number up to rounding gets this number and not the next.
    candidates.into_iter().find(|candidate| *candidate >= size * (1.0 - 1e-12)).unwrap_or(size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits_and_scales_end_at_round_ones() {
        let said = [0.0, 12.3456, -0.5, 123_456.0, -2.5e-7, 99_990.0, f64::NAN].map(|value| format(value, 3));
        assert_eq!(said, ["0", "12.3", "−0.5", "1.23·10⁵", "−2.5·10⁻⁷", "100000", "–"]);
        let ends = [0.3, 1.0, 1.1, 2.1, 7.0, 432.0, 3e-5, 0.0, f64::INFINITY].map(nice_ceiling);
        assert_eq!(ends, [0.5, 1.0, 2.0, 5.0, 10.0, 500.0, 5e-5, 1.0, 1.0]);
    }
}

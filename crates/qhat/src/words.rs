//! Numbers in messages: as many digits as a reader needs.

use std::fmt;

/// Significant digits of a time: the roundoff of a sum of ten thousand steps stays below them.
const DIGITS_OF_TIME: usize = 12;

/// A time below this is shown with an exponent [s].
const SHORT: f64 = 1e-4;

/// A time \[s\] for a message: all the digits that it needs, without the roundoff of the sum that it came from.
///
/// ```
/// # use qhat::Seconds;
/// assert_eq!(Seconds(0.1 + 0.2).to_string(), "0.3");
/// assert_eq!(Seconds(3.8e-13).to_string(), "3.8e-13");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seconds(pub f64);

impl fmt::Display for Seconds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded: f64 = format!("{:.*e}", DIGITS_OF_TIME - 1, self.0).parse().unwrap_or(self.0);
        if rounded != 0.0 && rounded.abs() < SHORT { write!(f, "{rounded:e}") } else { write!(f, "{rounded}") }
    }
}

/// A number for a message, in three significant digits; very large and very small ones with an exponent.
///
/// ```
/// # use qhat::Digits;
/// assert_eq!(Digits(0.012345).to_string(), "0.0123");
/// assert_eq!(Digits(123456.0).to_string(), "1.23e5");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Digits(pub f64);

impl fmt::Display for Digits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == 0.0 {
            return f.write_str("0");
        }
        let short = format!("{:.2e}", self.0);
        let exponent = short.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
        match (exponent, short.parse::<f64>()) {
            (Some(exponent @ -3..=3), Ok(value)) => write!(f, "{value:.*}", (2 - exponent).max(0) as usize),
            (None, _) => write!(f, "{}", self.0),
            _ => f.write_str(&short),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_has_the_digits_that_it_needs() {
        let sum = (0..10_000).fold(0.0, |sum, _| sum + 1e-3);
        assert!(sum != 10.0, "a sum with roundoff: {sum:?}");
        assert_eq!(Seconds(sum).to_string(), "10");
        assert_eq!(Seconds(2.689395014).to_string(), "2.689395014");
        assert_eq!(Seconds(0.0).to_string(), "0");
        assert_eq!(Seconds(-1.5e-9).to_string(), "-1.5e-9");
        assert_eq!(Seconds(f64::NAN).to_string(), "NaN");
    }

    #[test]
    fn a_number_has_three_digits() {
        for (number, shown) in [
            (0.0, "0"),
            (1.0, "1.00"),
            (-9.996, "-10.0"),
            (999.6, "1000"),
            (0.001, "0.00100"),
            (9.99e-4, "9.99e-4"),
            (6.02214e23, "6.02e23"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(Digits(number).to_string(), shown);
        }
    }
}

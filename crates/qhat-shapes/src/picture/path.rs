//! A path: lines and curves in the commands of SVG.

use std::f64::consts::TAU;
use std::fmt::Write;

/// A point of the picture \[px\], y down.
pub(super) type Spot = [f64; 2];

/// A coordinate in hundredths of a pixel, without zeros at its end.
pub(super) fn number(value: f64) -> String {
    // Points beyond 1e6 px are far outside the picture, and readers of SVG use numbers of 32 bits.
    let value = if value.is_finite() { value.clamp(-1e6, 1e6) } else { 0.0 };
    let hundredths = (100.0 * value).round() / 100.0;
    // Adding 0 turns −0 into 0.
    (hundredths + 0.0).to_string()
}

/// Lines and curves drawn with one stroke.
#[derive(Debug, Default)]
pub(super) struct Path(String);

impl Path {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn letters(&self) -> &str {
        &self.0
    }

    pub(super) fn go(&mut self, to: Spot) {
        self.add('M', &to);
    }

    pub(super) fn line(&mut self, to: Spot) {
        self.add('L', &to);
    }

    /// A quadratic curve to a spot, with a control point.
    pub(super) fn curve(&mut self, control: Spot, to: Spot) {
        self.add('Q', &[control[0], control[1], to[0], to[1]]);
    }

    pub(super) fn close(&mut self) {
        self.0.push('Z');
    }

    pub(super) fn segment(&mut self, from: Spot, to: Spot) {
        self.go(from);
        self.line(to);
    }

    /// Straight from spot to spot.
    pub(super) fn polygon(&mut self, spots: impl IntoIterator<Item = Spot>) {
        for (i, spot) in spots.into_iter().enumerate() {
            if i == 0 { self.go(spot) } else { self.line(spot) }
        }
    }

    pub(super) fn circle(&mut self, [x, y]: Spot, radius: f64) {
        self.go([x + radius, y]);
        for side in [-1.0, 1.0] {
            // Two half circles, because the ends of a full circle do not determine its centre.
            self.add('A', &[radius, radius, 0.0, 1.0, 1.0, x + side * radius, y]);
        }
        self.close();
    }

    /// Along a circle, from an angle over at most half a turn \[rad\]; angles count from x to y, which is clockwise in
    /// the picture.
    pub(super) fn arc(&mut self, [x, y]: Spot, radius: f64, from: f64, turn: f64) {
        let at = |angle: f64| [x + radius * angle.cos(), y + radius * angle.sin()];
        self.go(at(from));
        let [ex, ey] = at(from + turn);
        let large = if turn.abs() > 0.5 * TAU { 1.0 } else { 0.0 };
        self.add('A', &[radius, radius, 0.0, large, if turn > 0.0 { 1.0 } else { 0.0 }, ex, ey]);
    }

    fn add(&mut self, letter: char, numbers: &[f64]) {
        let numbers: Vec<String> = numbers.iter().map(|&value| number(value)).collect();
        // Writing to a string cannot fail.
        let _ = write!(self.0, "{letter}{}", numbers.join(" "));
    }
}

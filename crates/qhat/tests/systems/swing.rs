//! Periods: by the complete elliptic integral, and as simulated.

use super::G;
use qhat::Simulation;

/// T = 4 √(L/g) K(sin(θ₀/2)) = 2π √(L/g) / agm(1, cos(θ₀/2)) [s]; L [m] is I/(m c) for a body that hangs at the
/// distance c from its centre.
pub fn period(length: f64, amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, libm::cos(0.5 * amplitude));
    for _ in 0..10 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt()); // converges quadratically
    }
    2.0 * std::f64::consts::PI * length.sqrt() / (G.sqrt() * a)
}

/// The mean period over `count` swings: a coordinate's passages through zero from below, located inside a frame by the
/// cubic through x and ẋ at both ends (error h⁴/384 of the fourth derivative, below 1e-12 s here).
pub fn measured(mut simulation: Simulation, coordinate: usize, count: usize) -> f64 {
    let mut passages: Vec<f64> = Vec::new();
    let look =
        |s: &Simulation| (s.state().time(), s.state().positions()[coordinate], s.state().velocities()[coordinate]);
    let mut before = look(&simulation);
    while passages.len() <= count {
        simulation.step().unwrap();
        let after = look(&simulation);
        if before.1 < 0.0 && after.1 >= 0.0 {
            passages.push(zero(before, after));
        }
        before = after;
    }
    (passages[count] - passages[0]) / count as f64
}

/// The zero of the cubic Hermite polynomial between two moments (t, x, ẋ), by bisection.
fn zero((t0, x0, v0): (f64, f64, f64), (t1, x1, v1): (f64, f64, f64)) -> f64 {
    let h = t1 - t0;
    let x = |s: f64| {
        let (r, left, right) = (1.0 - s, h * s * (1.0 - s) * (1.0 - s), h * s * s * (1.0 - s));
        x0 * r * r * (1.0 + 2.0 * s) + left * v0 + x1 * s * s * (3.0 - 2.0 * s) - right * v1
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if x(middle) < 0.0 { low = middle } else { high = middle }
    }
    t0 + low * h
}

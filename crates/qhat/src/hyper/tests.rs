//! Every function of hyper-dual numbers against differences, and against the same as an expression.

use super::*;
use crate::expression::{Expression, Purpose, Scope};
use crate::point::Motion;
use crate::space::{Dimension, ParticleId};

type Function = fn(Hyper, Hyper, Hyper) -> Hyper;

/// A function of x, y and t, and the same as text, where the language has it. All are smooth near (0.7, −0.4) and t =
/// 0.3.
const FUNCTIONS: [(Function, &str); 17] = [
    (|x, y, t| x * y - 2.0 * t / y + (x - 1.0) * 3.0 + 4.0 - x / 7.0, "x*y - 2*t/y + (x - 1)*3 + 4 - x/7"),
    (|x, y, t| (x * x + y * y + t).sqrt(), "sqrt(x*x + y*y + t)"),
    (|x, y, t| (x * y - t).abs(), "abs(x*y - t)"),
    (|x, y, t| (x * y - t).sin(), "sin(x*y - t)"),
    (|x, y, t| (x * y - t).cos(), "cos(x*y - t)"),
    (|x, y, t| (x * y - t).tan(), "tan(x*y - t)"),
    (|x, y, t| (x * y - t).asin(), "asin(x*y - t)"),
    (|x, y, t| (x * y - t).acos(), "acos(x*y - t)"),
    (|x, y, t| (x * y - t).atan(), "atan(x*y - t)"),
    (|x, y, t| (y + t * t).atan2(x * x), "atan2(y + t*t, x*x)"),
    (|x, y, t| (x * y - t).exp(), "exp(x*y - t)"),
    (|x, y, t| (x - y * t).ln(), "ln(x - y*t)"),
    (|x, y, t| x.hypot(y * t), "sqrt(x^2 + (y*t)^2)"),
    (|x, y, t| (x * y).powi(5) - (y * t).powi(-3) + x.powi(0) * y.powi(1), "(x*y)^5 - (y*t)^(-3) + y"),
    (|x, y, t| (x - y).powf(2.5) * y.powf(2.0) * (x * t).powf(-0.3), "(x - y)^2.5*y^2*(x*t)^(-0.3)"),
    (|x, y, t| [x, y, t * t].into_iter().sum(), "x + y + t*t"),
    (
        |x, y, t| {
            let mut sum = x;
            sum += y * t;
            sum *= 2.0;
            sum -= t;
            sum /= x;
            -sum
        },
        "-((x + y*t)*2 - t)/x",
    ),
];

const PARTICLES: [ParticleId; 1] = [ParticleId(0)];
const Q: [f64; 2] = [0.7, -0.4];
const QD: [f64; 2] = [0.9, 1.3];
const T: f64 = 0.3;

fn motion() -> Motion<'static, 2> {
    Motion { q: &Q, qd: &QD, t: T }
}

fn of(function: Function) -> impl Fn(&[[Hyper; 3]], Hyper) -> Hyper {
    move |x: &[[Hyper; 3]], t: Hyper| function(x[0][0], x[0][1], t)
}

fn close(what: &str, actual: f64, expected: f64, tolerance: f64) {
    assert!((actual - expected).abs() <= tolerance * (1.0 + expected.abs()), "{what}: {actual} is not {expected}");
}

#[test]
fn derivatives_are_those_of_the_same_expression() {
    for (function, text) in FUNCTIONS {
        let names = |name: &str| (name == "p").then_some(ParticleId(0));
        let scope = Scope::new(Purpose::Constraint, Dimension::Two, &names);
        let with_names: String = text
            .chars()
            .enumerate()
            .map(|(i, c)| match c {
                // The x of exp is part of a name.
                'x' if text[..i].ends_with('e') => "x".into(),
                'x' | 'y' => format!("p.{c}"),
                other => other.to_string(),
            })
            .collect();
        let twin = Expression::parse(&with_names, &scope).unwrap_or_else(|error| panic!("{with_names}: {error}"));
        let mut J = [0.0; 2];
        let (expected, by_time) = twin.jet_and_gradient(&Q, &QD, T, &mut J);
        let [value, first, second] = jet(of(function), &PARTICLES, motion());
        let (slopes, slope_of_time) = gradient(of(function), &PARTICLES, motion());
        // Both take some dozens of rounded operations, in other orders.
        let roundoff = 1e-13;
        close(text, value, expected.value, roundoff);
        close(text, first, expected.first, roundoff);
        close(text, second, expected.second, roundoff);
        close(text, slopes[0], J[0], roundoff);
        close(text, slopes[1], J[1], roundoff);
        close(text, slope_of_time, by_time, roundoff);
        let mut H = [[0.0; 2]; 2];
        twin.hessian_blocks(motion(), &mut |_, _, block| H = block);
        hessian_blocks(of(function), &PARTICLES, motion(), &mut |i, j, block| {
            assert_eq!((i, j), (0, 0));
            for k in 0..2 {
                for l in 0..2 {
                    close(text, block[k][l], H[k][l], roundoff);
                }
            }
        });
    }
}

#[test]
fn derivatives_are_quotients_of_differences() {
    // Central differences at 1e-5 are good to h² f‴ and ε/h; the largest f‴ here is some thousands, of (y t)^−3.
    let (h, good) = (1e-5, 1e-6);
    for (function, text) in FUNCTIONS {
        let slopes = |q: [f64; 2]| gradient::<2>(of(function), &PARTICLES, Motion { q: &q, qd: &QD, t: T }).0;
        let value = |q: [f64; 2]| jet::<2>(of(function), &PARTICLES, Motion { q: &q, qd: &QD, t: T })[0];
        let mut H = [[0.0; 2]; 2];
        hessian_blocks(of(function), &PARTICLES, motion(), &mut |_, _, block| H = block);
        for k in 0..2 {
            let moved = |by: f64| std::array::from_fn(|l| Q[l] + if l == k { by } else { 0.0 });
            close(text, slopes(Q)[k], (value(moved(h)) - value(moved(-h))) / (2.0 * h), good);
            for l in 0..2 {
                close(text, H[k][l], (slopes(moved(h))[l] - slopes(moved(-h))[l]) / (2.0 * h), good);
            }
        }
    }
}

/// Powers that are products have their derivatives at 0.
#[test]
fn whole_powers_are_exact_at_zero() {
    let at = Motion::<2> { q: &[0.0, 0.0], qd: &QD, t: T };
    for (power, bend) in [(0, 0.0), (1, 0.0), (2, 2.0), (3, 0.0)] {
        let square = |x: &[[Hyper; 3]], _: Hyper| x[0][0].powf(f64::from(power));
        let mut H = [[0.0; 2]; 2];
        hessian_blocks(square, &PARTICLES, at, &mut |_, _, block| H = block);
        assert_eq!(H, [[bend, 0.0], [0.0, 0.0]], "x^{power}");
        assert_eq!(gradient(square, &PARTICLES, at).0, [if power == 1 { 1.0 } else { 0.0 }, 0.0], "x^{power}");
    }
}

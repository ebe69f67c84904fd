//! DOPRI5: Dormand and Prince's explicit Runge–Kutta pair of orders 5 and 4; not symmetric.
//!
//! Seven solves of the equation a substep; the projection after it keeps the last from being the first of the next.
//! Cheaper than DOP853 where the frame bounds the substep: a net of 316 × 316 points in frames of 1/960 s takes 0.56
//! times the time (`benches/results/workloads.csv`).
//! Source: Dormand and Prince, A family of embedded Runge–Kutta formulae, J. Comput. Appl. Math. 6 (1980).

use super::pair::Pair;
use crate::integrate::runge_kutta::Tableau;

/// The pair: coefficients, and the weights b − b̂ whose combination with the slopes estimates the error.
pub(crate) static DOPRI5: Pair = Pair::new(
    5,
    Tableau::new(
        &[
            &[],
            &[1.0 / 5.0],
            &[3.0 / 40.0, 9.0 / 40.0],
            &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
            &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
            &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
            &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
        ],
        &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0, 0.0],
    ),
    &[71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0],
    None,
);

//! The times of the stages, by integrals that a method of its order solves without error.

use super::{Stages, advance};
use crate::chains::Projected;
use crate::drift::Drift;
use crate::integrate::adaptive::{dop853, dopri5};
use crate::integrate::field::{Field, Power};
use crate::integrate::fixed::rk4;
use crate::linalg::eight::F8;
use crate::settings::Settings;
use crate::state::State;

fn power(x: f64, exponent: i32) -> f64 {
    (0..exponent).map(|_| x).product()
}

/// q̈ = t^power: a slope depends on nothing but the time of its stage.
struct Clock {
    power: i32,
}

impl Field for Clock {
    fn blocks(&self) -> usize {
        1
    }

    fn begin(&mut self, _: &State, _: &mut [F8], _: &mut [F8]) {}

    fn end(&self, _: &[F8], _: &[F8], _: &mut State) {}

    fn accelerate(&mut self, _: &[F8], _: &[F8], t: f64, qdd: &mut [F8]) -> Option<Power> {
        qdd[0] = F8::splat(power(t, self.power));
        Some(Power::default())
    }

    fn project(&mut self, _: &mut [F8], _: &mut [F8], _: f64, _: &Settings) -> Projected {
        Projected::Met(0)
    }

    fn drift(&self, _: &[F8], _: &[F8]) -> Drift {
        Drift::default()
    }

    fn turn_back(&mut self) {}

    fn counted(&self, _: usize) -> F8 {
        F8::splat(1.0)
    }
}

/// A method of order p integrates t^(p−1) to q̇ and t^(p−2) to q without error, if its stages are at t + c_i h.
#[test]
fn stages_are_at_their_times() {
    let (t, h) = (0.7, 0.4);
    for (name, tableau, order) in
        [("rk4", &rk4::RK4, 4), ("dopri5", dopri5::DOPRI5.tableau(), 5), ("dop853", dop853::DOP853.tableau(), 8)]
    {
        for power in 0..order {
            let mut stages = Stages::new(1);
            advance(tableau, &mut Clock { power }, &mut stages, t, h).unwrap();
            let to = |p: i32| (self::power(t + h, p) - self::power(t, p)) / f64::from(p);
            // The tableaux are rounded, and a dozen terms of size one are added up.
            let allowed = 1e-14;
            let velocity = stages.next_qd[0].0[0];
            assert!((velocity - to(power + 1)).abs() < allowed, "{name}, t^{power}: q̇ = {velocity}");
            if power < order - 1 {
                let expected = (to(power + 2) - h * self::power(t, power + 1)) / f64::from(power + 1);
                let position = stages.next_q[0].0[0];
                assert!((position - expected).abs() < allowed, "{name}, t^{power}: q = {position}");
            }
        }
    }
}

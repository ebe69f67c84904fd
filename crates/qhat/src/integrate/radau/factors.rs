//! The two factors of a step's matrix, real and complex, and the solves with them.

use super::saddle::Saddle;
use super::tableau::{PAIR, REAL};
use crate::linalg::{Complex, Lu, Scalar};

/// The factors for one h.
#[derive(Clone, Debug)]
pub(super) struct Factors {
    real: Lu<f64>,
    complex: Lu<Complex>,
    x: Vec<f64>,
    z: Vec<Complex>,
    pub(super) factorizations: usize,
}

impl Factors {
    pub(super) fn new(saddle: &Saddle) -> Self {
        let (plan, n) = (&saddle.plan, saddle.unknowns());
        let (real, complex) = (Lu::new(plan), Lu::new(plan));
        Factors { real, complex, x: vec![0.0; n], z: vec![Complex::default(); n], factorizations: 0 }
    }

    /// Factors the matrix for a step of h, for both κ. Whether that was possible.
    pub(super) fn factor<const D: usize>(&mut self, saddle: &Saddle, h: f64) -> bool {
        let per_pair = PAIR.reciprocal() * Complex::real(h);
        self.factor_real::<D>(saddle, h)
            && self.complex.factor(&saddle.plan, |k, x| saddle.write::<D, Complex>(k, per_pair, x), |k| saddle.kind(k))
    }

    /// The same for the real κ alone.
    pub(super) fn factor_real<const D: usize>(&mut self, saddle: &Saddle, h: f64) -> bool {
        self.factorizations += 1;
        self.real.factor(&saddle.plan, |k, x| saddle.write::<D, f64>(k, h / REAL, x), |k| saddle.kind(k))
    }

    /// Solves the real system: one number for each unknown.
    pub(super) fn solve(&mut self, saddle: &Saddle, rhs: &mut [f64]) {
        for (x, &unknown) in self.x.iter_mut().zip(&saddle.plan.order) {
            *x = rhs[unknown as usize];
        }
        self.real.solve(&saddle.plan, &mut self.x);
        for (x, &unknown) in self.x.iter().zip(&saddle.plan.order) {
            rhs[unknown as usize] = *x;
        }
    }

    /// Solves the complex system: a real and an imaginary number for each unknown.
    pub(super) fn solve_pair(&mut self, saddle: &Saddle, re: &mut [f64], im: &mut [f64]) {
        for (z, &unknown) in self.z.iter_mut().zip(&saddle.plan.order) {
            *z = Complex { re: re[unknown as usize], im: im[unknown as usize] };
        }
        self.complex.solve(&saddle.plan, &mut self.z);
        for (z, &unknown) in self.z.iter().zip(&saddle.plan.order) {
            (re[unknown as usize], im[unknown as usize]) = (z.re, z.im);
        }
    }

    /// The rows that were left out of the last factorization, as places among the rows of unknowns.
    pub(super) fn left_out<'a>(&'a self, saddle: &'a Saddle) -> impl Iterator<Item = usize> + 'a {
        let first = saddle.velocities();
        let place = move |i: usize| saddle.plan.place[first + i] as usize;
        (0..saddle.rows.len()).filter(move |&i| self.real.is_left_out(place(i)))
    }
}

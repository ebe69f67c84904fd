//! + − × ÷ of hyper-dual numbers, among themselves and with f64.

use super::Hyper;
use crate::expression::Operation;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

impl Add for Hyper {
    type Output = Hyper;
    fn add(self, y: Hyper) -> Hyper {
        Hyper { value: self.value + y.value, a: self.a + y.a, b: self.b + y.b, ab: self.ab + y.ab }
    }
}

impl Sub for Hyper {
    type Output = Hyper;
    fn sub(self, y: Hyper) -> Hyper {
        Hyper { value: self.value - y.value, a: self.a - y.a, b: self.b - y.b, ab: self.ab - y.ab }
    }
}

impl Neg for Hyper {
    type Output = Hyper;
    fn neg(self) -> Hyper {
        Hyper { value: -self.value, a: -self.a, b: -self.b, ab: -self.ab }
    }
}

impl Mul for Hyper {
    type Output = Hyper;
    fn mul(self, y: Hyper) -> Hyper {
        Hyper {
            value: self.value * y.value,
            a: self.a * y.value + self.value * y.a,
            b: self.b * y.value + self.value * y.b,
            ab: self.ab * y.value + (self.a * y.b + self.b * y.a) + self.value * y.ab,
        }
    }
}

impl Div for Hyper {
    type Output = Hyper;
    fn div(self, y: Hyper) -> Hyper {
        self.combine(Operation::Divide, y)
    }
}

macro_rules! with_numbers {
    ($($operator:ident $function:ident $assign:ident $assign_function:ident;)*) => { $(
        impl $operator<f64> for Hyper {
            type Output = Hyper;
            fn $function(self, y: f64) -> Hyper { $operator::$function(self, Hyper::from(y)) }
        }

        impl $operator<Hyper> for f64 {
            type Output = Hyper;
            fn $function(self, y: Hyper) -> Hyper { $operator::$function(Hyper::from(self), y) }
        }

        impl<T: Into<Hyper>> $assign<T> for Hyper {
            fn $assign_function(&mut self, y: T) { *self = $operator::$function(*self, y.into()); }
        }
    )* };
}

with_numbers! {
    Add add AddAssign add_assign;
    Sub sub SubAssign sub_assign;
    Mul mul MulAssign mul_assign;
    Div div DivAssign div_assign;
}

impl Sum for Hyper {
    fn sum<I: Iterator<Item = Hyper>>(numbers: I) -> Hyper {
        numbers.fold(Hyper::default(), |sum, number| sum + number)
    }
}

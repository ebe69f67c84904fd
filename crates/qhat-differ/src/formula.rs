//! Formulas of positions, velocities and time: trees with their own text and their own derivatives.
//!
//! Every constraint, potential and force of the reference is such a tree. A number follows the motion for a short time
//! τ at constant velocity, so it carries a value and two derivatives:
//!
//! ```text
//! (f g)' = f'g + f g',   (f g)" = f"g + 2 f'g' + f g",   φ(f)' = φ'(f) f',   φ(f)" = φ'(f) f" + φ"(f) f'²
//! ```
//!
//! Along (q̇, 1) the two derivatives of C are Ċ and γ; along one coordinate the first derivative is an entry of J.

use std::ops::{Add, Mul, Sub};

/// A formula.
#[derive(Clone, Debug)]
pub enum Formula {
    /// A constant.
    Number(f64),
    /// A named constant of the scene.
    Parameter(String, f64),
    /// t \[s\].
    Time,
    /// A coordinate of a particle \[m\]: the number of the particle, the axis.
    Place(usize, usize),
    /// A component of the velocity of a particle [m/s].
    Speed(usize, usize),
    /// Two formulas joined by an operation.
    Joined(Join, Box<[Formula; 2]>),
    /// A function of a formula.
    Of(Function, Box<Formula>),
    /// A whole power of a formula, 2 or more.
    Power(Box<Formula>, u32),
    /// A formula that a scene writes by a word of the expression language: the text, and its meaning in coordinates.
    Written(String, Box<Formula>),
}

/// An operation on two numbers.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Join {
    Sum,
    Difference,
    Product,
    Quotient,
}

/// A function of one number.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Function {
    Sqrt,
    Sin,
    Cos,
    Exp,
    Ln,
    Atan,
}

impl Add for Formula {
    type Output = Formula;
    fn add(self, other: Formula) -> Formula {
        Formula::Joined(Join::Sum, Box::new([self, other]))
    }
}

impl Sub for Formula {
    type Output = Formula;
    fn sub(self, other: Formula) -> Formula {
        Formula::Joined(Join::Difference, Box::new([self, other]))
    }
}

impl Mul for Formula {
    type Output = Formula;
    fn mul(self, other: Formula) -> Formula {
        Formula::Joined(Join::Product, Box::new([self, other]))
    }
}

/// A constant.
pub fn number(value: f64) -> Formula {
    Formula::Number(value)
}

/// A function of a formula.
pub fn of(function: Function, inner: Formula) -> Formula {
    Formula::Of(function, Box::new(inner))
}

/// A whole power of a formula.
pub fn power(inner: Formula, exponent: u32) -> Formula {
    Formula::Power(Box::new(inner), exponent)
}

/// Σ (x_a − x_b)² over the axes \[m²\].
pub fn squared_distance(a: usize, b: usize, dimension: usize) -> Formula {
    let square = |axis| power(Formula::Place(a, axis) - Formula::Place(b, axis), 2);
    (1..dimension).fold(square(0), |sum, axis| sum + square(axis))
}

/// The distance between two particles \[m\].
pub fn distance(a: usize, b: usize, dimension: usize) -> Formula {
    of(Function::Sqrt, squared_distance(a, b, dimension))
}

/// A number with its first and second derivative by τ.
#[derive(Clone, Copy, Debug, Default)]
pub struct Along {
    /// The value.
    pub value: f64,
    /// The first derivative.
    pub first: f64,
    /// The second derivative.
    pub second: f64,
}

impl Along {
    fn through(self, value: f64, slope: f64, bend: f64) -> Along {
        Along { value, first: slope * self.first, second: slope * self.second + bend * self.first * self.first }
    }
}

/// A motion that passes through a state: q, q̇ and t, and the rates at which they change with τ.
#[derive(Clone, Copy, Debug)]
pub struct Passing<'a> {
    /// The number of dimensions.
    pub dimension: usize,
    /// q \[m\].
    pub q: &'a [f64],
    /// q̇ [m/s]: the value of velocities in a formula.
    pub qd: &'a [f64],
    /// t \[s\].
    pub t: f64,
    /// The direction in which the motion passes.
    pub along: Direction,
}

/// A direction through the space of positions and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// Nothing changes.
    Nowhere,
    /// Positions change by q̇, time by 1.
    Motion,
    /// One coordinate changes by 1.
    Coordinate(usize),
}

impl Formula {
    /// The value and its derivatives along a direction.
    pub fn follow(&self, at: Passing<'_>) -> Along {
        let constant = |value| Along { value, ..Along::default() };
        match self {
            Formula::Number(value) | Formula::Parameter(_, value) => constant(*value),
            Formula::Time => {
                let moves = at.along == Direction::Motion;
                Along { value: at.t, first: if moves { 1.0 } else { 0.0 }, second: 0.0 }
            }
            Formula::Place(particle, axis) => {
                let place = particle * at.dimension + axis;
                let first = match at.along {
                    Direction::Motion => at.qd[place],
                    Direction::Coordinate(moved) if moved == place => 1.0,
                    _ => 0.0,
                };
                Along { value: at.q[place], first, second: 0.0 }
            }
            Formula::Speed(particle, axis) => constant(at.qd[particle * at.dimension + axis]),
            Formula::Joined(join, two) => join.follow(two[0].follow(at), two[1].follow(at)),
            Formula::Of(function, inner) => function.follow(inner.follow(at)),
            Formula::Power(inner, exponent) => {
                let inner = inner.follow(at);
                let (x, n) = (inner.value, f64::from(*exponent));
                let less = |by: u32| (0..exponent - by).fold(1.0, |product, _| product * x);
                inner.through(less(0), n * less(1), n * (n - 1.0) * less(2))
            }
            Formula::Written(_, meaning) => meaning.follow(at),
        }
    }

    /// Calls `visit` with every particle that the formula names, as often as it names it.
    pub fn particles(&self, visit: &mut impl FnMut(usize)) {
        match self {
            Formula::Number(_) | Formula::Parameter(..) | Formula::Time => {}
            Formula::Place(particle, _) | Formula::Speed(particle, _) => visit(*particle),
            Formula::Joined(_, two) => two.iter().for_each(|one| one.particles(visit)),
            Formula::Of(_, inner) | Formula::Power(inner, _) | Formula::Written(_, inner) => inner.particles(visit),
        }
    }

    /// The text of the formula in the expression language.
    pub fn text(&self, names: &dyn Fn(usize) -> String) -> String {
        const AXES: [&str; 3] = ["x", "y", "z"];
        match self {
            Formula::Number(value) if *value < 0.0 => format!("({value:?})"),
            Formula::Number(value) => format!("{value:?}"),
            Formula::Parameter(name, _) => name.clone(),
            Formula::Time => "t".to_owned(),
            Formula::Place(particle, axis) => format!("{}.{}", names(*particle), AXES[*axis]),
            Formula::Speed(particle, axis) => format!("{}.v{}", names(*particle), AXES[*axis]),
            Formula::Joined(join, two) => {
                let [a, b] = [two[0].text(names), two[1].text(names)];
                match join {
                    Join::Sum => format!("({a} + {b})"),
                    Join::Difference => format!("({a} - {b})"),
                    Join::Product => format!("{a}*{b}"),
                    Join::Quotient => format!("({a}/({b}))"),
                }
            }
            Formula::Of(function, inner) => format!("{}({})", function.word(), inner.text(names)),
            Formula::Power(inner, exponent) => format!("({})^{exponent}", inner.text(names)),
            Formula::Written(text, _) => text.clone(),
        }
    }
}

impl Join {
    fn follow(self, a: Along, b: Along) -> Along {
        match self {
            Join::Sum => Along { value: a.value + b.value, first: a.first + b.first, second: a.second + b.second },
            Join::Difference => {
                Along { value: a.value - b.value, first: a.first - b.first, second: a.second - b.second }
            }
            Join::Product => Along {
                value: a.value * b.value,
                first: a.first * b.value + a.value * b.first,
                second: a.second * b.value + 2.0 * a.first * b.first + a.value * b.second,
            },
            Join::Quotient => {
                let x = b.value;
                Join::Product.follow(a, b.through(1.0 / x, -1.0 / (x * x), 2.0 / (x * x * x)))
            }
        }
    }
}

impl Function {
    fn follow(self, a: Along) -> Along {
        let x = a.value;
        match self {
            Function::Sqrt => {
                let root = x.sqrt();
                a.through(root, 0.5 / root, -0.25 / (x * root))
            }
            Function::Sin => a.through(libm::sin(x), libm::cos(x), -libm::sin(x)),
            Function::Cos => a.through(libm::cos(x), -libm::sin(x), -libm::cos(x)),
            Function::Exp => a.through(libm::exp(x), libm::exp(x), libm::exp(x)),
            Function::Ln => a.through(libm::log(x), 1.0 / x, -1.0 / (x * x)),
            Function::Atan => {
                let slope = 1.0 / (1.0 + x * x);
                a.through(libm::atan(x), slope, -2.0 * x * slope * slope)
            }
        }
    }

    fn word(self) -> &'static str {
        match self {
            Function::Sqrt => "sqrt",
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Exp => "exp",
            Function::Ln => "ln",
            Function::Atan => "atan",
        }
    }
}

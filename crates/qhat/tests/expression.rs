//! The expression language: the meaning of texts, the messages for texts that are refused, and that no text does harm.

use crate::systems::{self, random::dimension};
use proptest::prelude::*;
use qhat::expression::{MAX_BYTES, MAX_DEPTH, MAX_INSTRUCTIONS, MAX_NAMES, MAX_NODES, check_parameter};
use qhat::{Dimension, Expression, ExpressionError, Purpose, Scope};

/// Particles a, b, c and bob are 0 … 3; k and length0 are parameters; `both` is a particle and a parameter.
fn parse_in(text: &str, purpose: Purpose, dimension: Dimension) -> Result<Expression, ExpressionError> {
    let names = ["a", "b", "c", "bob", "both"];
    let particle = |name: &str| names.iter().position(|known| *known == name).map(crate::systems::id);
    let parameter = |name: &str| match name {
        "k" => Some(2.5),
        "length0" => Some(1.5),
        "both" => Some(1.0),
        _ => None,
    };
    // A simple suggestion, to see that it is asked for: the first known name that begins with the given name.
    let suggest = |given: &str, more: &[&'static str]| {
        let known = names.iter().chain(["k", "length0"].iter()).chain(more);
        let beginning = given.get(..given.len() - 1).filter(|beginning| !beginning.is_empty())?;
        known.copied().find(|name| name.starts_with(beginning)).map(String::from)
    };
    Expression::parse(
        text,
        &Scope { purpose, dimension, particle: &particle, parameter: &parameter, suggest: &suggest },
    )
}

fn parse(text: &str) -> Result<Expression, ExpressionError> {
    parse_in(text, Purpose::Constraint, Dimension::Two)
}

/// a = (1, 2), b = (4, 6), c = (−1, 0.5), bob = (0.5, −0.25).
const Q2: [f64; 8] = [1.0, 2.0, 4.0, 6.0, -1.0, 0.5, 0.5, -0.25];
const Q3: [f64; 12] = [1.0, 2.0, 3.0, 4.0, 6.0, 3.0, -1.0, 0.5, 2.0, 0.5, -0.25, 1.0];

fn value(text: &str) -> f64 {
    parse(text).unwrap_or_else(|error| panic!("{text}: {error}")).value(&Q2, &[], 0.5)
}

fn value3(text: &str) -> f64 {
    let parsed = parse_in(text, Purpose::Constraint, Dimension::Three);
    parsed.unwrap_or_else(|error| panic!("{text}: {error}")).value(&Q3, &[], 0.5)
}

#[test]
fn operators_bind_as_in_mathematics() {
    for (text, expected) in [
        ("-2^2", -4.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("2^-3^2", 1.0 / 512.0),
        ("(-2)^2", 4.0),
        ("--2", 2.0),
        ("2*-3+4", -2.0),
        ("8/4/2", 1.0),
        ("8-4-2", 2.0),
        ("1+2*3^2", 19.0),
        ("-a.y*3", -6.0),
        ("-a.y^2", -4.0),
        ("2-a.y^-2*4", 1.0),
        ("a.y^a.y^a.y", 16.0),
        ("(1 + 2)*(3 - 1)", 6.0),
        ("((a.x)) + dot((a), ([1, 0]))", 2.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn numbers_and_names_mean_what_they_say() {
    for (text, expected) in [
        ("2.5e-1", 0.25),
        (".5", 0.5),
        ("1.", 1.0),
        ("1E2", 100.0),
        ("pi", std::f64::consts::PI),
        ("tau", std::f64::consts::TAU),
        ("t", 0.5),
        ("k*length0", 3.75),
        ("bob.x + bob.y", 0.25),
        (" a . x", f64::NAN),
    ] {
        match parse(text) {
            Ok(parsed) => assert_eq!(parsed.value(&Q2, &[], 0.5), expected, "{text}"),
            Err(_) => assert!(expected.is_nan(), "{text}"),
        }
    }
    let force = parse_in("bob.vx - 2*bob.vy", Purpose::Force, Dimension::Two).unwrap();
    assert_eq!(force.value(&Q2, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.5], 0.0), 2.0);
}

#[test]
fn functions_of_numbers_are_those_of_libm() {
    let x = Q2[6];
    for (text, expected) in [
        ("sqrt(bob.x)", x.sqrt()),
        ("sin(bob.x)", libm::sin(x)),
        ("cos(bob.x)", libm::cos(x)),
        ("tan(bob.x)", libm::tan(x)),
        ("asin(bob.x)", libm::asin(x)),
        ("acos(bob.x)", libm::acos(x)),
        ("atan(bob.x)", libm::atan(x)),
        ("atan2(bob.y, bob.x)", libm::atan2(-0.25, x)),
        ("exp(bob.x)", libm::exp(x)),
        ("ln(bob.x)", libm::log(x)),
        ("abs(bob.y)", 0.25),
        ("min(bob.x, bob.y, 3)", -0.25),
        ("max(bob.x, bob.y)", 0.5),
        ("bob.x^1.5", libm::pow(x, 1.5)),
        ("bob.x^bob.y", libm::pow(x, -0.25)),
        ("bob.x^5", x * x * x * x * x),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn functions_of_points_are_those_of_geometry() {
    for (text, expected) in [
        ("dist(a, b)", 5.0),
        ("length(b - a)", 5.0),
        ("dot(a, b)", 16.0),
        ("cross(a, b)", -2.0),
        ("area([0, 0], [2, 0], [2, 1], [0, 1])", 2.0),
        ("area([0, 1], [2, 1], [2, 0], [0, 0])", -2.0),
        // A quadrilateral with moving corners: half of 3 · (−1.5) − 4 · (−2), and half of (−2) · (−2.25) − (−1.5) ·
        // (−0.5).
        ("area(a, b, c, bob)", 1.75 + 1.875),
        ("dot(2*a - b/2 + [1, 0], [1, 10])", 11.0),
        ("dot(-a*2, [1, 0])", -2.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
    for (text, expected) in [
        ("dist(a, b)", 5.0),
        ("volume([0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1])", 1.0 / 6.0),
        ("volume([0, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1])", -1.0 / 6.0),
        ("dot(cross(a, b), [1, 0, 0])", 2.0 * 3.0 - 3.0 * 6.0),
        ("dot(cross(a, b), [0, 1, 0])", 3.0 * 4.0 - 1.0 * 3.0),
        ("dot(cross(a, b), [0, 0, 1])", 1.0 * 6.0 - 2.0 * 4.0),
        ("a.z + bob.z", 4.0),
    ] {
        assert_eq!(value3(text), expected, "{text}");
    }
}

/// A rod as an expression is the rod of the engine, to roundoff of a few operations on numbers below 10.
#[test]
fn a_rod_has_the_derivatives_of_the_distance_constraint() {
    let rod = parse("dist(a, b) - 4").unwrap();
    assert_eq!(rod.particles(), [crate::systems::id(0), crate::systems::id(1)]);
    let qd = [0.3, -0.2, 0.5, 0.1, 0.0, 0.0, 0.0, 0.0];
    let mut J = [0.0; 4];
    let (C, C_t) = rod.jet_and_gradient(&Q2, &qd, 0.0, &mut J);
    let (n, u): ([f64; 2], [f64; 2]) = ([-0.6, -0.8], [-0.2, -0.3]);
    let along = n[0] * u[0] + n[1] * u[1];
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-15, "{a} {b}");
    close(C.value, 1.0);
    close(C.first, along);
    close(C.second, (u[0] * u[0] + u[1] * u[1] - along * along) / 5.0);
    assert_eq!(C_t, 0.0);
    for (entry, expected) in J.into_iter().zip([n[0], n[1], -n[0], -n[1]]) {
        close(entry, expected);
    }
    let mut H = [0.0; 16];
    rod.hessian(&Q2, &qd, 0.0, &mut H);
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let unit = if i % 2 == j % 2 { 1.0 } else { 0.0 };
        let sign = if i / 2 == j / 2 { 1.0 } else { -1.0 };
        close(H[4 * i + j], sign * (unit - n[i % 2] * n[j % 2]) / 5.0);
    }
}

#[test]
fn a_function_of_time_has_rate_and_second_derivative() {
    let length = parse_in("1 + sin(3*t)/10", Purpose::Time, Dimension::Two).unwrap();
    assert!(length.uses_time() && length.particles().is_empty());
    let jet = length.jet(&[], &[], 0.7);
    let expected = [1.0 + libm::sin(2.1) / 10.0, 0.3 * libm::cos(2.1), -0.9 * libm::sin(2.1)];
    for (is, expected) in [jet.value, jet.first, jet.second].into_iter().zip(expected) {
        assert!((is - expected).abs() < 1e-15, "{is} {expected}"); // a few roundings of numbers about 1
    }
    let (same, C_t) = length.jet_and_gradient(&[], &[], 0.7, &mut []);
    assert_eq!((same, C_t), (jet, jet.first));
}

/// At a kink the derivative is the derivative of one branch, and at the edge of a domain it is infinite.
#[test]
fn kinks_take_a_branch_and_edges_are_infinite() {
    let slope = |text: &str, x: f64| {
        let mut gradient = [0.0; 2];
        let parsed = parse(text).unwrap();
        let mut q = Q2;
        q[0] = x;
        let (jet, _) = parsed.jet_and_gradient(&q, &[1.0; 8], 0.0, &mut gradient);
        assert!(gradient[0].to_bits() == jet.first.to_bits(), "{text}: {gradient:?} {jet:?}");
        gradient[0]
    };
    assert_eq!(slope("abs(a.x)", 0.0), 1.0);
    assert_eq!(slope("abs(a.x)", -1e-300), -1.0);
    assert_eq!(slope("max(2*a.x, 3*a.x)", 0.0), 2.0);
    assert_eq!(slope("min(2*a.x, 3*a.x)", 0.0), 2.0);
    assert_eq!(slope("sqrt(a.x)", 0.0), f64::INFINITY);
    assert_eq!(slope("acos(a.x)", 1.0), f64::NEG_INFINITY);
    assert_eq!(slope("asin(a.x)", -1.0), f64::INFINITY);
    assert!(slope("ln(a.x)", -1.0).is_finite() && parse("ln(a.x)").unwrap().value(&[-1.0], &[], 0.0).is_nan());
    // Powers at base 0: the derivatives that exist are correct.
    assert_eq!(slope("a.x^1", 0.0), 1.0);
    assert_eq!(slope("a.x^2", 0.0), 0.0);
    assert_eq!(slope("a.x^1.5", 0.0), 0.0);
    assert_eq!(slope("a.x^(1 + k + t)", 0.0), 0.0);
    // The branch that is not taken may be infinite.
    assert_eq!(slope("max(a.x, sqrt(a.x) - 1)", 0.0), 1.0);
    // NaN stays NaN.
    for text in ["min(ln(a.x), 1)", "min(1, ln(a.x))", "max(ln(a.x), 1)", "max(1, ln(a.x))"] {
        assert!(parse(text).unwrap().value(&[-1.0], &[], 0.0).is_nan(), "{text}");
    }
}

#[test]
fn second_derivatives_of_powers_are_right_at_zero() {
    for (text, expected) in [("a.x^2", 2.0), ("a.x^3", 0.0), ("a.x^2.5", 0.0), ("a.x^1", 0.0)] {
        let parsed = parse(text).unwrap();
        assert_eq!(parsed.jet(&[0.0], &[1.0], 0.0).second, expected, "{text}");
        let mut H = [f64::NAN; 4];
        parsed.hessian(&[0.0], &[1.0], 0.0, &mut H);
        assert_eq!(H, [expected, 0.0, 0.0, 0.0], "{text}");
    }
}

#[test]
fn equal_parts_are_there_once_and_constants_are_folded() {
    for (text, count) in [
        ("2*3 + k", 1),
        ("sin(a.x)*sin(a.x)", 3),
        ("a.x*a.y - a.y*a.x", 4),
        // Four coordinates, two differences, two squares, sum, root, the length and the last difference.
        ("dist(a, b) - 1", 13),
        ("a.x^8", 4),
        ("dot(a, [1, 0])", 7),
    ] {
        let found = parse(text).unwrap().instruction_count();
        assert!(found <= count, "{text}: {found} instructions");
    }
    // Only coordinates that are used: the y of c is not used.
    let parsed = parse("c.x + a.y").unwrap();
    assert_eq!(parsed.particles(), [crate::systems::id(2), crate::systems::id(0)]);
    let mut J = [f64::NAN; 4];
    parsed.jet_and_gradient(&Q2, &[0.0; 8], 0.0, &mut J);
    assert_eq!(J, [1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn an_expression_gives_its_text_back_and_compares_by_content() {
    let text = " dist( a,b )-1 ";
    let parsed = parse(text).unwrap();
    assert_eq!(parsed.to_string(), text);
    assert_eq!(parsed.clone(), parse(text).unwrap());
    assert_ne!(parsed, parse("dist(a, b) - 2").unwrap());
}

/// A text, the part that is marked, the message, and the text to write instead.
const REFUSED: [(&str, &str, &str, &str); 47] = [
    ("", "", "the expression is empty", "write `0` for nothing"),
    ("a.x +", "+", "the expression ends after `+`", "a number, a name or a bracket must follow"),
    ("* a.x", "*", "an expression cannot begin with `*`", "a number, a name or a bracket must stand here"),
    ("2 ** 3", "*", "`*` cannot follow `*`", "write a power as `a^b`"),
    ("2 + + 3", "+", "`+` cannot follow `+`", "leave the `+` out"),
    ("2 a.x", "a.x", "an operator is missing between `2` and `a.x`", "write a product with `*`"),
    ("(a.x + 1", "(", "this `(` is never closed", "add a `)`"),
    ("dot(a, [1, 2)", ")", "this `)` closes nothing that was opened before it", "leave it out, or open it with a `(`"),
    ("a.x)", ")", "this `)` closes nothing that was opened before it", "leave it out, or open it with a `(`"),
    (
        "1,5",
        ",",
        "a comma separates the arguments of a function or the components of a point",
        "write a number with a point, `1.5`; several expressions are several texts",
    ),
    (
        "(1,5)",
        ",",
        "a comma separates the arguments of a function or the components of a point",
        "write a number with a point, `1.5`, and a point in square brackets, `[1, 2]`",
    ),
    (
        "a.x = 2",
        "=",
        "`=` has no meaning in an expression",
        "an expression is one side only: to hold a = b, write `a - b`",
    ),
    (
        "|a| - 1",
        "|",
        "`|` has no meaning in an expression",
        "write |a| as `abs(a)` for a number and as `length(a)` for a point",
    ),
    ("a.x − 1", "−", "`−` has no meaning in an expression", "write minus as `-`"),
    ("a.x²", "²", "`²` has no meaning in an expression", "write a square as `^2`"),
    ("a. x", ".", "`.` has no meaning in an expression", "a coordinate is written without spaces, `bob.x`"),
    (
        "\u{7}",
        "\u{7}",
        "the character U+0007 has no meaning in an expression",
        "an expression holds numbers, names, `+ - * / ^`, brackets and commas",
    ),
    ("1e999", "1e999", "`1e999` is too large for a number", "the largest number is about 1.8e308"),
    ("bop.x", "bop", "there is no particle `bop`", "did you mean `bob`?"),
    ("length1*2", "length1", "there is no name `length1`", "did you mean `length0`?"),
    ("zz", "zz", "there is no name `zz`", "names are particles, parameters, `t`, `pi` and `tau`"),
    (
        "cbrt(a.x)",
        "cbrt",
        "there is no function `cbrt`",
        "the functions are sqrt, sin, cos, tan, asin, acos, atan, atan2, exp, ln, abs, min, max, dot, dist, length, \
         cross, area, volume",
    ),
    ("sqrr(a.x)", "sqrr", "there is no function `sqrr`", "did you mean `sqrt`?"),
    ("k(1 + t)", "k", "there is no function `k`", "for a product write `*` before the bracket"),
    ("sin", "sin", "`sin` is a function: its arguments are missing", "write `sin(a)`"),
    ("bob.q", "bob.q", "a particle has no `.q`", "write `bob.x` or `bob.y`"),
    ("bob.z", "bob.z", "there is no `.z` in two dimensions", "write `bob.x` or `bob.y`"),
    ("k.x", "k.x", "`k` is a parameter, a number: it has no `.x`", "write `k`"),
    ("both", "both", "`both` is both a particle and a parameter", "give the parameter another name"),
    (
        "bob.vx",
        "bob.vx",
        "`bob.vx` is a velocity, but a constraint C(q, t) = 0 may hold positions and time only: the velocities it \
         allows follow from it",
        "write what the positions must satisfy; to act on velocities, use a force",
    ),
    (
        "bob",
        "bob",
        "the expression is a point, but must be a number",
        "take a coordinate, `bob.x`, or a length, `length(bob)`",
    ),
    (
        "a - b",
        "a - b",
        "the expression is a point, but must be a number",
        "take a length, `length(a)`, or a product with another point, `dot(a, b)`",
    ),
    (
        "a + 1",
        "a + 1",
        "`a` is a point and `1` is a number: they cannot be added",
        "take a coordinate, `a.x`, or a length, `length(a)`",
    ),
    (
        "2 - a",
        "2 - a",
        "`2` is a number and `a` is a point: they cannot be subtracted",
        "take a coordinate, `a.x`, or a length, `length(a)`",
    ),
    (
        "a*b",
        "a*b",
        "`a` and `b` are points, which `*` does not multiply",
        "write `dot(a, b)` for the dot product and `cross(a, b)` for the cross product",
    ),
    (
        "1/a",
        "1/a",
        "`a` is a point, and nothing can be divided by a point",
        "take a coordinate, `a.x`, or a length, `length(a)`",
    ),
    ("(a - b)^2", "(a - b)^2", "`(a - b)` is a point, and `^` takes numbers", "the square of a length is `dot(a, a)`"),
    (
        "2^a",
        "2^a",
        "`a` is a point, and an exponent must be a number",
        "take a coordinate, `a.x`, or a length, `length(a)`",
    ),
    ("sin(a)", "a", "`a` is a point, but `sin` takes numbers", "take a coordinate, `a.x`, or a length, `length(a)`"),
    ("abs(a - b)", "a - b", "`a - b` is a point, but `abs` takes numbers", "the length of a point is `length(a)`"),
    ("length(a.x)", "a.x", "`a.x` is a number, but `length` takes points", "the size of a number is `abs(a)`"),
    ("dist(a, 1)", "1", "`1` is a number, but `dist` takes points", "a point is the name of a particle or `[1, 2]`"),
    ("dist(a)", "dist(a)", "`dist` takes 2 arguments, but 1 is given", "write `dist(a, b)`"),
    ("sin(1, 2)", "sin(1, 2)", "`sin` takes 1 argument, but 2 are given", "write `sin(a)`"),
    ("dist(a, [1, 2, 3])", "[1, 2, 3]", "a point of this system has 2 numbers, but 3 are given", "write `[1, 2]`"),
    (
        "volume(a, b, c, bob)",
        "volume(a, b, c, bob)",
        "`volume` needs three dimensions, and this system has two",
        "the area of a polygon is `area(a, b, c)`",
    ),
    (
        "a.x/(2 - 2)",
        "a.x/(2 - 2)",
        "this is never a finite number",
        "it divides by zero, leaves the domain of a function or is too large",
    ),
];

#[test]
fn what_is_refused_says_where_what_and_what_to_write_instead() {
    for (text, part, message, help) in REFUSED {
        let error = parse(text).expect_err(text);
        assert_eq!(
            (&text[error.span.clone()], error.message.as_str(), error.help.as_deref()),
            (part, message, Some(help))
        );
    }
}

#[test]
fn each_purpose_refuses_what_it_cannot_depend_on() {
    let refused = |text, purpose| parse_in(text, purpose, Dimension::Two).unwrap_err().message;
    assert_eq!(
        refused("bob.vx^2", Purpose::Potential),
        "`bob.vx` is a velocity, but a potential energy depends on positions and time only"
    );
    for text in ["bob.x", "bob.vx", "bob"] {
        assert_eq!(
            refused(text, Purpose::Time),
            "`bob` is a particle, but this number may depend on time alone",
            "{text}"
        );
    }
    assert!(parse_in("bob.x*t", Purpose::Potential, Dimension::Two).is_ok());
    let error = parse_in("area(a, b, c)", Purpose::Force, Dimension::Three).unwrap_err();
    assert_eq!(error.message, "`area` is signed, which has a meaning in two dimensions only");
    let error = parse_in("bob.w", Purpose::Force, Dimension::Three).unwrap_err();
    let all = "write `bob.x`, `bob.y`, `bob.z`, `bob.vx`, `bob.vy` or `bob.vz`";
    assert_eq!(error.help.as_deref(), Some(all));
}

#[test]
fn parameters_may_not_take_names_that_have_a_meaning() {
    assert_eq!(check_parameter("ω", 2.0), Ok(()));
    assert_eq!(check_parameter("_a1", 2.0), Ok(()));
    for name in ["t", "pi", "tau", "sin", "", "1a", "a.b", "a b", "a-b"] {
        assert!(check_parameter(name, 1.0).is_err(), "{name}");
    }
    for value in [f64::NAN, f64::INFINITY] {
        assert!(check_parameter("a", value).is_err(), "{value}");
    }
}

/// Texts above a limit are refused before they are evaluated; texts at the limit are accepted.
#[test]
fn limits_hold() {
    let message = |text: &str| parse(text).unwrap_err().message;
    let nested = |depth: usize| format!("{}1{}", "(".repeat(depth), ")".repeat(depth));
    assert!(parse(&nested(MAX_DEPTH)).is_ok());
    for deep in [
        nested(MAX_DEPTH + 1),
        "(".repeat(MAX_BYTES),
        "[".repeat(MAX_BYTES),
        "-".repeat(MAX_BYTES),
        "2^".repeat(MAX_BYTES / 2),
        "(-".repeat(MAX_BYTES / 2),
        "sin(".repeat(MAX_BYTES / 4),
        format!("{}1", "-".repeat(MAX_DEPTH + 1)),
        format!("{}2", "2^".repeat(MAX_DEPTH + 1)),
    ] {
        assert_eq!(message(&deep), format!("brackets, signs and powers are nested more than {MAX_DEPTH} deep"));
    }
    assert!(parse(&format!("{}1", "-".repeat(MAX_DEPTH))).is_ok());
    // Brackets side by side are not nested.
    assert!(parse(&vec!["(-(1))"; 100].join("+")).is_ok());
    assert!(parse(&vec!["-a.x^2^2"; 60].join("*")).is_ok());

    let long = |bytes: usize| format!("1{}", " ".repeat(bytes - 1));
    assert!(parse(&long(MAX_BYTES)).is_ok());
    for bytes in [MAX_BYTES + 1, 100_000] {
        assert_eq!(message(&long(bytes)), format!("the expression has {bytes} bytes; at most 4096 are allowed"));
        assert_eq!(message(&"(".repeat(bytes)), format!("the expression has {bytes} bytes; at most 4096 are allowed"));
    }

    let sum = |terms: usize| vec!["t"; terms].join("+");
    assert!(parse(&sum(MAX_NODES / 2)).is_ok());
    assert_eq!(message(&sum(MAX_NODES / 2 + 1)), "the expression has more than 512 numbers, names and operations");
    assert_eq!(
        message(&format!("min({})", vec!["1"; 1000].join(","))),
        "the expression has more than 512 numbers, names and operations"
    );

    let any = |name: &str| name.strip_prefix('p').and_then(|number| number.parse().ok()).map(crate::systems::id);
    let names = |count: usize| {
        let text = (0..count).map(|i| format!("p{i}.x")).collect::<Vec<_>>().join("+");
        Expression::parse(&text, &Scope::new(Purpose::Constraint, Dimension::Two, &any))
    };
    assert_eq!(names(MAX_NAMES).unwrap().particles().len(), MAX_NAMES);
    assert_eq!(names(MAX_NAMES + 1).unwrap_err().message, "the expression uses more than 64 different names");

    // 512 nodes of powers of powers become far more scalars.
    let factors = (0..63).map(|i| format!("((a.x+{i})^1023)^1023")).collect::<Vec<_>>().join("+");
    assert_eq!(message(&factors), format!("the expression takes more than {MAX_INSTRUCTIONS} operations on numbers"));
}

/// The deepest texts that are allowed fit half the stack of a page, 1 MB; with CARGO_PROFILE_DEV_OPT_LEVEL=0, too.
#[test]
fn the_deepest_text_fits_a_small_stack() {
    let deepest = [
        format!("{}1{}", "(".repeat(MAX_DEPTH), ")".repeat(MAX_DEPTH)),
        // A further summand and factor for every bracket.
        format!("{}1{}", "1+2*(".repeat(MAX_DEPTH), ")".repeat(MAX_DEPTH)),
        format!("{}1{}", "1+2*abs(".repeat(MAX_DEPTH), ")".repeat(MAX_DEPTH)),
        format!("{}1", "2^-".repeat(MAX_DEPTH / 2)),
    ];
    let small = std::thread::Builder::new().stack_size(512 << 10);
    let parsed = small.spawn(move || deepest.map(|text| parse(&text).is_ok() || text.contains("2^"))).unwrap();
    assert_eq!(parsed.join().unwrap(), [true; 4]);
}

/// The marked part of a message is a valid slice of any text.
fn assert_harmless(text: &str) {
    for (purpose, d) in [(Purpose::Constraint, 2), (Purpose::Force, 3)] {
        match parse_in(text, purpose, dimension(d)) {
            Ok(parsed) => {
                assert!(parsed.instruction_count() <= MAX_INSTRUCTIONS);
                let n = parsed.gradient_len();
                let (mut J, mut H) = (vec![0.0; n], vec![0.0; n * n]);
                let (q, qd) = ([0.5; 15], [0.25; 15]);
                parsed.jet_and_gradient(&q, &qd, 0.5, &mut J);
                parsed.hessian(&q, &qd, 0.5, &mut H);
            }
            Err(error) => {
                assert!(text.get(error.span.clone()).is_some(), "{text:?}: {:?}", error.span);
                assert!(error.message.chars().count() < 250 && !error.message.is_empty(), "{}", error.message);
            }
        }
    }
}

#[test]
fn hostile_texts_do_no_harm() {
    let start = std::time::Instant::now();
    let texts = [
        "(".repeat(100_000),
        "-".repeat(100_000),
        "a.x+".repeat(1000),
        "1".repeat(4096),
        format!("{}{}", "9".repeat(2000), "^2"),
        "a".repeat(4096),
        format!("{}.x", "ä".repeat(2000)),
        "1e".into(),
        "1e+".into(),
        "0x10".into(),
        "nan + inf".into(),
        "\u{0}\u{fffd}\u{202e}".into(),
        "sin(".repeat(63),
        vec!["area(a,b,c,bob)"; 100].join("*"),
        "t^(0-1024)".into(),
        "0^0 + 0^-1".into(),
        "()".into(),
        "[]".into(),
        "sin()".into(),
    ];
    for text in &texts {
        assert_harmless(text);
    }
    println!("{} hostile texts: {:?}", texts.len(), start.elapsed());
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 4000 * systems::fuzz() as u32,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn long_random_text_does_no_harm(text in "\\PC{0,80}") {
        assert_harmless(&text);
    }

    #[test]
    fn random_bytes_do_no_harm(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        assert_harmless(&String::from_utf8_lossy(&bytes));
    }

    /// Pieces of the language in random order. Most are no expressions, but they come further than random letters.
    #[test]
    fn random_tokens_do_no_harm(pieces in proptest::collection::vec(proptest::sample::select(PIECES.to_vec()), 0..60)) {
        assert_harmless(&pieces.concat());
    }
}

const PIECES: [&str; 33] = [
    "a", "b.x", "bob.vy", "c.z", "k", "t", "pi", "1", "2.5", "0", "1e9", "+", "-", "*", "/", "^", "(", ")", "[", "]",
    ",", " ", "sin(", "dist(", "cross(", "area(", "volume(", "min(", "ln(", "[1,2]", "[1,2,3]", "both", "a.",
];

/// `log` is another name of `ln`, as in most languages.
#[test]
fn log_is_ln() {
    for text in ["log(2)", "ln(2)"] {
        assert_eq!(qhat::Driven::text(text).unwrap().value(0.0), std::f64::consts::LN_2, "{text}");
    }
}

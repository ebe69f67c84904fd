//! Every kind of constraint that is an equality against its twin, the same typed as expressions: they move the same. Most of the file is
//! the table of cases, which reads best in one piece.

mod systems;

use qhat::{
    Anchor, Angle, Area, Constraint, Curve, Dimension, Direction, Distance, DistanceForm, Driven, Expression,
    ExpressionConstraint, Gears, Gravity, Integrator, Lengths, Line, Nail, NailForm, OnCircle, OnCurve, OnLine,
    OnPlane, OnSphere, Particle, ParticleId, Plane, Purpose, Relation, Scope, Settings, Simulation, Spring, System,
    Volume, rigid_rods,
};
use std::sync::LazyLock;
use systems::random::dimension;

/// A kind and its twin.
struct Case {
    name: &'static str,
    d: usize,
    /// Particles that start elsewhere than in `PLACES`, so that the constraints hold.
    at: &'static [(usize, [f64; 3])],
    /// The kind, driven by S where it can be.
    make: fn(Driven) -> Vec<Constraint>,
    /// The residuals of its twin. S is what the text is at the start, and `drive` more; without one the kind is driven by `drive` alone.
    twin: &'static [&'static str],
    /// A function of t, 0 at the start.
    drive: &'static str,
}

/// Names the variants of `Constraint` that need a twin, then those that have none, and does not compile where one is in neither list.
macro_rules! kinds {
    ($($equality:ident)*; $($other:ident)*) => {
        const EQUALITIES: &[&str] = &[$(stringify!($equality)),*];
        fn equality(constraint: &Constraint) -> Option<&'static str> {
            match constraint {
                $(Constraint::$equality(_) => Some(stringify!($equality)),)*
                $(Constraint::$other(_) => None,)*
                _ => panic!("the kind {} is not in the list", constraint.kind()),
            }
        }

        #[test]
        fn the_list_names_every_kind() {
            let mut listed = [$(stringify!($equality),)* $(stringify!($other)),*];
            let mut kinds = Constraint::KINDS.to_vec();
            listed.sort_unstable();
            kinds.sort_unstable();
            assert_eq!(listed.as_slice(), kinds);
        }
    };
}

kinds! {
    Distance Nail Relation Lengths Angle Gears Area Volume Direction OnLine OnPlane OnSphere OnCircle OnCurve;
    Limits Obstacle ExpressionConstraint
}

static P: LazyLock<[ParticleId; 5]> = LazyLock::new(|| std::array::from_fn(systems::id));

/// In two dimensions without z.
const PLACES: [[f64; 3]; 7] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.2],
    [0.2, 1.1, -0.1],
    [-0.9, 0.4, 1.2],
    [-0.5, -0.7, -0.9],
    [3.0, 0.0, 0.0],
    [4.0, 0.0, 0.0],
];

const PUSH: &str = "0.1*sin(2*t)^2";

const fn twin(
    name: &'static str,
    d: usize,
    at: &'static [(usize, [f64; 3])],
    make: fn(Driven) -> Vec<Constraint>,
    twin: &'static [&'static str],
) -> Case {
    Case { name, d, at, make, twin, drive: "0" }
}

const fn driven(
    name: &'static str,
    d: usize,
    at: &'static [(usize, [f64; 3])],
    make: fn(Driven) -> Vec<Constraint>,
    twin: &'static [&'static str],
    drive: &'static str,
) -> Case {
    Case { name, d, at, make, twin, drive }
}

const CASES: &[Case] = &[
    twin("rod", 2, &[], |_| vec![Distance::new(P[0], P[1], 1.0).into()], &["dist(p0, p1) - 1"]),
    twin("squared rod", 3, &[(1, [0.6, 0.0, 0.8])], |_| vec![squared_rod()], &["dot(p0 - p1, p0 - p1) - 1"]),
    twin(
        "rods",
        3,
        &[(1, [1.0, 0.0, 0.0]), (2, [1.0, 1.0, 0.0])],
        |_| vec![Distance::new(P[0], P[1], 1.0).into(), Distance::new(P[1], P[2], 1.0).into()],
        &["dot(p0 - p1, p0 - p1) - 1", "dist(p1, p2) - 1"],
    ),
    twin("nail", 2, &[], |_| vec![Nail::new(P[1], [1.0, 0.0, 5.0]).into()], &["p1.x - 1", "p1.y"]),
    twin("nail in space", 3, &[], |_| vec![Nail::new(P[1], PLACES[1]).into()], &["p1.x - 1", "p1.y", "p1.z - 0.2"]),
    twin(
        "coincidence",
        2,
        &[(2, PLACES[1])],
        |_| vec![Relation::coincidence(P[1], P[2]).into()],
        &["p1.x - p2.x", "p1.y - p2.y"],
    ),
    twin(
        "midpoint",
        3,
        &[(2, [0.5, 0.0, 0.1])],
        |_| vec![Relation::midpoint(P[2], P[0], P[1]).into()],
        &["2*p2.x - p0.x - p1.x", "2*p2.y - p0.y - p1.y", "2*p2.z - p0.z - p1.z"],
    ),
    twin("weights", 2, &[], |_| vec![weights()], &["4*p0.x - 2*p1.x + p2.x + 1.8", "4*p0.y - 2*p1.y + p2.y - 1.1"]),
    driven(
        "driven centre of mass",
        2,
        &[(1, [2.3, 0.0, 0.0])],
        |s| {
            let masses = [(P[0], mass(0)), (P[1], mass(1))];
            vec![Relation::center_of_mass(masses, [s, time("sin(t)/5"), 0.0.into()]).into()]
        },
        &["(p0.x + 1.3*p1.x)/2.3 - S", "(p0.y + 1.3*p1.y)/2.3 - sin(t)/5"],
        PUSH,
    ),
    driven(
        "driven particle",
        3,
        &[],
        |s| vec![Relation::driven(P[1], [s, time("t^2"), time("0.2*cos(t)")]).into()],
        &["p1.x - S", "p1.y - t^2", "p1.z - 0.2*cos(t)"],
        PUSH,
    ),
    twin(
        "direction",
        2,
        &[(1, [0.6, 0.8, 0.0])],
        |_| vec![Direction::new(P[0], P[1], [3.0, 4.0, 1.0]).into()],
        &["cross([3, 4], p1 - p0)"],
    ),
    twin(
        "direction in space",
        3,
        &[(1, [0.5, 1.0, 1.0])],
        |_| vec![Direction::new(P[0], P[1], [1.0, 2.0, 2.0]).into()],
        &["2*(p1.x - p0.x) - (p1.y - p0.y)", "p1.y - p0.y - (p1.z - p0.z)"],
    ),
    twin(
        "driven direction",
        2,
        &[],
        |_| vec![Direction { a: P[0], b: P[1], along: turning(0.0) }.into()],
        &["cross([cos(t), sin(t)], p1 - p0)"],
    ),
    twin(
        "driven direction in space",
        3,
        &[],
        |_| vec![Direction { a: P[0], b: P[1], along: turning(0.2) }.into()],
        &["sin(t)*(p1.x - p0.x) - cos(t)*(p1.y - p0.y)", "0.2*(p1.x - p0.x) - cos(t)*(p1.z - p0.z)"],
    ),
    twin(
        "line",
        2,
        &[(1, [1.5, 0.0, 0.0])],
        |_| vec![OnLine::fixed(P[1], [1.0, -1.0, 0.0], [1.0, 2.0, 0.0]).into()],
        &["2*(p1.x - 1) - (p1.y + 1)"],
    ),
    twin(
        "line in space",
        3,
        &[(1, [1.5, 0.0, 0.5])],
        |_| vec![OnLine::fixed(P[1], [1.0, -1.0, 0.0], [1.0, 2.0, 1.0]).into()],
        &["2*(p1.x - 1) - (p1.y + 1)", "p1.x - 1 - p1.z"],
    ),
    twin(
        "line through particles",
        2,
        &[(2, [0.4, 0.0, 0.0])],
        |_| vec![OnLine::through(P[2], P[0], P[1]).into()],
        &["cross(p1 - p0, p2 - p0)"],
    ),
    twin(
        "line through particles in space",
        3,
        &[(2, [0.4, 0.0, 0.08])],
        |_| vec![OnLine::through(P[2], P[0], P[1]).into()],
        &[
            "(p1.x - p0.x)*(p2.y - p0.y) - (p1.y - p0.y)*(p2.x - p0.x)",
            "(p1.x - p0.x)*(p2.z - p0.z) - (p1.z - p0.z)*(p2.x - p0.x)",
        ],
    ),
    driven(
        "driven line",
        2,
        &[],
        |s| vec![OnLine { particle: P[1], line: Line::Through([0.0.into(), s, 0.0.into()], turning(0.0)) }.into()],
        &["cross([cos(t), sin(t)], p1 - [0, 0.1*sin(2*t)^2])"],
        PUSH,
    ),
    driven(
        "driven line in space",
        3,
        &[],
        |s| vec![OnLine { particle: P[1], line: Line::Through([s, 0.0.into(), 0.0.into()], turning(0.2)) }.into()],
        &["sin(t)*(p1.x - 0.1*sin(2*t)^2) - cos(t)*p1.y", "0.2*(p1.x - 0.1*sin(2*t)^2) - cos(t)*p1.z"],
        PUSH,
    ),
    twin(
        "plane",
        3,
        &[(1, [1.0, 0.0, 0.5])],
        |_| vec![OnPlane::fixed(P[1], [0.0, 0.0, 1.0], [1.0, 2.0, 2.0]).into()],
        &["p1.x + 2*p1.y + 2*p1.z - 2"],
    ),
    twin(
        "plane through particles",
        3,
        &[(3, [0.4, -0.55, 0.15])],
        |_| vec![OnPlane::through(P[3], [P[0], P[1], P[2]]).into()],
        &["volume(p0, p1, p2, p3)"],
    ),
    driven(
        "driven plane",
        3,
        &[(1, [1.0, -0.06, 0.2])],
        |s| {
            let normal = [time("sin(t)"), 1.0.into(), 0.3.into()];
            vec![OnPlane { particle: P[1], plane: Plane::Across([0.0.into(), s, 0.0.into()], normal) }.into()]
        },
        &["sin(t)*p1.x + p1.y - 0.1*sin(2*t)^2 + 0.3*p1.z"],
        PUSH,
    ),
    twin(
        "sphere",
        3,
        &[],
        |s| vec![OnSphere::new(P[1], [0.5, 0.5, 0.1], s).into()],
        &["dist(p1, [0.5, 0.5, 0.1]) - S"],
    ),
    twin("sphere about a particle", 2, &[], |s| vec![OnSphere::new(P[1], P[2], s).into()], &["dist(p2, p1) - S"]),
    driven("driven rod", 2, &[], |s| vec![OnSphere::new(P[1], P[0], s).into()], &["dist(p0, p1) - S"], PUSH),
    driven(
        "driven sphere",
        3,
        &[],
        |s| {
            let center = Anchor::Point([time("sin(t)/2"), 0.0.into(), time("-t^2/3")]);
            vec![OnSphere { particle: P[1], center, radius: s }.into()]
        },
        &["dist(p1, [sin(t)/2, 0, -t^2/3]) - S"],
        PUSH,
    ),
    driven(
        "circle",
        3,
        &[(1, [0.8, -0.4, 0.0])],
        |s| vec![OnCircle::new(P[1], [0.0; 3], [1.0, 2.0, 2.0], s).into()],
        &["p1.x + 2*p1.y + 2*p1.z", "length(p1) - S"],
        PUSH,
    ),
    twin(
        "circle about a particle",
        3,
        &[(1, [0.8, -0.4, 0.0])],
        |s| vec![OnCircle::new(P[1], P[0], [1.0, 2.0, 2.0], s).into()],
        &["dot([1, 2, 2], p1 - p0)", "dist(p0, p1) - S"],
    ),
    twin("circle as a curve", 2, &[], |_| vec![on_curve(&["cos(s)", "sin(s)"])], &["dot(p1, p1) - 1"]),
    twin("parabola", 2, &[(1, [0.4, 0.08, 0.0])], |_| vec![on_curve(&["s", "s^2/2"])], &["p1.y - p1.x^2/2"]),
    twin(
        "helix",
        3,
        &[(1, [1.0, 0.0, 0.0])],
        |_| vec![on_curve(&["cos(s)", "sin(s)", "s/2"])],
        &["p1.x - cos(2*p1.z)", "p1.y - sin(2*p1.z)"],
    ),
    twin(
        "spline through points in line",
        2,
        &[(1, [1.0, 0.5, 0.0])],
        |_| {
            let curve = Curve::through(&[[-4.0, -2.0, 0.0], [0.0; 3], [4.0, 2.0, 0.0]], false).unwrap();
            vec![OnCurve { particle: P[1], curve }.into()]
        },
        &["p1.x - 2*p1.y"],
    ),
    twin(
        "straight piece of a bent wire",
        2,
        &[(1, [1.0, 0.5, 0.0])],
        |_| vec![bent_wire(&[[-4.0, -2.0, 0.0], [4.0, 2.0, 0.0], [4.0, 5.0, 0.0]], 0.5)],
        &["p1.x - 2*p1.y"],
    ),
    twin(
        "arc of a bent wire",
        2,
        &[(1, [0.6, -0.8, 0.0])],
        |_| vec![bent_wire(&arc_below(1.0, 0.0), 1.0)],
        &["length(p1) - 1"],
    ),
    twin(
        "arc of a bent wire in space",
        3,
        &[(1, [0.36, -0.8, 0.48])],
        |_| vec![bent_wire(&arc_below(0.6, 0.8), 1.0)],
        &["0.8*p1.x - 0.6*p1.z", "length(p1) - 1"],
    ),
    twin("pulley", 2, &[], |s| vec![Lengths::pulley(&P[..3], s).into()], &["dist(p0, p1) + dist(p1, p2) - S"]),
    twin(
        "ratio",
        3,
        &[(1, [0.6, 0.0, 0.8]), (2, [0.3, 0.4, 0.0])],
        |_| vec![Lengths::ratio([P[0], P[1]], [P[2], P[0]], 2.0).into()],
        &["dist(p0, p1) - 2*dist(p0, p2)"],
    ),
    twin(
        "equal lengths",
        2,
        &[(2, [0.6, 0.8, 0.0])],
        |_| vec![Lengths::ratio([P[0], P[1]], [P[2], P[0]], 1.0).into()],
        &["dot(p0 - p1, p0 - p1) - dot(p0 - p2, p0 - p2)"],
    ),
    driven(
        "winch of a tackle",
        3,
        &[],
        |s| vec![Lengths::new(&[([P[0], P[1]], 1.0), ([P[1], P[2]], 2.0)], s).into()],
        &["dist(p0, p1) + 2*dist(p1, p2) - S"],
        PUSH,
    ),
    twin(
        "angle",
        2,
        &[],
        |s| vec![Angle::between([P[0], P[1]], [P[0], P[2]], s).into()],
        &["atan2(cross(p1 - p0, p2 - p0), dot(p1 - p0, p2 - p0)) - S"],
    ),
    driven(
        "driven angle in space",
        3,
        &[],
        |s| vec![Angle::between([P[0], P[1]], [P[3], P[2]], s).into()],
        &["atan2(length(cross(p1 - p0, p2 - p3)), dot(p1 - p0, p2 - p3)) - S"],
        PUSH,
    ),
    twin(
        "angle from a direction",
        3,
        &[],
        |s| vec![Angle::from_direction([1.0, 2.0, -1.0], [P[0], P[2]], s).into()],
        &["atan2(length(cross([1, 2, -1], p2 - p0)), dot([1, 2, -1], p2 - p0)) - S"],
    ),
    driven(
        "motor",
        2,
        &[],
        |s| vec![Angle::from_direction([1.0, 0.0, 0.0], [P[0], P[1]], s).into()],
        &["atan2(p1.y - p0.y, p1.x - p0.x) - S"],
        "2*t",
    ),
    twin(
        "gears",
        2,
        &[],
        |s| vec![Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [20, 10], s).into()],
        &[
            "2*atan2(p1.y - p0.y, p1.x - p0.x) + atan2(p3.y - p2.y, p3.x - p2.x) - 3*atan2(p2.y - p0.y, p2.x - p0.x) - S",
        ],
    ),
    driven(
        "hands of a clock",
        2,
        &[],
        |s| vec![Gears::coupled(&[([P[0], P[1]], 3), ([P[0], P[2]], -1)], s).into()],
        &["3*atan2(p1.y - p0.y, p1.x - p0.x) - atan2(p2.y - p0.y, p2.x - p0.x) - S"],
        PUSH,
    ),
    twin(
        "rack",
        2,
        &[],
        |s| vec![Gears::rack([P[0], P[1]], P[2], [3.0, 4.0], 0.5, s).into()],
        &["atan2(p1.y - p0.y, p1.x - p0.x) - dot([0.6, 0.8], p2 - p0)/0.5 - S"],
    ),
    driven(
        "area",
        2,
        &[],
        |area| vec![Area { corners: vec![P[0], P[1], P[2], P[3]], area }.into()],
        &["area(p0, p1, p2, p3) - S"],
        PUSH,
    ),
    driven(
        "volume",
        3,
        &[],
        |s| vec![Volume::tetrahedron([P[0], P[1], P[2], P[3]], s).into()],
        &["volume(p0, p1, p2, p3) - S"],
        PUSH,
    ),
    twin(
        "rigid cluster",
        3,
        &[],
        |_| {
            let rods = rigid_rods(Dimension::Three, &PLACES[..5]).unwrap();
            let length =
                |a: usize, b: usize| (0..3).map(|k| PLACES[a][k] - PLACES[b][k]).map(|x| x * x).sum::<f64>().sqrt();
            rods.into_iter().map(|[a, b]| Distance::new(P[a], P[b], length(a, b)).into()).collect()
        },
        &[
            // Nine of the ten distances, among them one that the rods leave out.
            "dist(p0, p1) - S",
            "dist(p0, p2) - S",
            "dist(p1, p2) - S",
            "dist(p0, p3) - S",
            "dist(p1, p3) - S",
            "dist(p2, p3) - S",
            "dist(p1, p4) - S",
            "dist(p2, p4) - S",
            "dist(p0, p4) - S",
        ],
    ),
];

fn squared_rod() -> Constraint {
    Distance { form: DistanceForm::Squared, ..Distance::new(P[0], P[1], 1.0) }.into()
}

fn weights() -> Constraint {
    let terms = vec![(P[0], 2.0), (P[1], -1.0), (P[2], 0.5)];
    Relation { terms, point: [(-0.9).into(), 0.55.into(), 0.0.into()] }.into()
}

/// A direction that turns about z.
fn turning(z: f64) -> [Driven; 3] {
    [time("cos(t)"), time("sin(t)"), z.into()]
}

fn on_curve(components: &[&str]) -> Constraint {
    let d = if components.len() == 2 { 2 } else { 3 };
    let components = components.iter().map(|text| parse(text, Purpose::Curve, d)).collect();
    OnCurve { particle: P[1], curve: Curve::parametric(components, -6.0, 6.0).unwrap() }.into()
}

/// A corner whose arc of radius 1 lies about the origin, from 74° before the lowest point, along (x, 0, z), to 74° after it.
fn arc_below(x: f64, z: f64) -> [[f64; 3]; 3] {
    let (depth, way) = (25.0 / 7.0, 5.0);
    let end = |side: f64| [0.28 * way * side * x, 0.96 * way - depth, 0.28 * way * side * z];
    [end(-1.0), [0.0, -depth, 0.0], end(1.0)]
}

fn bent_wire(points: &[[f64; 3]], radius: f64) -> Constraint {
    OnCurve { particle: P[1], curve: Curve::polyline(points, radius, false).unwrap() }.into()
}

fn parse(text: &str, purpose: Purpose, d: usize) -> Expression {
    let particle = |name: &str| name.strip_prefix('p')?.parse().ok().map(systems::id);
    let scope = Scope::new(purpose, dimension(d), &particle);
    Expression::parse(text, &scope).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn time(text: &str) -> Driven {
    parse(text, Purpose::Time, 2).into()
}

fn mass(i: usize) -> f64 {
    1.0 + 0.3 * i as f64
}

fn positions(case: &Case) -> Vec<f64> {
    let place = |i: usize| case.at.iter().find(|(moved, _)| *moved == i).map_or(PLACES[i], |(_, place)| *place);
    (0..PLACES.len()).flat_map(|i| place(i)[..case.d].to_vec()).collect()
}

/// The kind at the S that its twin starts with, and the twin.
fn both(case: &Case) -> [Vec<Constraint>; 2] {
    let q = positions(case);
    let typed =
        |text: &str| -> Constraint { ExpressionConstraint::new(parse(text, Purpose::Constraint, case.d), &q).into() };
    let mut s = case.drive.to_owned();
    let mut rows = Vec::new();
    for text in case.twin {
        if text.contains('S') {
            let start = typed(&text.replace('S', "0")).residual(dimension(case.d), &q)[0];
            s = format!("({start:?} + {})", case.drive);
        }
        rows.push(typed(&text.replace('S', &s)));
    }
    [(case.make)(time(&s)), rows]
}

/// Particles that springs keep apart and together, thrown into the air, beside a rod that gives both systems one length to measure in.
fn simulation(case: &Case, constraints: Vec<Constraint>, integrator: Integrator) -> Simulation {
    let (d, q) = (case.d, positions(case));
    let mut builder = System::builder(dimension(d));
    for (i, x) in q.chunks(d).enumerate() {
        // Any that differ.
        let v: Vec<f64> = (0..d).map(|k| 0.2 * ((3 * i + 5 * k + 1) % 7) as f64 - 0.6).collect();
        builder.particle(Particle::at(format!("p{i}"), x).with_mass(mass(i)).with_velocity(v));
    }
    for (i, a) in P.iter().enumerate() {
        for b in &P[..i] {
            let square = |k: usize| {
                let along = q[a.index() * d + k] - q[b.index() * d + k];
                along * along
            };
            let rest = 0.9 * (0..d).map(square).sum::<f64>().sqrt();
            if rest > 0.0 {
                builder.force(Spring { a: *a, b: *b, stiffness: 20.0, damping: 0.1, rest });
            }
        }
    }
    builder.force(Gravity { acceleration: [0.3, -9.81, 0.2] });
    builder.constraint("beside", Distance::new(systems::id(5), systems::id(6), 1.0));
    for (k, constraint) in constraints.into_iter().enumerate() {
        builder.constraint(format!("c{k}"), constraint);
    }
    let (system, state) = builder.build().unwrap_or_else(|error| panic!("{}: {error}", case.name));
    let (tolerance, h) = (1e-12, 0.02);
    let settings = Settings { integrator, tolerance, h, constraint_tolerance: 1e-13, ..Settings::default() };
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    for _ in 0..50 {
        simulation.step().unwrap_or_else(|error| panic!("{}: {error}", case.name));
    }
    simulation
}

fn apart(one: &Simulation, other: &Simulation) -> f64 {
    let pairs = one.state().positions().iter().zip(other.state().positions());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn kinds_move_as_their_twins() {
    for case in CASES {
        let [one, other] = both(case).map(|constraints| simulation(case, constraints, Integrator::Dop853));
        let free = simulation(case, Vec::new(), Integrator::Dop853);
        // dop853 at 1e-12 a substep follows the motion itself.
        let apart_by = apart(&one, &other);
        println!("{}: {apart_by:e} of {:e}", case.name, apart(&one, &free));
        assert!(apart_by < 1e-10, "{}: {apart_by:e} m apart", case.name);
        assert!(apart(&one, &free) > 0.01, "{} is not put to the test", case.name);
    }
}

/// A gradient that vanishes exactly where it must hold is held by feedback alone, as the source does: no motion that a tolerance could
/// follow, but the same arithmetic, over 50 steps of roundoff.
#[test]
fn the_scalar_nail_moves_as_its_twin() {
    let make = |_| vec![Nail { form: NailForm::Scalar, ..Nail::new(P[0], [0.0; 3]) }.into()];
    let case = twin("scalar nail", 2, &[], make, &["dot(p0, p0)"]);
    let [one, other] = both(&case).map(|constraints| simulation(&case, constraints, Integrator::Euler));
    assert!(apart(&one, &other) < 1e-11);
}

#[test]
fn every_equality_has_a_twin() {
    let made: Vec<_> = CASES.iter().flat_map(|case| both(case)[0].clone()).collect();
    for kind in EQUALITIES {
        assert!(made.iter().any(|constraint| equality(constraint) == Some(kind)), "{kind} has no twin");
    }
}

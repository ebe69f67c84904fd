//! The table of cases: every kind of constraint in the plane and in space, driven and not, each with its rows as
//! expressions. The file is longer than others because a table is easier to read in one piece.

use super::case::{Case, Clock, P, PLACES, driven, mass, parse, twin};
use qhat::{
    Anchor, Angle, Area, Constraint, Curve, Custom, Dimension, Direction, Distance, DistanceForm, Driven, Gears, Hyper,
    Lengths, Limits, Line, Nail, NailForm, Obstacle, OnCircle, OnCurve, OnEllipse, OnLine, OnPlane, OnSphere, Plane,
    Purpose, Relation, Surface, Volume, rigid_rods,
};

/// The kinds by the numbers of dimensions they can be in; the kinds behind `equality` hold C = 0 over a motion. The
/// test below fails if a kind is missing: name a new kind here, then add its cases.
macro_rules! kinds {
    ($(in $dimensions:expr; equality $($equality:ident)*; other $($other:ident)*;)*) => {
        /// Name, dimensions, and whether it is an equality.
        pub(super) const KINDS: &[(&str, &[usize], bool)] =
            &[$($((stringify!($equality), &$dimensions, true),)* $((stringify!($other), &$dimensions, false),)*)*];

        /// The match does not compile if the list names a kind that the engine lacks. The test fails if the list lacks
        /// a kind of the engine.
        #[test]
        fn the_list_names_every_kind_of_the_engine() {
            fn kind(constraint: &Constraint) -> &'static str {
                match constraint {
                    $($(Constraint::$equality(_) => stringify!($equality),)*)*
                    $($(Constraint::$other(_) => stringify!($other),)*)*
                    _ => "",
                }
            }
            let nail = Constraint::from(Nail::new(P[0], [0.0; 3]));
            assert_eq!(kind(&nail), nail.kind());
            let listed = |name: &&str| KINDS.iter().any(|(listed, ..)| listed == name);
            let missing: Vec<_> = Constraint::KINDS.iter().filter(|name| !listed(name)).collect();
            assert!(missing.is_empty(), "the engine has {missing:?}: name them in `kinds!`, then add their cases");
        }
    };
}

kinds! {
    in [2, 3];
    equality Distance Nail Relation Lengths Angle Direction OnLine OnSphere OnCurve ExpressionConstraint
        Custom;
    other Limits Obstacle;

    in [2];
    equality Gears Area OnEllipse;
    other;

    in [3];
    equality Volume OnPlane OnCircle;
    other;
}

const PUSH: &str = "0.1*sin(2*t)^2";

pub(crate) const CASES: &[Case] = &[
    twin("rod", 2, &[], |_| vec![Distance::new(P[0], P[1], 1.0).into()], &["dist(p0, p1) - 1"]).anywhere(),
    twin("squared rod", 3, &[(1, [0.6, 0.0, 0.8])], |_| vec![squared_rod()], &["dot(p0 - p1, p0 - p1) - 1"]).anywhere(),
    // The end with the higher number first: the blocks of a row need not be in order.
    twin(
        "rod in space",
        3,
        &[(2, [0.0, 1.2, 0.5])],
        |_| vec![Distance::new(P[2], P[0], 1.3).into()],
        &["dist(p0, p2) - 1.3"],
    )
    .anywhere(),
    twin("squared rod in the plane", 2, &[], |_| vec![squared_rod()], &["dot(p0 - p1, p0 - p1) - 1"]).anywhere(),
    twin(
        "rods",
        3,
        &[(1, [1.0, 0.0, 0.0]), (2, [1.0, 1.0, 0.0])],
        |_| vec![Distance::new(P[0], P[1], 1.0).into(), Distance::new(P[1], P[2], 1.0).into()],
        &["dot(p0 - p1, p0 - p1) - 1", "dist(p1, p2) - 1"],
    )
    .other_rows()
    .anywhere(),
    twin("nail", 2, &[], |_| vec![Nail::new(P[1], [1.0, 0.0, 5.0]).into()], &["p1.x - 1", "p1.y"]).anywhere(),
    twin("nail in space", 3, &[], |_| vec![Nail::new(P[1], PLACES[1]).into()], &["p1.x - 1", "p1.y", "p1.z - 0.2"])
        .anywhere(),
    twin("scalar nail", 2, &[], |_| vec![scalar_nail()], &["dot(p1 - [0.4, -0.7], p1 - [0.4, -0.7])"])
        .without_motion()
        .anywhere(),
    twin(
        "scalar nail in space",
        3,
        &[],
        |_| vec![scalar_nail()],
        &["dot(p1 - [0.4, -0.7, 0.2], p1 - [0.4, -0.7, 0.2])"],
    )
    .without_motion()
    .anywhere(),
    twin(
        "coincidence",
        2,
        &[(2, PLACES[1])],
        |_| vec![Relation::coincidence(P[1], P[2]).into()],
        &["p1.x - p2.x", "p1.y - p2.y"],
    )
    .anywhere(),
    twin(
        "midpoint",
        3,
        &[(2, [0.5, 0.0, 0.1])],
        |_| vec![Relation::midpoint(P[2], P[0], P[1]).into()],
        &["2*p2.x - p0.x - p1.x", "2*p2.y - p0.y - p1.y", "2*p2.z - p0.z - p1.z"],
    )
    .other_rows()
    .anywhere(),
    twin("weights", 2, &[], |_| vec![weights()], &["4*p0.x - 2*p1.x + p2.x + 1.8", "4*p0.y - 2*p1.y + p2.y - 1.1"])
        .other_rows()
        .anywhere(),
    driven(
        "driven centre of mass",
        2,
        &[(1, [2.3, 0.0, 0.0])],
        |t| {
            let masses = [(P[0], mass(0)), (P[1], mass(1))];
            vec![Relation::center_of_mass(masses, [t.s(), t.of("sin(t)/5"), 0.0.into()]).into()]
        },
        &["(p0.x + 1.3*p1.x)/2.3 - S", "(p0.y + 1.3*p1.y)/2.3 - sin(t)/5"],
        PUSH,
    )
    .anywhere(),
    driven(
        "driven particle",
        3,
        &[],
        |t| vec![Relation::driven(P[1], [t.s(), t.of("t^2"), t.of("0.2*cos(t)")]).into()],
        &["p1.x - S", "p1.y - t^2", "p1.z - 0.2*cos(t)"],
        PUSH,
    )
    .anywhere(),
    twin(
        "direction",
        2,
        &[(1, [0.6, 0.8, 0.0])],
        |_| vec![Direction::new(P[0], P[1], [3.0, 4.0, 1.0]).into()],
        &["cross([3, 4], p1 - p0)"],
    )
    .other_rows()
    .anywhere(),
    twin(
        "direction in space",
        3,
        &[(1, [0.5, 1.0, 1.0])],
        |_| vec![Direction::new(P[0], P[1], [1.0, 2.0, 2.0]).into()],
        &["2*(p1.x - p0.x) - (p1.y - p0.y)", "p1.y - p0.y - (p1.z - p0.z)"],
    )
    .other_rows()
    .anywhere(),
    twin(
        "driven direction",
        2,
        &[],
        |t| vec![Direction { a: P[0], b: P[1], along: turning(t) }.into()],
        &["cross([cos(t), sin(t)], p1 - p0)"],
    )
    .anywhere(),
    twin(
        "driven direction in space",
        3,
        &[],
        |t| vec![Direction { a: P[0], b: P[1], along: rising(t) }.into()],
        &["sin(t)*(p1.x - p0.x) - cos(t)*(p1.y - p0.y)", "(0.2 + t/5)*(p1.x - p0.x) - cos(t)*(p1.z - p0.z)"],
    )
    .other_rows(),
    twin(
        "line",
        2,
        &[(1, [1.5, 0.0, 0.0])],
        |_| vec![OnLine::fixed(P[1], [1.0, -1.0, 0.0], [1.0, 2.0, 0.0]).into()],
        &["2*(p1.x - 1) - (p1.y + 1)"],
    )
    .other_rows()
    .anywhere(),
    twin(
        "line in space",
        3,
        &[(1, [1.5, 0.0, 0.5])],
        |_| vec![OnLine::fixed(P[1], [1.0, -1.0, 0.0], [1.0, 2.0, 1.0]).into()],
        &["2*(p1.x - 1) - (p1.y + 1)", "p1.x - 1 - p1.z"],
    )
    .other_rows(),
    twin(
        "line through particles",
        2,
        &[(2, [0.4, 0.0, 0.0])],
        |_| vec![OnLine::through(P[2], P[0], P[1]).into()],
        &["cross(p1 - p0, p2 - p0)/dist(p0, p1)"],
    )
    .anywhere(),
    twin(
        "line through particles in space",
        3,
        &[(2, [0.4, 0.0, 0.08])],
        |_| vec![OnLine::through(P[2], P[0], P[1]).into()],
        &[
            "(p1.x - p0.x)*(p2.y - p0.y) - (p1.y - p0.y)*(p2.x - p0.x)",
            "(p1.x - p0.x)*(p2.z - p0.z) - (p1.z - p0.z)*(p2.x - p0.x)",
        ],
    )
    .other_rows(),
    driven(
        "driven line",
        2,
        &[],
        |t| vec![OnLine { particle: P[1], line: Line::Through([0.0.into(), t.s(), 0.0.into()], turning(t)) }.into()],
        &["cross([cos(t), sin(t)], p1 - [0, 0.1*sin(2*t)^2])"],
        PUSH,
    )
    .anywhere(),
    driven(
        "driven line in space",
        3,
        &[],
        |t| vec![OnLine { particle: P[1], line: Line::Through([t.s(), 0.0.into(), 0.0.into()], rising(t)) }.into()],
        &["sin(t)*(p1.x - 0.1*sin(2*t)^2) - cos(t)*p1.y", "(0.2 + t/5)*(p1.x - 0.1*sin(2*t)^2) - cos(t)*p1.z"],
        PUSH,
    )
    .other_rows(),
    twin(
        "plane",
        3,
        &[(1, [1.0, 0.0, 0.5])],
        |_| vec![OnPlane::fixed(P[1], [0.0, 0.0, 1.0], [1.0, 2.0, 2.0]).into()],
        &["p1.x + 2*p1.y + 2*p1.z - 2"],
    )
    .other_rows()
    .anywhere(),
    twin(
        "plane through particles",
        3,
        &[(3, [0.4, -0.55, 0.15])],
        |_| vec![OnPlane::through(P[3], [P[0], P[1], P[2]]).into()],
        &["dot(cross(p1 - p0, p2 - p0), p3 - p0)/length(cross(p1 - p0, p2 - p0))"],
    ),
    driven(
        "driven plane",
        3,
        &[(1, [1.0, -0.06, 0.2])],
        |t| {
            let normal = [t.of("sin(t)"), 1.0.into(), 0.3.into()];
            vec![OnPlane { particle: P[1], plane: Plane::Across([0.0.into(), t.s(), 0.0.into()], normal) }.into()]
        },
        &["(sin(t)*p1.x + p1.y - 0.1*sin(2*t)^2 + 0.3*p1.z)/length([sin(t), 1, 0.3])"],
        PUSH,
    ),
    twin(
        "sphere",
        3,
        &[],
        |t| vec![OnSphere::new(P[1], [0.5, 0.5, 0.1], t.s()).into()],
        &["dist(p1, [0.5, 0.5, 0.1]) - S"],
    ),
    twin("sphere about a particle", 2, &[], |t| vec![OnSphere::new(P[1], P[2], t.s()).into()], &["dist(p2, p1) - S"])
        .anywhere(),
    driven("driven rod", 2, &[], |t| vec![OnSphere::new(P[1], P[0], t.s()).into()], &["dist(p0, p1) - S"], PUSH)
        .anywhere(),
    driven(
        "driven sphere",
        3,
        &[],
        |t| {
            let center = Anchor::Point([t.of("sin(t)/2"), 0.0.into(), t.of("-t^2/3")]);
            vec![OnSphere::new(P[1], center, t.s()).into()]
        },
        &["dist(p1, [sin(t)/2, 0, -t^2/3]) - S"],
        PUSH,
    ),
    driven(
        "circle",
        3,
        &[(1, [0.8, -0.4, 0.0])],
        |t| vec![OnCircle::new(P[1], [0.0; 3], [1.0, 2.0, 2.0], t.s()).into()],
        &["(p1.x + 2*p1.y + 2*p1.z)/3", "length(p1) - S"],
        PUSH,
    ),
    twin(
        "circle about a particle",
        3,
        &[(1, [0.8, -0.4, 0.0])],
        |t| vec![OnCircle::new(P[1], P[0], [1.0, 2.0, 2.0], t.s()).into()],
        &["dot([1, 2, 2], p1 - p0)/3", "dist(p0, p1) - S"],
    ),
    twin(
        "ellipse",
        2,
        &[(1, [0.6, 0.8, 0.0])],
        |t| {
            let center = Anchor::Point([t.of("sin(t)/2"), 0.0.into(), 0.0.into()]);
            let half = [t.of("1 + 0.1*sin(2*t)^2"), t.of("0.7 + 0.2*sin(t)^2")];
            vec![OnEllipse { particle: P[1], center, along: [3.0, 4.0, 0.0], half }.into()]
        },
        &["sqrt((1 + 0.1*sin(2*t)^2)*(0.7 + 0.2*sin(t)^2))\
           *(length([(0.6*(p1.x - sin(t)/2) + 0.8*p1.y)/(1 + 0.1*sin(2*t)^2), \
           (0.6*p1.y - 0.8*(p1.x - sin(t)/2))/(0.7 + 0.2*sin(t)^2)]) - 1)"],
    ),
    twin(
        "ellipse about a particle",
        2,
        &[(1, [0.8, 0.0, 0.0])],
        |_| vec![OnEllipse::new(P[1], P[0], [1.0, 0.0, 0.0], [0.8, 0.5]).into()],
        &["sqrt(0.8*0.5)*(length([(p1.x - p0.x)/0.8, (p1.y - p0.y)/0.5]) - 1)"],
    ),
    twin("circle as a curve", 2, &[], |_| vec![on_curve(&["cos(s)", "sin(s)"])], &["dot(p1, p1) - 1"]).other_rows(),
    twin("parabola", 2, &[(1, [0.4, 0.08, 0.0])], |_| vec![on_curve(&["s", "s^2/2"])], &["p1.y - p1.x^2/2"])
        .other_rows(),
    twin(
        "helix",
        3,
        &[(1, [1.0, 0.0, 0.0])],
        |_| vec![on_curve(&["cos(s)", "sin(s)", "s/2"])],
        &["p1.x - cos(2*p1.z)", "p1.y - sin(2*p1.z)"],
    )
    .other_rows()
    .at_start(),
    twin(
        "spline through points in line",
        2,
        &[(1, [1.0, 0.5, 0.0])],
        |_| {
            let curve = Curve::through(&[[-4.0, -2.0, 0.0], [0.0; 3], [4.0, 2.0, 0.0]], false).unwrap();
            vec![OnCurve { particle: P[1], curve }.into()]
        },
        &["p1.x - 2*p1.y"],
    )
    .other_rows(),
    twin(
        "straight piece of a bent wire",
        2,
        &[(1, [1.0, 0.5, 0.0])],
        |_| vec![bent_wire(&[[-4.0, -2.0, 0.0], [4.0, 2.0, 0.0], [4.0, 5.0, 0.0]], 0.5)],
        &["p1.x - 2*p1.y"],
    )
    .other_rows(),
    twin(
        "arc of a bent wire",
        2,
        &[(1, [0.6, -0.8, 0.0])],
        |_| vec![bent_wire(&arc_below(1.0, 0.0), 1.0)],
        &["length(p1) - 1"],
    )
    .other_rows(),
    twin(
        "arc of a bent wire in space",
        3,
        &[(1, [0.36, -0.8, 0.48])],
        |_| vec![bent_wire(&arc_below(0.6, 0.8), 1.0)],
        &["0.8*p1.x - 0.6*p1.z", "length(p1) - 1"],
    )
    .other_rows()
    .at_start(),
    twin("pulley", 2, &[], |t| vec![Lengths::pulley(&P[..3], t.s()).into()], &["dist(p0, p1) + dist(p1, p2) - S"])
        .anywhere(),
    twin(
        "ratio",
        3,
        &[(1, [0.6, 0.0, 0.8]), (2, [0.3, 0.4, 0.0])],
        |_| vec![Lengths::ratio([P[0], P[1]], [P[2], P[0]], 2.0).into()],
        &["dist(p0, p1) - 2*dist(p0, p2)"],
    )
    .anywhere(),
    twin(
        "equal lengths",
        2,
        &[(2, [0.6, 0.8, 0.0])],
        |_| vec![Lengths::ratio([P[0], P[1]], [P[2], P[0]], 1.0).into()],
        &["dot(p0 - p1, p0 - p1) - dot(p0 - p2, p0 - p2)"],
    )
    .other_rows()
    .anywhere(),
    driven(
        "winch of a tackle",
        3,
        &[],
        |t| vec![Lengths::new(&[([P[0], P[1]], 1.0), ([P[1], P[2]], 2.0)], t.s()).into()],
        &["dist(p0, p1) + 2*dist(p1, p2) - S"],
        PUSH,
    )
    .anywhere(),
    twin(
        "angle",
        2,
        &[],
        |t| vec![Angle::between([P[0], P[1]], [P[0], P[2]], t.s()).into()],
        &["atan2(cross(p1 - p0, p2 - p0), dot(p1 - p0, p2 - p0)) - S"],
    )
    .turns()
    .anywhere(),
    driven(
        "driven angle in space",
        3,
        &[],
        |t| vec![Angle::between([P[0], P[1]], [P[3], P[2]], t.s()).into()],
        &["atan2(length(cross(p1 - p0, p2 - p3)), dot(p1 - p0, p2 - p3)) - S"],
        PUSH,
    )
    .turns()
    .anywhere(),
    twin(
        "angle from a direction",
        3,
        &[],
        |t| vec![Angle::from_direction([1.0, 2.0, -1.0], [P[0], P[2]], t.s()).into()],
        &["atan2(length(cross([1, 2, -1], p2 - p0)), dot([1, 2, -1], p2 - p0)) - S"],
    )
    .turns()
    .anywhere(),
    driven(
        "motor",
        2,
        &[],
        |t| vec![Angle::from_direction([1.0, 0.0, 0.0], [P[0], P[1]], t.s()).into()],
        &["atan2(p1.y - p0.y, p1.x - p0.x) - S"],
        "2*t",
    )
    .turns()
    .anywhere(),
    twin(
        "gears",
        2,
        &[],
        |t| vec![Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [20, 10], t.s()).into()],
        &["2*atan2(p1.y - p0.y, p1.x - p0.x) + atan2(p3.y - p2.y, p3.x - p2.x) \
             - 3*atan2(p2.y - p0.y, p2.x - p0.x) - S"],
    )
    .turns()
    .anywhere(),
    driven(
        "hands of a clock",
        2,
        &[],
        |t| vec![Gears::coupled(&[([P[0], P[1]], 3), ([P[0], P[2]], -1)], t.s()).into()],
        &["3*atan2(p1.y - p0.y, p1.x - p0.x) - atan2(p2.y - p0.y, p2.x - p0.x) - S"],
        PUSH,
    )
    .turns()
    .anywhere(),
    twin(
        "rack",
        2,
        &[],
        |t| vec![Gears::rack([P[0], P[1]], P[2], [3.0, 4.0], 0.5, t.s()).into()],
        &["atan2(p1.y - p0.y, p1.x - p0.x) - dot([0.6, 0.8], p2 - p0)/0.5 - S"],
    )
    .turns()
    .anywhere(),
    driven(
        "area",
        2,
        &[],
        |t| vec![Area { corners: vec![P[0], P[1], P[2], P[3]], area: t.s() }.into()],
        &["area(p0, p1, p2, p3) - S"],
        PUSH,
    )
    .anywhere(),
    driven(
        "volume",
        3,
        &[],
        |t| vec![Volume::tetrahedron([P[0], P[1], P[2], P[3]], t.s()).into()],
        &["volume(p0, p1, p2, p3) - S"],
        PUSH,
    )
    .anywhere(),
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
            // Nine of the ten distances, including the distance for which there is no rod.
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
    )
    .other_rows(),
    twin(
        "tackle with points passed twice",
        2,
        &[],
        |t| vec![tackle(t)],
        &["dist(p0, p1) + 2*dist(p1, p2) + 0.5*dist(p1, p0) - S"],
    )
    .anywhere(),
    driven(
        "tackle with points passed twice, in space",
        3,
        &[],
        |t| vec![tackle(t)],
        &["dist(p0, p1) + 2*dist(p1, p2) + 0.5*dist(p1, p0) - S"],
        PUSH,
    )
    .anywhere(),
    twin(
        "ratio of lengths with a shared end",
        3,
        &[(1, [1.7, 0.0, 0.0]), (3, [1.7, 1.0, 0.0])],
        |_| vec![Lengths::ratio([P[0], P[1]], [P[1], P[3]], 1.7).into()],
        &["dist(p0, p1) - 1.7*dist(p3, p1)"],
    )
    .anywhere(),
    driven(
        "angle between arms",
        2,
        &[],
        |t| vec![Angle::between([P[0], P[1]], [P[2], P[3]], t.s()).into()],
        &["atan2(cross(p1 - p0, p3 - p2), dot(p1 - p0, p3 - p2)) - S"],
        "(t + sin(2*t))/5",
    )
    .turns()
    .anywhere(),
    driven(
        "angle at a corner in space",
        3,
        &[],
        |t| vec![Angle::between([P[1], P[0]], [P[1], P[2]], t.s()).into()],
        &["atan2(length(cross(p0 - p1, p2 - p1)), dot(p0 - p1, p2 - p1)) - S"],
        "0.3*sin(t)",
    )
    .turns()
    .anywhere(),
    driven(
        "angle from a direction in the plane",
        2,
        &[],
        |t| vec![Angle::from_direction([1.0, 2.0, 7.0], [P[3], P[2]], t.s()).into()],
        &["atan2(cross([1, 2], p2 - p3), dot([1, 2], p2 - p3)) - S"],
        // So slow that the twin's angle does not reach ±π, where it jumps.
        "-0.3*t",
    )
    .turns()
    .anywhere(),
    driven(
        "gears, one inside the other",
        2,
        &[],
        // 30 and -12 teeth: 5 and -2.
        |t| vec![Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [30, -12], t.s()).into()],
        &["5*atan2(p1.y - p0.y, p1.x - p0.x) - 2*atan2(p3.y - p2.y, p3.x - p2.x) \
             - 3*atan2(p2.y - p0.y, p2.x - p0.x) - S"],
        "sin(3*t)",
    )
    .turns()
    .anywhere(),
    twin(
        "hour and minute hand",
        2,
        &[],
        |t| vec![Gears::coupled(&[([P[0], P[1]], 12), ([P[0], P[2]], -1)], t.s()).into()],
        &["12*atan2(p1.y - p0.y, p1.x - p0.x) - atan2(p2.y - p0.y, p2.x - p0.x) - S"],
    )
    .turns()
    .anywhere(),
    driven(
        "driven rack and pinion",
        2,
        &[],
        |t| vec![Gears::rack([P[0], P[1]], P[2], [3.0, 4.0], 0.25, t.s()).into()],
        &["atan2(p1.y - p0.y, p1.x - p0.x) - dot([0.6, 0.8], p2 - p0)/0.25 - S"],
        "t^2",
    )
    .turns()
    .anywhere(),
    driven(
        "area of a pentagon that crosses itself",
        2,
        &[],
        |t| vec![Area { corners: vec![P[0], P[2], P[1], P[4], P[3]], area: t.s() }.into()],
        &["area(p0, p2, p1, p4, p3) - S"],
        "0.1*(t - t^2)",
    )
    .anywhere(),
    twin(
        "volume, its corners in another order",
        3,
        &[],
        |t| vec![Volume::tetrahedron([P[2], P[0], P[1], P[3]], t.s()).into()],
        &["volume(p2, p0, p1, p3) - S"],
    )
    .anywhere(),
    driven(
        "volume of two tetrahedra on one face",
        3,
        &[],
        |t| {
            let faces = [[0, 1, 3], [1, 2, 3], [2, 0, 3], [1, 0, 4], [2, 1, 4], [0, 2, 4]];
            vec![Volume::new(&faces.map(|corners| corners.map(|i| P[i])), t.s()).into()]
        },
        &["volume(p0, p1, p2, p3) - volume(p0, p1, p2, p4) - S"],
        "0.1*(cos(t) - 1)",
    )
    .anywhere(),
    driven("expression", 2, &[], |t| vec![t.row("length(p1 - p2) - S")], &["dist(p1, p2) - S"], PUSH).anywhere(),
    twin("expression in space", 3, &[], |t| vec![t.row("length(p1 - p2) - S")], &["dist(p1, p2) - S"]).anywhere(),
    twin(
        "custom",
        2,
        &[],
        |_| {
            let apart = |x: &[[Hyper; 3]], _: Hyper| (x[1][0] - x[0][0]).hypot(x[1][1] - x[0][1]) - libm::sqrt(1.85);
            vec![Custom::new([P[1], P[2]], apart).into()]
        },
        &["dist(p1, p2) - sqrt(1.85)"],
    )
    .anywhere(),
    twin(
        "custom in space",
        3,
        &[],
        |_| {
            let square = |x: &[[Hyper; 3]], _: Hyper| (0..3).map(|k| (x[1][k] - x[0][k]).powi(2)).sum::<Hyper>() - 1.94;
            vec![Custom::new([P[1], P[2]], square).into()]
        },
        &["dot(p2 - p1, p2 - p1) - 1.94"],
    )
    .anywhere(),
    twin(
        "custom of two particles and time",
        2,
        &[],
        |t| {
            let later = t.later();
            let shear =
                move |x: &[[Hyper; 3]], t: Hyper| (x[0][0] - x[1][0]).hypot(x[0][1] - x[1][1] * (t + later).exp());
            vec![Custom::new([P[2], P[1]], shear).into()]
        },
        &["sqrt((p2.x - p1.x)^2 + (p2.y - p1.y*exp(t))^2)"],
    )
    .without_motion(),
    twin(
        "custom of three particles and time, in space",
        3,
        &[],
        |t| {
            let later = t.later();
            let wavy = move |x: &[[Hyper; 3]], t: Hyper| {
                (x[0][2] * x[1][0]).sin() + x[2][1] * (t + later - x[1][1]) + x[0][0].powi(3) * x[2][2]
            };
            vec![Custom::new([P[1], P[3], P[0]], wavy).into()]
        },
        &["sin(p1.z*p3.x) + p0.y*(t - p3.y) + p1.x^3*p0.z"],
    )
    .without_motion(),
    twin(
        "rope and strut",
        2,
        &[],
        |_| vec![Limits::between(P[0], P[1], 0.5, 1.2).into()],
        &["1.2 - dist(p0, p1)", "dist(p0, p1) - 0.5"],
    )
    .one_sided()
    .anywhere(),
    twin("rope in space", 3, &[], |_| vec![Limits::rope(P[1], P[0], 1.2).into()], &["1.2 - dist(p0, p1)"])
        .one_sided()
        .anywhere(),
    twin("slope", 2, &[], |_| vec![half_space()], &["0.6*p1.x + 0.8*p1.y + 1.5"]).one_sided().anywhere(),
    twin("slope in space", 3, &[], |_| vec![half_space()], &["0.6*p1.x + 0.8*p1.y + 1.5"]).one_sided().anywhere(),
    twin("outside of a circle", 2, &[], |_| vec![ball(false)], &["dist(p1, [0.3, -0.4]) - 0.5"]).one_sided(),
    twin("inside of a ball", 3, &[], |_| vec![ball(true)], &["0.5 - dist(p1, [0.3, -0.4, 0.1])"]).one_sided(),
    // Off its corner, whose radius is a thousandth of 0.5 m.
    twin("corner of a box", 2, &[], |_| vec![corner_of_a_box()], &["length(p1 - [0.2995, -0.4005]) - 0.0005"])
        .one_sided(),
    twin(
        "corner of a box in space",
        3,
        &[],
        |_| vec![corner_of_a_box()],
        &["length(p1 - [0.2995, -0.4005, -0.2005]) - 0.0005"],
    )
    .one_sided(),
];

/// Back and forth between p0 and p1, once with half the weight.
fn tackle(t: &Clock) -> Constraint {
    Lengths::new(&[([P[0], P[1]], 1.0), ([P[2], P[1]], 2.0), ([P[1], P[0]], 0.5)], t.s()).into()
}

fn scalar_nail() -> Constraint {
    Nail { form: NailForm::Scalar, ..Nail::new(P[1], [0.4, -0.7, 0.2]) }.into()
}

fn half_space() -> Constraint {
    Obstacle::new(P[1], Surface::HalfSpace { normal: [3.0, 4.0, 0.0], offset: -1.5 }).into()
}

fn ball(inside: bool) -> Constraint {
    Obstacle::new(P[1], Surface::Ball { center: [0.3, -0.4, 0.1], radius: 0.5, inside }).into()
}

/// Its highest corner is at (0.3, −0.4, −0.2).
fn corner_of_a_box() -> Constraint {
    Obstacle::new(P[1], Surface::Box { center: [-0.2, -0.9, -0.7], half: [0.5; 3] }).into()
}

fn squared_rod() -> Constraint {
    Distance { form: DistanceForm::Squared, ..Distance::new(P[0], P[1], 1.0) }.into()
}

fn weights() -> Constraint {
    let terms = vec![(P[0], 2.0), (P[1], -1.0), (P[2], 0.5)];
    Relation { terms, point: [(-0.9).into(), 0.55.into(), 0.0.into()] }.into()
}

/// A direction that turns about z.
fn turning(t: &Clock) -> [Driven; 3] {
    [t.of("cos(t)"), t.of("sin(t)"), 0.0.into()]
}

/// A direction that turns about z and rises along z.
fn rising(t: &Clock) -> [Driven; 3] {
    [t.of("cos(t)"), t.of("sin(t)"), t.of("0.2 + t/5")]
}

fn on_curve(components: &[&str]) -> Constraint {
    let d = if components.len() == 2 { 2 } else { 3 };
    let components = components.iter().map(|text| parse(text, Purpose::Curve, d)).collect();
    OnCurve { particle: P[1], curve: Curve::parametric(components, -6.0, 6.0).unwrap() }.into()
}

/// A corner whose arc of radius 1 lies about the origin, from 74° before the lowest point, along (x, 0, z), to 74°
/// after it.
fn arc_below(x: f64, z: f64) -> [[f64; 3]; 3] {
    let (depth, way) = (25.0 / 7.0, 5.0);
    let end = |side: f64| [0.28 * way * side * x, 0.96 * way - depth, 0.28 * way * side * z];
    [end(-1.0), [0.0, -depth, 0.0], end(1.0)]
}

fn bent_wire(points: &[[f64; 3]], radius: f64) -> Constraint {
    OnCurve { particle: P[1], curve: Curve::polyline(points, radius, false).unwrap() }.into()
}

//! The sign of every reaction, by closed forms. The table of docs/method/signs.md has the same rows; a row without a
//! test here, or a test without a row there, fails.

use qhat::{
    Angle, Area, Constraint, Dimension, Distance, Gears, Gravity, Lengths, Limits, Nail, Obstacle, OnCircle, OnLine,
    OnPlane, OnSphere, Particle, ParticleId, PointForce, Relation, Settings, Simulation, Surface, System,
    SystemBuilder,
};
use std::collections::BTreeSet;
use std::path::Path;

/// m [kg], g [m/s²], m g [N] and the length of arms [m].
const M: f64 = 2.0;
const G: f64 = 10.0;
const W: f64 = M * G;
const L: f64 = 0.5;

/// Forces at rest are solved to twelve digits; statics over several rows lose a few.
const ROUNDOFF: f64 = 1e-10;

/// A weight at a place, in the plane.
fn weight(builder: &mut SystemBuilder, at: [f64; 2]) -> ParticleId {
    builder.particle(Particle::at(format!("weight at {at:?}"), at).with_mass(M))
}

fn fixed(builder: &mut SystemBuilder, at: [f64; 2]) -> ParticleId {
    builder.particle(Particle::at(format!("fixed at {at:?}"), at).fixed())
}

/// λ of the constraint that `add` gives, at rest under gravity in the plane.
fn reaction(add: impl FnOnce(&mut SystemBuilder) -> Constraint) -> Vec<f64> {
    at_rest(Dimension::Two, [0.0, -G, 0.0], add)
}

fn at_rest(dimension: Dimension, gravity: [f64; 3], add: impl FnOnce(&mut SystemBuilder) -> Constraint) -> Vec<f64> {
    let mut builder = System::builder(dimension);
    builder.force(Gravity { acceleration: gravity });
    let constraint = add(&mut builder);
    let id = builder.constraint("it", constraint);
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
    simulation.step().unwrap();
    simulation.reaction(id)
}

type Case = (&'static str, fn() -> Vec<f64>, Vec<f64>);

/// The word of each row of the table, λ, and its closed form.
fn cases() -> Vec<Case> {
    vec![
        ("rod", || reaction(|b| Distance::new(fixed(b, [0.0, 1.0]), weight(b, [0.0, 0.0]), 1.0).into()), vec![-W]),
        ("rope", || reaction(|b| Limits::rope(fixed(b, [0.0, 1.0]), weight(b, [0.0, 0.0]), 1.0).into()), vec![W]),
        ("strut", || reaction(|b| Limits::strut(fixed(b, [0.0, -1.0]), weight(b, [0.0, 0.0]), 1.0).into()), vec![W]),
        ("nail", || reaction(|b| Nail::new(weight(b, [0.0, 0.0]), [0.0, 0.0, 0.0]).into()), vec![0.0, W]),
        (
            "relation",
            || {
                // λ is the force on a particle that has the weight 1 in the relation.
                reaction(|b| {
                    let terms = vec![(weight(b, [0.0, 0.0]), 1.0)];
                    Relation { terms, point: [0.0, 0.0, 0.0].map(Into::into) }.into()
                })
            },
            vec![0.0, W],
        ),
        (
            "roller on a line",
            || reaction(|b| OnLine::fixed(weight(b, [0.0, 0.0]), [0.0; 3], [1.0, 0.0, 0.0]).into()),
            vec![W],
        ),
        (
            "roller on a plane",
            || {
                at_rest(Dimension::Three, [0.0, 0.0, -G], |b| {
                    let weight = b.particle(Particle::at("weight", [0.0, 0.0, 0.0]).with_mass(M));
                    OnPlane::fixed(weight, [0.0; 3], [0.0, 0.0, 1.0]).into()
                })
            },
            vec![W],
        ),
        ("sphere", || reaction(|b| OnSphere::new(weight(b, [0.0, -1.0]), [0.0; 3], 1.0).into()), vec![-W]),
        (
            "circle",
            || {
                at_rest(Dimension::Three, [0.0, -G, 0.0], |b| {
                    let weight = b.particle(Particle::at("weight", [0.0, -1.0, 0.0]).with_mass(M));
                    OnCircle::new(weight, [0.0; 3], [0.0, 0.0, 1.0], 1.0).into()
                })
            },
            vec![0.0, -W],
        ),
        (
            "ground with friction",
            || {
                // Pushed to the right by less than the friction that holds; the tangent points to the left.
                reaction(|b| {
                    let weight = weight(b, [0.0, 0.0]);
                    b.force(PointForce::new(weight, [3.0, 0.0]));
                    Obstacle::new(weight, Surface::half_space([0.0, 1.0], 0.0)).with_friction(0.5).into()
                })
            },
            vec![W, 3.0],
        ),
        (
            "motor",
            || {
                reaction(|b| {
                    let (hinge, weight) = (fixed(b, [0.0, 0.0]), weight(b, [L, 0.0]));
                    b.constraint("arm", Distance::new(hinge, weight, L));
                    Angle::from_direction([1.0, 0.0, 0.0], [hinge, weight], 0.0).into()
                })
            },
            vec![W * L],
        ),
        (
            "gears",
            || {
                reaction(|b| {
                    let (one, other) = (fixed(b, [0.0, 0.0]), fixed(b, [3.0, 0.0]));
                    let (weight, held) = (weight(b, [L, 0.0]), fixed(b, [3.0 + L, 0.0]));
                    b.constraint("arm", Distance::new(one, weight, L));
                    // 3 α₁ + 2 α₂ − 5 ψ stays 0, and a torque of 3 λ turns the first wheel up.
                    Gears::mesh([[one, weight], [other, held]], [30, 20], 0.0).into()
                })
            },
            vec![W * L / 3.0],
        ),
        (
            "pulley",
            || {
                reaction(|b| {
                    let guide = fixed(b, [0.0, 1.0]);
                    let (left, right) = (weight(b, [0.0, 0.0]), weight(b, [0.0, -1.0]));
                    Lengths::pulley(&[left, guide, right], 3.0).into()
                })
            },
            vec![-W],
        ),
        (
            "area",
            || {
                // A column of gas of the width 1 m carries the weight: the pressure is W per metre.
                reaction(|b| {
                    let corners =
                        [fixed(b, [0.0, 0.0]), fixed(b, [1.0, 0.0]), weight(b, [1.0, 1.0]), weight(b, [0.0, 1.0])];
                    for (k, corner) in corners[2..].iter().enumerate() {
                        let foot = [1.0 - k as f64, 0.0, 0.0];
                        b.constraint(format!("guide{k}"), OnLine::fixed(*corner, foot, [0.0, 1.0, 0.0]));
                    }
                    Area { corners: corners.to_vec(), area: 1.0.into() }.into()
                })
            },
            vec![2.0 * W],
        ),
    ]
}

#[test]
fn every_reaction_has_the_sign_of_the_table() {
    let mut wrong = Vec::new();
    for (word, found, expected) in cases() {
        let found = found();
        assert_eq!(found.len(), expected.len(), "{word}: {found:?}");
        if found.iter().zip(&expected).any(|(found, expected)| (found - expected).abs() > ROUNDOFF * W) {
            wrong.push(format!("{word}: {found:?} and not {expected:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_table_of_signs_has_a_row_for_every_test() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/method/signs.md");
    let text = std::fs::read_to_string(path).unwrap();
    let table = text.lines().filter_map(|line| line.strip_prefix("| ")?.split(" | ").next());
    let rows: BTreeSet<&str> = table.filter(|cell| !matches!(*cell, "constraint" | "---")).collect();
    let tested: BTreeSet<&str> = cases().iter().map(|(word, ..)| *word).collect();
    assert_eq!(rows, tested);
}

//! Redundant rows share a force as elastic rods in the limit of infinite stiffness: hand-derived values.

use crate::systems::dense::assert_close;
use qhat::{
    Dimension, Distance, DistanceForm, ExpressionConstraint, Gravity, Limits, Nail, Obstacle, Particle, ParticleId,
    PointForce, Purpose, Settings, Simulation, Surface, System, SystemBuilder, evaluate,
};

/// The square of 1 m, hung by its corners a and b, with both diagonals: 1000 N pull down at d.
struct Square {
    /// The masses of c and d [kg].
    masses: [f64; 2],
    /// The order of the rods: indices into a-c, b-d, c-d, a-d, b-c.
    order: [usize; 5],
    /// Which rods have the squared form.
    squared: [bool; 5],
    /// Metres in the unit of length.
    unit: f64,
}

const PLAIN: Square = Square { masses: [1.0, 1.0], order: [0, 1, 2, 3, 4], squared: [false; 5], unit: 1.0 };

const RODS: [[usize; 2]; 5] = [[0, 2], [1, 3], [2, 3], [0, 3], [1, 2]];

/// T = S J u with (Jᵀ S J) u = F, S = diag(1/L), solved by hand for the five rods.
fn by_hand() -> [f64; 5] {
    [442.242_299, -557.757_701, 442.242_299, 788.788_505, -625.425_057]
}

impl Square {
    fn tension(&self) -> [f64; 5] {
        let mut builder = System::builder(Dimension::Two);
        let Square { masses, unit, .. } = *self;
        let at = [[0.0, 0.0], [0.0, -unit], [unit, 0.0], [unit, -unit]];
        let ids: Vec<ParticleId> = (0..4)
            .map(|i| {
                let particle = Particle::at(i.to_string(), at[i]);
                builder.particle(if i < 2 { particle.fixed() } else { particle.with_mass(masses[i - 2]) })
            })
            .collect();
        for rod in self.order {
            let [a, b] = RODS[rod];
            let length = unit * if rod < 3 { 1.0 } else { 2.0_f64.sqrt() };
            let form = if self.squared[rod] { DistanceForm::Squared } else { DistanceForm::Length };
            builder.constraint(rod.to_string(), Distance { form, ..Distance::new(ids[a], ids[b], length) });
        }
        builder.force(PointForce { particle: ids[3], force: [0.0, -1000.0, 0.0] });
        let (system, state) = builder.build().unwrap();
        let terms = evaluate(&system, &state);
        assert_eq!(terms.tension_is_unique, [false; 5]);
        let mut tension = [0.0; 5];
        for (rod, found) in self.order.into_iter().zip(terms.tension) {
            tension[rod] = found;
        }
        tension
    }
}

#[test]
fn a_braced_square_shares_its_load_under_any_masses_orders_forms_and_units() {
    let plain = PLAIN.tension();
    for (rod, (found, expected)) in plain.into_iter().zip(by_hand()).enumerate() {
        assert_close(&rod.to_string(), found, expected, 1e-6);
    }
    let same = |what: &str, square: Square| {
        for (found, expected) in square.tension().into_iter().zip(plain) {
            assert_close(what, found, expected, 1e-12 * 1000.0);
        }
    };
    for exponent in [-3, -1, 1, 2, 3, 6] {
        let heavy = 10.0_f64.powi(exponent);
        same("c heavy", Square { masses: [heavy, 1.0], ..PLAIN });
        same("d heavy", Square { masses: [1.0, heavy], ..PLAIN });
    }
    for order in [[4, 3, 2, 1, 0], [2, 0, 4, 1, 3], [3, 4, 0, 1, 2]] {
        same("order", Square { order, ..PLAIN });
    }
    for squared in [[true; 5], [true, false, true, false, false]] {
        same("form", Square { squared, ..PLAIN });
    }
    for unit in [1e-3, 1e3, 25.4] {
        same("unit", Square { unit, ..PLAIN });
    }
}

fn load(builder: &mut SystemBuilder, particle: ParticleId, force: [f64; 3]) {
    builder.force(PointForce { particle, force });
}

fn fixed(builder: &mut SystemBuilder, name: &str, at: [f64; 2]) -> ParticleId {
    builder.particle(Particle::at(name, at).fixed())
}

/// A weight of 30 N on parallel links of 1 m.
fn side_by_side(link: impl Fn(&mut SystemBuilder, ParticleId, ParticleId)) -> Simulation {
    let mut builder = System::builder(Dimension::Two);
    let hook = fixed(&mut builder, "hook", [0.0, 0.0]);
    let weight = builder.particle(Particle::at("weight", [0.0, -1.0]).with_mass(3.0));
    link(&mut builder, hook, weight);
    builder.force(Gravity { acceleration: [0.0, -10.0, 0.0] });
    let (system, state) = builder.build().unwrap();
    Simulation::new(system, state, Settings::default()).unwrap()
}

#[test]
fn parallel_ropes_share_by_their_stiffness_and_a_slack_one_carries_nothing() {
    let stiffness = [1.0, 2.0, 3.0];
    let mut ropes = side_by_side(|builder, hook, weight| {
        for (i, stiffness) in stiffness.into_iter().enumerate() {
            builder.constraint(i.to_string(), Limits::rope(hook, weight, 1.0).with_stiffness(stiffness));
        }
        builder.constraint("slack", Limits::rope(hook, weight, 1.5));
    });
    let terms = ropes.terms();
    for (tension, stiffness) in terms.tension.iter().zip(stiffness) {
        assert_close("tension", *tension, 30.0 * stiffness / 6.0, 1e-12 * 30.0);
    }
    assert_eq!(terms.tension[3], 0.0);
    assert_eq!(terms.tension_is_unique, [false, false, false, true]);
}

/// A rod, a driven rod that stands still and a rope are the same rod three times.
#[test]
fn a_rod_held_three_times_carries_a_third_each() {
    let mut rods = side_by_side(|builder, hook, weight| {
        builder.constraint("rod", Distance::new(hook, weight, 1.0));
        builder.constraint("squared", Distance { form: DistanceForm::Squared, ..Distance::new(hook, weight, 1.0) });
        builder.constraint("driven", Distance::driven(hook, weight, 1.0));
    });
    let terms = rods.terms();
    for (row, gradient) in [1.0, 2.0, 1.0].into_iter().enumerate() {
        assert_close("tension", -gradient * terms.multipliers[row], 10.0, 1e-12 * 30.0);
    }
}

/// Rows that are no rods share by force and not by λ: `1000*y` beside `y` carries half.
#[test]
fn a_multiple_of_a_row_carries_as_much_as_the_row() {
    let mut rows = side_by_side(|builder, _, _| {
        for text in ["1000*(weight.y + 1)", "weight.y + 1"] {
            let expression = builder.expression(Purpose::Constraint, text).unwrap();
            builder.constraint(text, ExpressionConstraint::new(expression, &[0.0, 0.0, 0.0, -1.0]));
        }
    });
    let terms = rows.terms();
    assert_close("1000 y", 1000.0 * terms.multipliers[0], 15.0, 1e-12 * 30.0);
    assert_close("y", terms.multipliers[1], 15.0, 1e-12 * 30.0);
    assert_eq!(terms.multiplier_is_unique, [false; 2]);
    assert!(terms.tension.is_empty());
}

/// Two rods of 1 m and 3 m in line between nails, 8 N pulled at their joint: a nail does not give way, so the rods
/// share as if their ends were fixed: T₁ − T₂ = 8 N and T₁ L₁ + T₂ L₂ = 0.
#[test]
fn nails_weigh_nothing_against_rods() {
    let mut builder = System::builder(Dimension::Two);
    let ids = [0.0, 1.0, 4.0].map(|x| builder.particle(Particle::at(x.to_string(), [x, 0.0]).with_mass(x + 1.0)));
    builder.constraint("one", Distance::new(ids[0], ids[1], 1.0));
    builder.constraint("other", Distance::new(ids[1], ids[2], 3.0));
    for (id, x) in [(ids[0], 0.0), (ids[2], 4.0)] {
        builder.constraint(format!("nail {x}"), Nail::new(id, [x, 0.0, 0.0]));
    }
    // A second nail takes half of the first one's force.
    builder.constraint("again", Nail::new(ids[0], [0.0; 3]));
    load(&mut builder, ids[1], [8.0, 0.0, 0.0]);
    let (system, state) = builder.build().unwrap();
    let terms = evaluate(&system, &state);
    assert_close("one", terms.tension[0], 6.0, 1e-12 * 8.0);
    assert_close("other", terms.tension[1], -2.0, 1e-12 * 8.0);
    for (row, force) in [(2, -3.0), (3, 0.0), (4, -2.0), (5, 0.0), (6, -3.0), (7, 0.0)] {
        assert_close(&system.row_names()[row], terms.multipliers[row], force, 1e-12 * 8.0);
    }
    // No self-stress pushes the right nail upwards, and the two left nails could push against each other.
    let unique = [false, false, false, true];
    assert_eq!(terms.multiplier_is_unique[..2], [false; 2]);
    assert_eq!([2, 3, 4, 5].map(|row| terms.multiplier_is_unique[row]), [false, false, unique[0], true]);
}

/// A square of ropes and struts with rope diagonals: the diagonal that would have to push is slack, and the rest is
/// determinate: the other carries 1000 √2 N.
#[test]
fn a_rope_that_would_have_to_push_is_slack() {
    let mut builder = System::builder(Dimension::Two);
    let a = fixed(&mut builder, "a", [0.0, 0.0]);
    let b = fixed(&mut builder, "b", [0.0, -1.0]);
    let c = builder.particle(Particle::at("c", [1.0, 0.0]));
    let d = builder.particle(Particle::at("d", [1.0, -1.0]).with_mass(20.0));
    for (name, ends) in [("a-c", (a, c)), ("b-d", (b, d)), ("c-d", (c, d))] {
        builder.constraint(name, Distance::new(ends.0, ends.1, 1.0));
    }
    for (name, ends) in [("a-d", (a, d)), ("b-c", (b, c))] {
        builder.constraint(name, Limits::rope(ends.0, ends.1, 2.0_f64.sqrt()));
    }
    load(&mut builder, d, [0.0, -1000.0, 0.0]);
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
    let terms = simulation.terms();
    for (tension, expected) in terms.tension.iter().zip([0.0, -1000.0, 0.0, 1000.0 * 2.0_f64.sqrt(), 0.0]) {
        assert_close("tension", *tension, expected, 1e-9);
    }
    assert!(terms.tension[4] >= 0.0);
}

/// A table of weight W on four legs at (±1, ±1), loaded at (0.6, 0.6): the legs balance a force and two moments, so the
/// normal of leg i is (x_i, y_i, 1). The least norm without signs would pull the far leg with −0.05 W; with signs it
/// stands free, and the other three carry 0.2, 0.2 and 0.6 of W.
#[test]
fn no_leg_of_a_table_pulls() {
    let legs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let rest = |x: f64, y: f64, turn: usize| {
        let mut builder = System::builder(Dimension::Three);
        let table = builder.particle(Particle::at("table", [0.0; 3]).with_mass(7.0));
        for i in 0..4 {
            let i = (i + turn) % 4;
            let surface = Surface::HalfSpace { normal: [legs[i][0], legs[i][1], 1.0], offset: 0.0 };
            builder.constraint(i.to_string(), Obstacle::new(table, surface));
        }
        load(&mut builder, table, [-100.0 * x, -100.0 * y, -100.0]);
        let (system, state) = builder.build().unwrap();
        let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
        let terms = simulation.terms();
        let mut forces = [0.0; 4];
        for (row, lambda) in terms.multipliers.iter().enumerate() {
            forces[(row + turn) % 4] = lambda * 3.0_f64.sqrt().recip();
        }
        forces
    };
    for turn in 0..4 {
        for (force, expected) in rest(0.6, 0.6, turn).into_iter().zip([60.0, 20.0, 20.0, 0.0]) {
            assert_close("beyond the middle", force, expected, 1e-10);
            assert!(force >= 0.0);
        }
        // Within the kernel of the table the least norm has the right signs: W/4 (1 ± x ± y).
        for (force, expected) in rest(0.1, 0.2, turn).into_iter().zip([32.5, 22.5, 27.5, 17.5]) {
            assert_close("near the middle", force, expected, 1e-10);
        }
    }
}

/// A crossed cantilever of unit bays under unequal loads: the tensions balance them at every joint, whatever its length.
#[test]
fn tensions_of_long_trusses_balance_the_loads() {
    for bays in [10, 200, 1000] {
        let mut builder = System::builder(Dimension::Two);
        let ids: Vec<ParticleId> = (0..2 * bays + 2)
            .map(|i| {
                let particle = Particle::at(i.to_string(), [(i / 2) as f64, (i % 2) as f64]);
                builder.particle(if i < 2 { particle.fixed() } else { particle.with_mass(1.0 + (i % 7) as f64) })
            })
            .collect();
        let mut rods = Vec::new();
        for i in 0..bays {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| 2 * i + k);
            rods.extend([(a, c), (b, d), (c, d), (a, d), (b, c)]);
        }
        for &(a, b) in &rods {
            let length = if (b - a) % 2 == 1 && b - a != 1 { 2.0_f64.sqrt() } else { 1.0 };
            builder.constraint(format!("{a} {b}"), Distance::new(ids[a], ids[b], length));
        }
        builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
        let (system, state) = builder.build().unwrap();
        let terms = evaluate(&system, &state);
        let mut left = terms.applied_forces.clone();
        for (&(a, b), tension) in rods.iter().zip(&terms.tension) {
            let d = [0, 1].map(|k| terms.positions[2 * b + k] - terms.positions[2 * a + k]);
            let length = libm::hypot(d[0], d[1]);
            for k in 0..2 {
                left[2 * a + k] += tension * d[k] / length;
                left[2 * b + k] -= tension * d[k] / length;
            }
        }
        let off = left[4..].iter().fold(0.0_f64, |most, left| most.max(left.abs()));
        let most = terms.tension.iter().fold(0.0_f64, |most, tension| most.max(tension.abs()));
        assert!(off <= 1e-14 * most, "{bays} bays: {off} N of {most} N");
        assert!(terms.tension_is_unique.iter().all(|is_unique| !is_unique));
    }
}

mod random {
    //! Random redundant frameworks in the plane and in space, many with mechanisms, against a dense reference.

    use super::{Distance, DistanceForm, Nail, Particle, ParticleId, System};
    use crate::systems::dense::{dot, eigen, largest, multiply_transposed};
    use crate::systems::fuzz;
    use crate::systems::random::{Random, dimension};
    use qhat::{Relation, evaluate};

    /// Rows scaled to forces: J_i/|J_i| over particles that can move, for a rod over one of its ends.
    struct Scaled {
        /// m rows of N numbers.
        rows: Vec<Vec<f64>>,
        /// |J_i|.
        size: Vec<f64>,
        /// L/EA; zero for rows that are no rods.
        flexibility: Vec<f64>,
    }

    /// The share by its definition: λ = λ⁰ − N c, N an orthonormal basis of the null space of Jᵀ, c by least squares
    /// for the rods and then, in what they leave free, for the others.
    fn reference(scaled: &Scaled, lambda: &[f64]) -> (Vec<f64>, Vec<bool>) {
        let m = lambda.len();
        let mut x: Vec<f64> = lambda.iter().zip(&scaled.size).map(|(lambda, size)| lambda * size).collect();
        let gram: Vec<f64> = scaled.rows.iter().flat_map(|a| scaled.rows.iter().map(move |b| dot(a, b))).collect();
        let mut free = null_space(gram, m);
        let is_unique = (0..m).map(|i| free.iter().all(|z| z[i].abs() < 1e-9)).collect();
        let others: Vec<f64> = scaled.flexibility.iter().map(|&f| if f > 0.0 { 0.0 } else { 1.0 }).collect();
        for weight in [&scaled.flexibility, &others] {
            let weighed =
                |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).zip(weight).map(|((a, b), w)| a * b * w).sum() };
            let k = free.len();
            let energy: Vec<f64> = free.iter().flat_map(|a| free.iter().map(move |b| weighed(a, b))).collect();
            let slope: Vec<f64> = free.iter().map(|z| weighed(z, &x)).collect();
            let (values, vectors) = eigen(energy, k);
            let zero = 1e-11 * largest(&values);
            let mut rest = Vec::new();
            for (value, vector) in values.iter().zip(&vectors) {
                let z: Vec<f64> = (0..m).map(|i| (0..k).map(|j| vector[j] * free[j][i]).sum()).collect();
                if *value > zero {
                    let step = dot(vector, &slope) / value;
                    x.iter_mut().zip(&z).for_each(|(x, z)| *x -= step * z);
                } else {
                    rest.push(z);
                }
            }
            free = rest;
            if free.is_empty() {
                break;
            }
        }
        (x, is_unique)
    }

    /// An orthonormal basis of the null space of a positive semidefinite matrix.
    fn null_space(matrix: Vec<f64>, m: usize) -> Vec<Vec<f64>> {
        let (values, vectors) = eigen(matrix, m);
        let zero = 1e-11 * largest(&values);
        values.into_iter().zip(vectors).filter(|(value, _)| value.abs() <= zero).map(|(_, vector)| vector).collect()
    }

    #[test]
    fn frameworks_share_as_the_definition_says() {
        let (mut redundant, mut mixed) = (0, 0);
        for seed in 0..120 * fuzz() {
            let random = &mut Random::new(seed);
            let d = 2 + random.below(2);
            let count = 4 + random.below(8);
            let mut builder = System::builder(dimension(d));
            let points = random.points(count, d, 0.4);
            let held = 1 + random.below(3);
            let ids: Vec<ParticleId> = points
                .iter()
                .enumerate()
                .map(|(i, x)| {
                    let x: [f64; 3] = std::array::from_fn(|k| x.get(k).copied().unwrap_or(0.0));
                    let particle =
                        Particle::at(i.to_string(), &x[..d]).with_mass(10.0_f64.powf(random.within(-2.0, 2.0)));
                    builder.particle(if i < held { particle.fixed() } else { particle })
                })
                .collect();
            let mut flexibility = Vec::new();
            for i in 0..count {
                for j in 0..i {
                    if j < held && i < held || random.within(0.0, 1.0) > 0.75 {
                        continue;
                    }
                    let length = (0..d).map(|k| (points[i][k] - points[j][k]).powi(2)).sum::<f64>().sqrt();
                    let form = if random.below(2) == 0 { DistanceForm::Length } else { DistanceForm::Squared };
                    let stiffness = 10.0_f64.powf(random.within(-1.0, 1.0));
                    let rod = Distance { form, stiffness, ..Distance::new(ids[i], ids[j], length) };
                    builder.constraint(format!("rod {i} {j}"), rod);
                    flexibility.push(length / stiffness);
                }
            }
            for i in held..count {
                for turn in 0..random.below(3) {
                    let mut p = [0.0; 3];
                    p[..d].copy_from_slice(&points[i]);
                    builder.constraint(format!("nail {i} {turn}"), Nail::new(ids[i], p));
                    flexibility.resize(flexibility.len() + d, 0.0);
                }
            }
            if random.below(3) == 0 {
                let terms: Vec<(ParticleId, f64)> = (0..count).map(|i| (ids[i], random.within(0.5, 2.0))).collect();
                let point = [0, 1, 2].map(|k| {
                    let sum: f64 = terms.iter().zip(&points).map(|((_, w), x)| w * x.get(k).unwrap_or(&0.0)).sum();
                    sum.into()
                });
                builder.constraint("relation", Relation { terms, point });
                flexibility.resize(flexibility.len() + d, 0.0);
            }
            for &id in &ids[held..] {
                super::load(&mut builder, id, random.triple());
            }
            let (system, state) = builder.build().unwrap();
            let terms = evaluate(&system, &state);
            let columns = count * d;
            let mut dense = terms.jacobian.to_dense();
            let is_held = |column: usize| column / d < held;
            let mut scaled = Scaled { rows: Vec::new(), size: Vec::new(), flexibility };
            for (row, numbers) in dense.chunks_exact_mut(columns).enumerate() {
                let whole = dot(numbers, numbers);
                (0..columns).filter(|&c| is_held(c)).for_each(|c| numbers[c] = 0.0);
                let size =
                    if scaled.flexibility[row] > 0.0 { (0.5 * whole).sqrt() } else { dot(numbers, numbers).sqrt() };
                scaled.rows.push(numbers.iter().map(|x| x / size).collect());
                scaled.size.push(size);
            }
            // F = Jᵀλ is that of the motion, to the accuracy of Q̂ under masses of 1e4:1.
            let force = multiply_transposed(&dense, columns, &terms.multipliers);
            let scale = largest(&terms.multipliers).max(1.0) * largest(&scaled.size);
            for (c, force) in force.iter().enumerate().filter(|&(c, _)| !is_held(c)) {
                let (seen, w) = (terms.constraint_forces[c], terms.inverse_masses[c / d]);
                assert!(w > 0.0 && (force - seen).abs() < 1e-9 * scale, "seed {seed}: {force} {seen}");
            }
            let (expected, is_unique) = reference(&scaled, &terms.multipliers);
            let found: Vec<f64> =
                terms.multipliers.iter().zip(&scaled.size).map(|(lambda, size)| lambda * size).collect();
            let most = largest(&expected);
            for (row, (found, expected)) in found.iter().zip(&expected).enumerate() {
                let name = &system.row_names()[row];
                assert!((found - expected).abs() < 1e-8 * most, "seed {seed}, {name}: {found}, not {expected}");
            }
            assert_eq!(terms.multiplier_is_unique, is_unique, "seed {seed}");
            let shares =
                |rod: bool| (0..is_unique.len()).any(|i| !is_unique[i] && rod == (scaled.flexibility[i] > 0.0));
            redundant += usize::from(shares(true) || shares(false));
            mixed += usize::from(shares(true) && shares(false));
        }
        assert!(redundant > 60 && mixed > 20, "{redundant} of the frameworks are redundant, {mixed} with nails");
    }
}

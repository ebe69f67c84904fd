//! Random redundant frameworks in the plane and in space, many with mechanisms, against a dense reference.

use crate::systems::dense::{dot, eigen, largest, multiply_transposed, norm};
use crate::systems::fuzz;
use crate::systems::random::{Random, dimension};
use qhat::{Distance, DistanceForm, Nail, Particle, ParticleId, PointForce, Relation, System, evaluate};

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
        let weighed = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).zip(weight).map(|((a, b), w)| a * b * w).sum() };
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
                let particle = Particle::at(i.to_string(), &x[..d]).with_mass(libm::exp10(random.within(-2.0, 2.0)));
                builder.particle(if i < held { particle.fixed() } else { particle })
            })
            .collect();
        let mut flexibility = Vec::new();
        for i in 0..count {
            for j in 0..i {
                if j < held && i < held || random.within(0.0, 1.0) > 0.75 {
                    continue;
                }
                let apart: Vec<f64> = (0..d).map(|k| points[i][k] - points[j][k]).collect();
                let length = norm(&apart);
                let form = if random.below(2) == 0 { DistanceForm::Length } else { DistanceForm::Squared };
                let stiffness = libm::exp10(random.within(-1.0, 1.0));
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
            builder.force(PointForce { particle: id, force: random.triple() });
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
            let size = if scaled.flexibility[row] > 0.0 { (0.5 * whole).sqrt() } else { dot(numbers, numbers).sqrt() };
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
        let found: Vec<f64> = terms.multipliers.iter().zip(&scaled.size).map(|(lambda, size)| lambda * size).collect();
        let most = largest(&expected);
        for (row, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let name = &system.row_names()[row];
            assert!((found - expected).abs() < 1e-8 * most, "seed {seed}, {name}: {found}, not {expected}");
        }
        assert_eq!(terms.multiplier_is_unique, is_unique, "seed {seed}");
        let shares = |rod: bool| (0..is_unique.len()).any(|i| !is_unique[i] && rod == (scaled.flexibility[i] > 0.0));
        redundant += usize::from(shares(true) || shares(false));
        mixed += usize::from(shares(true) && shares(false));
    }
    assert!(redundant > 60 && mixed > 20, "{redundant} of the frameworks are redundant, {mixed} with nails");
}

//! Rows that follow from others: forces of long structures at rest, rows that say the same in different forms, and
//! positions where the rank drops.

use crate::systems;
use crate::systems::dense::largest;
use qhat::{
    Dimension, Distance, DistanceForm, HarmonicForce, Integrator, Nail, Particle, ParticleId, PointForce, Settings,
    Simulation, State, System, evaluate,
};

fn under(integrator: Integrator, h: f64, tolerance: f64) -> Settings {
    Settings { integrator, h, tolerance, ..Settings::default() }
}

/// A cantilever of square bays with both diagonals, its left end fixed: one redundant rod a bay. `mass` is that of
/// every third joint; the others weigh 1 kg.
fn cantilever(bays: usize, mass: f64) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let joints: Vec<[ParticleId; 2]> = (0..=bays)
        .map(|i| {
            [0, 1].map(|z| {
                let m = if (2 * i + z) % 3 == 0 { mass } else { 1.0 };
                let joint = Particle::at(format!("{i} {z}"), [i as f64, z as f64]).with_mass(m);
                builder.particle(if i == 0 { joint.fixed() } else { joint })
            })
        })
        .collect();
    let diagonal = 2.0_f64.sqrt();
    for (i, bay) in joints.windows(2).enumerate() {
        let [[a, b], [c, d]] = [bay[0], bay[1]];
        for (name, ends, length) in [
            ("low", (a, c), 1.0),
            ("high", (b, d), 1.0),
            ("post", (c, d), 1.0),
            ("up", (a, d), diagonal),
            ("down", (b, c), diagonal),
        ] {
            builder.constraint(format!("{name}{i}"), Distance::new(ends.0, ends.1, length));
        }
    }
    builder.force(systems::gravity());
    builder.build().unwrap()
}

/// At rest, constraint forces equal weights: Q + Q̂ vanishes to a few roundings of the largest tension, at any length
/// and for masses over six decades.
#[test]
fn constraint_forces_of_a_cantilever_equal_its_weights() {
    for (bays, mass) in [(10, 1.0), (100, 1.0), (400, 1.0), (12, 1e-5), (40, 1e6)] {
        let (system, state) = cantilever(bays, mass);
        let terms = evaluate(&system, &state);
        assert_eq!(terms.rank, Some(4 * bays), "{bays} bays");
        let free = 4..terms.positions.len();
        let off = free.map(|k| (terms.applied_forces[k] + terms.constraint_forces[k]).abs()).fold(0.0, f64::max);
        let most = largest(&terms.multipliers);
        assert!(off <= 1e-14 * most, "{bays} bays, {mass} kg: off by {off:e} N of {most:e} N");
    }
}

/// A rod held as a length and as a square, with the longest frame that one substep takes.
#[test]
fn a_rod_in_both_forms_moves_as_one_rod() {
    let pendulum = |forms: &[DistanceForm]| {
        let mut builder = System::builder(Dimension::Two);
        let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
        let bob = builder.particle(Particle::at("bob", [1.0, 0.0]));
        for (k, &form) in forms.iter().enumerate() {
            builder.constraint(format!("rod{k}"), Distance { form, ..Distance::new(pivot, bob, 1.0) });
        }
        builder.force(systems::gravity());
        builder.build().unwrap()
    };
    for integrator in Integrator::ALL.into_iter().filter(|integrator| integrator.projects()) {
        for (h, frames) in [(0.2, 1), (0.01, 200)] {
            let run = |forms: &[DistanceForm]| {
                let (system, state) = pendulum(forms);
                let mut simulation = Simulation::new(system, state, under(integrator, h, 1e-6)).unwrap();
                (0..frames)
                    .for_each(|_| drop(simulation.step().unwrap_or_else(|error| panic!("{integrator}: {error}"))));
                simulation.state().positions().to_vec()
            };
            let (both, one) = (run(&[DistanceForm::Length, DistanceForm::Squared]), run(&[DistanceForm::Length]));
            let off = both.iter().zip(&one).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // The stages of one long substep leave C = 0, where the two rows differ. With `dopri5` the runs end 1.1e-8
            // m apart, a hundredth of the tolerance over an extent of 1 m; with any other method at most 1e-12 m.
            let bound = if integrator == Integrator::Dopri5 { 1e-7 } else { 1e-9 };
            assert!(off <= bound, "{integrator}, h = {h}: {off:e} m");
        }
    }
}

/// A nail and a rod that repeat each other, at rest under bdf2: roundoff must not gather along the null space.
#[test]
fn redundant_rows_at_rest_stay_at_rest() {
    for integrator in [Integrator::Bdf2, Integrator::Implicit] {
        let mut builder = System::builder(Dimension::Three);
        let (from, to) = ([0.88, -1.89, -1.29], [0.3, -0.09, 0.54]);
        let fixed = builder.particle(Particle::at("fixed", from).fixed());
        let held = builder.particle(Particle::at("held", to));
        let length = from.iter().zip(to).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
        builder.constraint("rod", Distance::new(held, fixed, length));
        builder.constraint("nail", Nail::new(held, to));
        let (system, state) = builder.build().unwrap();
        let mut simulation = Simulation::new(system, state, under(integrator, 0.001, 1e-6)).unwrap();
        for step in 0..3000 {
            let report = simulation.step().unwrap_or_else(|error| panic!("{integrator}, step {step}: {error}"));
            // The constraint tolerance is relative to the length of the rod, 2.6 m.
            assert!(report.max_residual <= 1e-10 * length, "{integrator}, step {step}");
        }
    }
}

/// Cranks joined by couplers, every bar 1 m long: all lie in one line at the angles 0 and π. Joints weigh 1 and 2 kg in
/// turn.
fn cranks(loops: usize, angle: f64, rate: f64) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let mut last = None;
    for k in 0..=loops {
        let pivot = builder.particle(Particle::at(format!("a{k}"), [k as f64, 0.0]).fixed());
        let joint = Particle::at(format!("b{k}"), [k as f64 + cosine, sine]);
        let joint = joint.with_velocity([-rate * sine, rate * cosine]).with_mass(1.0 + (k % 2) as f64);
        let joint = builder.particle(joint);
        builder.constraint(format!("crank{k}"), Distance::new(pivot, joint, 1.0));
        if let Some(last) = last.replace(joint) {
            builder.constraint(format!("coupler{k}"), Distance::new(last, joint, 1.0));
        }
    }
    builder.force(systems::gravity());
    builder.build().unwrap()
}

/// Every joint of the cranks moves as a pendulum of 1 m, through the flat position: the same at every tolerance, with
/// its energy, on one branch.
#[test]
fn cranks_pass_through_flat_at_any_tolerance() {
    let right = {
        let (system, state) = cranks(0, 1.0, 2.0);
        let mut simulation = Simulation::new(system, state, under(Integrator::Dop853, 0.05, 1e-12)).unwrap();
        (0..80).for_each(|_| drop(simulation.step().unwrap()));
        simulation.state().positions()[2..].to_vec()
    };
    for loops in [1, 4] {
        for tolerance in [1e-3, 1e-5, 1e-7, 1e-9, 1e-10, 1e-11, 1e-12] {
            let (system, state) = cranks(loops, 1.0, 2.0);
            let mut simulation = Simulation::new(system, state, under(Integrator::Dop853, 0.05, tolerance)).unwrap();
            for frame in 0..80 {
                simulation
                    .step()
                    .unwrap_or_else(|error| panic!("{loops} loops, {tolerance:e}, frame {frame}: {error}"));
            }
            let what = format!("{loops} loops at a tolerance of {tolerance:e}");
            let energy = simulation.energy_error_max();
            // At 1e-9 and below the tolerance bounds the energy; above, the frame bounds the substep before it does.
            let most = if tolerance <= 1e-9 { 1e-9 } else { 1e-7 };
            assert!(energy <= most, "{what}: energy {energy:e}");
            for k in 0..=loops {
                let x = &simulation.state().positions()[4 * k + 2..][..2];
                let off = (x[0] - k as f64 - right[0]).abs().max((x[1] - right[1]).abs());
                assert!(off <= if tolerance <= 1e-9 { 1e-7 } else { 1e-5 }, "{what}: joint {k} off by {off:e} m");
            }
        }
    }
}

/// The same under `radau5`, which alone lost 4 % of the energy of one loop at a tolerance of 1e-8, and half of it at
/// 1e-10.
#[test]
fn radau5_passes_through_flat_at_any_tolerance() {
    for loops in [1, 4] {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let (system, state) = cranks(loops, 1.0, 2.0);
            let mut simulation = Simulation::new(system, state, under(Integrator::Radau5, 0.05, tolerance)).unwrap();
            for frame in 0..80 {
                simulation
                    .step()
                    .unwrap_or_else(|error| panic!("{loops} loops, {tolerance:e}, frame {frame}: {error}"));
            }
            let energy = simulation.energy_error_max();
            // Each of some thousand substeps leaves C off by up to 5e-11, over a sine of 0.2 or more; seen is 1.1e-8.
            let most = 0.1 * tolerance + 3e-8;
            assert!(energy <= most, "{loops} loops at a tolerance of {tolerance:e}: energy {energy:e}");
        }
    }
}

/// Four cranks at unequal distances with a load on one joint, which passes the flat position. With stages of its own
/// `dopri5` lost up to 14 % of the energy there at a tolerance of 1e-8 (first load), where 1e-6 was well.
#[test]
fn dopri5_passes_through_flat_at_any_tolerance() {
    let (pivots, length) = ([0.0, 0.993_368_25, 2.191_626_84, 3.237_905_35], 0.708_456_986);
    let sine = 0.068_459_8_f64;
    let cosine = (1.0 - sine * sine).sqrt();
    for (loaded, load) in [(3, [-15.0, 0.0, 0.0]), (2, [5.0, -24.0, 0.0]), (1, [26.0, -7.0, 0.0])] {
        for tolerance in [1e-6, 1e-7, 1e-8, 1e-9, 1e-10] {
            let mut builder = System::builder(Dimension::Two);
            let mut joints: Vec<ParticleId> = Vec::new();
            for (k, x) in pivots.into_iter().enumerate() {
                let pivot = builder.particle(Particle::at(format!("a{k}"), [x, 0.0]).fixed());
                let joint = Particle::at(format!("b{k}"), [x + length * cosine, length * sine]);
                let joint = joint.with_velocity([0.309 * sine, -0.309 * cosine]).with_mass([2.56, 1.14, 0.52, 2.17][k]);
                joints.push(builder.particle(joint));
                builder.constraint(format!("crank{k}"), Distance::new(pivot, joints[k], length));
                if k > 0 {
                    let coupler = Distance::new(joints[k - 1], joints[k], x - pivots[k - 1]);
                    builder.constraint(format!("coupler{k}"), coupler);
                }
            }
            builder.force(systems::gravity());
            builder.force(PointForce { particle: joints[loaded], force: load });
            let (system, state) = builder.build().unwrap();
            let settings = under(Integrator::Dopri5, 0.0785, tolerance);
            let mut simulation = Simulation::new(system, state, settings).unwrap();
            (0..4).for_each(|_| drop(simulation.step().unwrap_or_else(|error| panic!("{tolerance:e}: {error}"))));
            // Up to a hundred substeps, each with an error of the tolerance at most.
            let energy = simulation.energy_error_max();
            assert!(energy <= 100.0 * tolerance, "{load:?} at {tolerance:e}: energy {energy:e}");
        }
    }
}

/// Three cranks pass their flat position, where Ċ hardly sees the velocity across the couplers. Methods that solve at
/// the end of a step stay on their branch: the couplers keep the joints as far apart as the pivots, and parallel.
#[test]
fn implicit_steps_through_a_flat_position_keep_the_branch() {
    let (pivots, length) = ([0.0, 1.040_045_660_143_352_8, 1.870_406_390_836_729_2], 1.034_896_421_701_942_3_f64);
    let sine = 0.125_455_981_529_165_76 / length;
    let cosine = (1.0 - sine * sine).sqrt();
    let mut builder = System::builder(Dimension::Two);
    let mut joints: Vec<ParticleId> = Vec::new();
    for (k, x) in pivots.into_iter().enumerate() {
        let pivot = builder.particle(Particle::at(format!("a{k}"), [x, 0.0]).fixed());
        let joint = Particle::at(format!("b{k}"), [x + length * cosine, length * sine]);
        let joint = joint.with_velocity([1.958 * sine, -1.958 * cosine]).with_mass([0.0095, 0.0123, 6.77][k]);
        joints.push(builder.particle(joint));
        builder.constraint(format!("crank{k}"), Distance::new(pivot, joints[k], length));
    }
    for k in 0..2 {
        let coupler = Distance::new(joints[k], joints[k + 1], pivots[k + 1] - pivots[k]);
        builder.constraint(format!("coupler{k}"), coupler);
    }
    let load = HarmonicForce {
        particle: joints[1],
        amplitude: [-0.0992, 0.00823, 0.0],
        angular_frequency: 17.965,
        phase: 3.2402,
    };
    builder.force(load);
    let (system, state) = builder.build().unwrap();
    for integrator in [Integrator::Bdf2, Integrator::Implicit] {
        for steps in [10, 20, 40, 80] {
            let settings = under(integrator, 0.128_445_769_748_427_75 / f64::from(steps), 1e-8);
            let mut simulation = Simulation::new(system.clone(), state.clone(), settings).unwrap();
            for step in 0..steps {
                simulation.step().unwrap_or_else(|error| panic!("{integrator}, {steps} steps: {error}"));
                let q = simulation.state().positions();
                for (k, pair) in pivots.windows(2).enumerate() {
                    let [joint, next] = [k, k + 1].map(|k| &q[4 * k + 2..4 * k + 4]);
                    let [x, y] = [next[0] - joint[0] - (pair[1] - pair[0]), next[1] - joint[1]];
                    let off = (x * x + y * y).sqrt();
                    // Near flat, constraints that hold to 1e-10 leave the joints 1e-10 over the sine of a crank's
                    // angle, which is 1e-4 in some step; the other branch is off by 2e-2 m.
                    assert!(off <= 1e-6, "{integrator}, step {step} of {steps}, coupler {k}: off by {off:e} m");
                }
            }
        }
    }
}

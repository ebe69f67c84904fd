//! Random heaps of rods, ropes and struts dropped on the ground, a ball and a box: properties that hold for every
//! motion.

use crate::systems::random::Random;
use crate::systems::{self, FRAME, G, gravity, settings};
use qhat::{
    Dimension, Distance, Integrator, Limits, Obstacle, Particle, Settings, State, Surface, System, SystemBuilder,
    Workspace, step,
};

/// The obstacles: ground, ball and box.
fn surfaces() -> [Surface; 3] {
    [
        Surface::HalfSpace { normal: [0.0, 1.0, 0.0], offset: 0.0 },
        Surface::Ball { center: [-0.5, -0.5, 0.0], radius: 1.0, inside: false },
        Surface::Box { center: [1.0, 0.0, 0.0], half: [0.5, 0.4, 0.5] },
    ]
}

fn heap(random: &mut Random) -> SystemBuilder {
    let dimension = if random.below(3) == 0 { Dimension::Three } else { Dimension::Two };
    let d = dimension.number();
    let mut builder = System::builder(dimension);
    let count = 2 + random.below(6);
    let mut places: Vec<Vec<f64>> = Vec::new();
    while places.len() < count {
        let mut place = random.numbers(d, -1.5, 1.5);
        place[1] += 2.1;
        if places.iter().all(|other| between(other, &place) > 0.2) {
            places.push(place);
        }
    }
    let ids: Vec<_> = places
        .iter()
        .enumerate()
        .map(|(i, place)| {
            let particle = Particle::at(format!("p{i}"), place.clone()).with_mass(random.within(0.2, 3.0));
            builder.particle(particle.with_velocity(random.numbers(d, -1.0, 1.0)))
        })
        .collect();
    let restitution = [0.0, 0.5, 0.9][random.below(3)];
    let friction = [0.0, 0.3, 0.7][random.below(3)];
    for i in 1..count {
        let other = random.below(i);
        let (a, b, length) = (ids[other], ids[i], between(&places[other], &places[i]));
        let name = format!("link{i}");
        match random.below(4) {
            0 => builder.with_constraint(name, Distance::new(a, b, length)),
            1 => builder.with_constraint(name, Limits { restitution, ..Limits::rope(a, b, 1.05 * length) }),
            2 => builder
                .with_constraint(name, Limits { restitution, ..Limits::between(a, b, 0.8 * length, 1.1 * length) }),
            _ => &mut builder,
        };
    }
    for (i, &id) in ids.iter().enumerate() {
        for (k, surface) in surfaces().into_iter().enumerate() {
            let obstacle = Obstacle { restitution, friction, ..Obstacle::new(id, surface) };
            builder.constraint(format!("surface{k}({i})"), obstacle);
        }
    }
    builder.force(gravity());
    builder
}

fn between(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The least signed distance of any particle to the ground, the ball or the box [m].
fn lowest(state: &State, d: usize) -> f64 {
    let mut lowest = f64::INFINITY;
    for x in state.positions().chunks(d) {
        let x = [x[0], x[1], x.get(2).copied().unwrap_or(0.0)];
        let ball = between(&x, &[-0.5, -0.5, 0.0]) - 1.0;
        let mut beyond = [(x[0] - 1.0).abs() - 0.5, x[1].abs() - 0.4, x[2].abs() - 0.5];
        if d == 2 {
            beyond[2] = f64::NEG_INFINITY;
        }
        // The edges of a box are round: a thousandth of its smallest half.
        let radius = 1e-3 * 0.4;
        let off = beyond.iter().map(|y| (y + radius).max(0.0)).map(|y| y * y).sum::<f64>().sqrt();
        let depth = off + beyond.iter().copied().fold(f64::NEG_INFINITY, f64::max).min(-radius);
        lowest = lowest.min(x[1]).min(ball).min(depth);
    }
    lowest
}

fn total(report: &qhat::StepReport) -> f64 {
    report.energy.kinetic + report.energy.potential
}

/// Runs the heap of this seed for two seconds and returns the first rule that it breaks: T + V never rises, no particle
/// sinks in, and a fresh workspace at every frame gives the same bits as a workspace that is kept.
fn run(seed: u64) -> Result<(), String> {
    let (system, mut state) = heap(&mut Random::new(seed)).build().unwrap();
    let d = system.dimension();
    let settings = Settings { tolerance: 1e-9, ..settings(Integrator::Dop853, FRAME) };
    let mut workspace = Workspace::new(&system);
    qhat::check_start(&system, &state, &settings).unwrap();
    qhat::project(&system, &mut state, &settings, &mut workspace).unwrap();
    // The energy that may turn into motion: a fall of 4 m.
    let scale = 4.0 * G * system.masses().iter().sum::<f64>();
    let mut restarted = state.clone();
    let mut energy = f64::INFINITY;
    for frame in 0..120 {
        let must = |holds: bool, words: &dyn Fn() -> String| {
            if holds { Ok(()) } else { Err(format!("seed {seed}, frame {frame}: {}", words())) }
        };
        let report = step(&system, &mut state, &settings, &mut workspace);
        let report = report.map_err(|error| format!("seed {seed}, frame {frame}: {error}"))?;
        let now = total(&report);
        must(now - energy < 1e-9 * scale, &|| format!("the energy rose by {:e}", (now - energy) / scale))?;
        energy = now;
        let depth = lowest(&state, d);
        must(depth > -1e-8, &|| format!("{depth:e} m"))?;
        must(report.max_relative_length_error < 1e-9, &|| format!("lengths: {:e}", report.max_relative_length_error))?;
        let again = step(&system, &mut restarted, &settings, &mut Workspace::new(&system)).unwrap();
        must(again.events == report.events, &|| "other events after a restart".into())?;
        must(restarted == state, &|| "another state after a restart".into())?;
    }
    Ok(())
}

/// Sixty random heaps, and the heaps that once gained energy at an edge, slipped to and fro without end, or had no
/// solution of friction. `make fuzz` runs more heaps: 2 of 2400 are known to end in an error.
#[test]
fn long_heaps_never_gain_energy_nor_sink_and_repeat_to_the_bit() {
    let once_wrong = [87, 212, 281, 460, 492, 607, 610, 612, 682, 932, 1006, 1165, 1270, 1280, 2158];
    let more = 60 * systems::fuzz();
    let seeds = (0..more).chain(once_wrong.into_iter().filter(|seed| *seed >= more));
    let failures: Vec<String> = seeds.filter_map(|seed| run(seed).err()).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

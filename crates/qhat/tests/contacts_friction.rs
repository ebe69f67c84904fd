//! Friction that slides, in space and in what is read from it, against closed forms.

use crate::systems::random::Random;
use crate::systems::settings;
use qhat::{
    Dimension, Distance, EventKind, Integrator, Obstacle, Particle, Settings, Simulation, Surface, System,
    SystemBuilder,
};

/// A puck on a plane at the angle `slope` to the ground, and its start.
#[derive(Debug)]
struct Slide {
    slope: f64,
    /// The angle about the vertical that the plane is turned by.
    heading: f64,
    friction: f64,
    mass: f64,
    speed: f64,
    /// The angle from straight down the slope to the first velocity.
    angle: f64,
}

/// Where and when a puck comes to rest: the way down the slope and across it [m], the time [s].
#[derive(Debug)]
struct Rest {
    down: f64,
    across: f64,
    time: f64,
}

const GRAVITY: f64 = 10.0;

impl Slide {
    /// With s the speed, θ the angle between slip and straight down, a = g sin(slope) and k a = μ g cos(slope):
    ///
    /// ```text
    /// s' = a cos θ − k a,   s θ' = −a sin θ      →   s = c u^k/sin θ,   u = tan(θ/2)
    /// time    ∫ dt         = c/(2a)  [u^(k−1)/(k−1) + u^(k+1)/(k+1)]
    /// down    ∫ s cos θ dt = c²/(4a) [u^(2k−2)/(2k−2) − u^(2k+2)/(2k+2)]
    /// across  ∫ s sin θ dt = c²/(2a) [u^(2k−1)/(2k−1) + u^(2k+1)/(2k+1)]
    /// ```
    ///
    /// from 0, where the puck stops if k > 1, to the first u.
    fn rest(&self) -> Rest {
        let a = GRAVITY * libm::sin(self.slope);
        let k = self.friction / libm::tan(self.slope);
        let u = libm::tan(0.5 * self.angle.abs());
        let c = self.speed * libm::sin(self.angle.abs()) / libm::pow(u, k);
        let term = |power: f64| libm::pow(u, power) / power;
        Rest {
            down: c * c / (4.0 * a) * (term(2.0 * k - 2.0) - term(2.0 * k + 2.0)),
            across: self.angle.signum() * c * c / (2.0 * a) * (term(2.0 * k - 1.0) + term(2.0 * k + 1.0)),
            time: c / (2.0 * a) * (term(k - 1.0) + term(k + 1.0)),
        }
    }

    /// Unit vectors down the slope, across it, and along its normal.
    fn axes(&self) -> [[f64; 3]; 3] {
        let (s, c) = (libm::sin(self.slope), libm::cos(self.slope));
        let (x, z) = (libm::cos(self.heading), libm::sin(self.heading));
        [[c * x, -s, c * z], [-z, 0.0, x], [s * x, c, s * z]]
    }

    fn simulation(&self, settings: Settings) -> Simulation {
        let [down, across, normal] = self.axes();
        let (x, y) = (self.speed * libm::cos(self.angle), self.speed * libm::sin(self.angle));
        let velocity: Vec<f64> = (0..3).map(|k| x * down[k] + y * across[k]).collect();
        let mut builder = System::builder(Dimension::Three);
        let puck = Particle::at("puck", [0.0; 3]).with_mass(self.mass).with_velocity(velocity);
        let puck = builder.particle(puck);
        let slope = Surface::HalfSpace { normal, offset: 0.0 };
        builder
            .with_constraint("slope", Obstacle::new(puck, slope).with_friction(self.friction))
            .force(qhat::Gravity { acceleration: [0.0, -GRAVITY, 0.0] });
        start(builder, settings)
    }

    /// How far from its place a puck comes to rest, relative to the way, and by how much too late [s].
    fn errors(&self, settings: Settings) -> (f64, f64) {
        let Rest { down, across, time } = self.rest();
        let mut simulation = self.simulation(settings);
        let frames = (1.1 * time / settings.h).ceil() as usize;
        let mut stuck = Vec::new();
        for frame in 0..frames {
            let report = simulation.step().unwrap_or_else(|error| panic!("{self:?}, frame {frame}: {error}"));
            stuck.extend(report.events.iter().filter(|event| event.kind == EventKind::Stuck).map(|event| event.time));
        }
        assert_eq!(stuck.len(), 1, "{self:?}: {stuck:?}");
        let [along, beside, _] = self.axes();
        let q = simulation.state().positions();
        let way = |axis: [f64; 3]| (0..3).map(|k| axis[k] * q[k]).sum::<f64>();
        let (x, y) = (way(along) - down, way(beside) - across);
        ((x * x + y * y).sqrt() / (down * down + across * across).sqrt(), stuck[0] - time)
    }
}

fn start(builder: SystemBuilder, settings: Settings) -> Simulation {
    let (system, state) = builder.build().unwrap();
    Simulation::new(system, state, settings).unwrap()
}

/// The puck of 0.1 m/s that is nudged across a slope of 30°: 1.0638 mm down, 0.9938 mm across, at rest at 0.0516 s.
/// Within a frame it comes to rest; the error falls with the tolerance.
#[test]
fn a_slow_slip_that_turns_is_as_accurate_as_the_tolerance() {
    let slide = Slide {
        slope: std::f64::consts::FRAC_PI_6,
        heading: 0.0,
        friction: 0.7,
        mass: 1.0,
        speed: 0.1,
        angle: std::f64::consts::FRAC_PI_2,
    };
    let Rest { down, across, time } = slide.rest();
    assert!((down - 1.0638e-3).abs() < 1e-7 && (across - 9.938e-4).abs() < 1e-7 && (time - 0.0516).abs() < 1e-4);
    // The extent of a single particle is 1 m, 700 times the way: so the error is some 10 tolerances of the way.
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        for h in [0.1, 0.01, 0.001] {
            let (off, late) = slide.errors(Settings { tolerance, ..settings(Integrator::Dop853, h) });
            assert!(
                off < 10.0 * tolerance && late.abs() < 10.0 * tolerance * time,
                "{tolerance:e}, {h} s: {off:e}, {late:e} s"
            );
        }
    }
}

/// 200 pucks on slopes that hold them in the end, with ways of 50 µm to metres.
#[test]
fn pucks_on_random_slopes_stop_where_they_should() {
    for seed in 0..200 {
        let mut random = Random::new(seed);
        let slope = random.within(0.1, 0.9);
        let slide = Slide {
            slope,
            heading: random.within(-3.1, 3.1),
            friction: libm::tan(slope) * random.within(1.1, 4.0),
            mass: libm::pow(10.0, random.within(-3.0, 3.0)),
            speed: libm::pow(10.0, random.within(-2.0, 0.5)),
            angle: random.within(-2.8, 2.8),
        };
        let (off, late) = slide.errors(Settings { tolerance: 1e-10, ..settings(Integrator::Dop853, 0.01) });
        assert!(off < 1e-6 && late.abs() < 1e-7 * slide.rest().time, "seed {seed}: {off:e}, {late:e} s, {slide:?}");
    }
}

/// The most that forces which should add up may miss, relative to the largest of them.
const ROUNDOFF: f64 = 1e-12;

/// How many contacts of a motion were seen to slide and to stick.
#[derive(Debug, Default)]
struct Seen {
    sliding: usize,
    sticking: usize,
}

/// Q + Q̂ = m q̈, Q̂ = Jᵀ λ and Coulomb's law, as read from the terms of a state. The first rows are those of
/// `obstacles` obstacles, each a normal and its tangents.
fn check_terms(simulation: &mut Simulation, obstacles: usize, friction: f64, seen: &mut Seen) {
    let terms = simulation.terms();
    let d = simulation.system().dimension();
    let size = |numbers: &[f64]| numbers.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let scale = size(&terms.applied_forces).max(size(&terms.constraint_forces)).max(size(&terms.multipliers));
    for (k, acceleration) in terms.accelerations.iter().enumerate() {
        let w = terms.inverse_masses[k / d];
        let missing = w * (terms.applied_forces[k] + terms.constraint_forces[k]) - acceleration;
        assert!(missing.abs() <= ROUNDOFF * scale * w, "{k}: {missing:e} m/s²");
    }
    let J = terms.jacobian.to_dense();
    let columns = terms.positions.len();
    for (k, held) in terms.constraint_forces.iter().enumerate() {
        let sum: f64 = terms.multipliers.iter().enumerate().map(|(row, lambda)| lambda * J[row * columns + k]).sum();
        assert!((sum - held).abs() <= ROUNDOFF * scale, "{k}: Jᵀλ = {sum}, Q̂ = {held}");
    }
    for normal in (0..obstacles).map(|k| k * d).filter(|&normal| !terms.is_open[normal]) {
        let (force, tangents) = (terms.multipliers[normal], normal + 1..normal + d);
        let along = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (held, slip) = (&terms.multipliers[tangents.clone()], &terms.residual_rate[tangents.clone()]);
        let limit = friction * force;
        if terms.is_open[tangents.start] {
            seen.sliding += 1;
            assert!((along(held, held).sqrt() - limit).abs() <= ROUNDOFF * scale, "{held:?}, limit {limit}");
            // To within 0.03 rad, the angle up to which a contact keeps a direction at an event.
            let lost = along(held, slip) + 0.999 * limit * along(slip, slip).sqrt();
            assert!(lost <= 1e-9 * scale, "{held:?} against {slip:?}");
        } else {
            seen.sticking += 1;
            // Contacts stick until friction is past its limit by a billionth of the largest force.
            assert!(along(held, held).sqrt() <= limit + 1e-8 * scale, "{held:?}, limit {limit}");
        }
    }
}

/// A sled of 2 kg on a floor with μ = 0.5: 10 N against its way, in the multipliers and in the constraint forces.
#[test]
fn friction_of_a_slide_is_in_the_terms() {
    for (v, friction) in [(5.0, -10.0), (-5.0, 10.0)] {
        let mut builder = System::builder(Dimension::Two);
        let sled = builder.particle(Particle::at("sled", [0.0, 0.0]).with_mass(2.0).with_velocity([v, 0.0]));
        let floor = Surface::half_space([0.0, 1.0], 0.0);
        builder
            .with_constraint("floor", Obstacle::new(sled, floor).with_friction(0.5))
            .force(qhat::Gravity { acceleration: [0.0, -GRAVITY, 0.0] });
        let mut simulation = start(builder, settings(Integrator::Auto, 0.01));
        simulation.step().unwrap();
        let terms = simulation.terms();
        // The tangent of the floor runs to −x.
        let is = |found: &[f64], expected: [f64; 2]| (0..2).all(|k| (found[k] - expected[k]).abs() < 1e-13);
        assert!(is(&terms.multipliers, [20.0, -friction]), "{:?}", terms.multipliers);
        assert!(is(&terms.constraint_forces, [friction, 20.0]), "{:?}", terms.constraint_forces);
        // After a second the sled stands, and nothing pushes it.
        (0..150).for_each(|_| drop(simulation.step().unwrap()));
        assert!(is(&simulation.terms().constraint_forces, [0.0, 20.0]));
    }
}

/// Random frames of rods thrown over the ground, which slide, tumble, roll and come to rest.
#[test]
fn forces_that_are_read_add_up_while_contacts_slide_stick_and_roll() {
    let mut seen = Seen::default();
    for seed in 0..12 {
        let mut random = Random::new(seed);
        let dimension = if seed % 2 == 0 { Dimension::Two } else { Dimension::Three };
        let (d, count, friction) = (dimension.number(), 4, random.within(0.2, 0.9));
        let mut builder = System::builder(dimension);
        let places: Vec<Vec<f64>> = (0..count)
            .map(|_| {
                let mut place = random.numbers(d, -0.7, 0.7);
                place[1] += 0.9;
                place
            })
            .collect();
        let speed = random.numbers(d, -3.0, 3.0);
        let ids: Vec<_> = places
            .iter()
            .enumerate()
            .map(|(i, place)| {
                let particle = Particle::at(format!("p{i}"), place.clone()).with_mass(random.within(0.1, 5.0));
                builder.particle(particle.with_velocity(speed.clone()))
            })
            .collect();
        for &id in &ids {
            let ground = Surface::half_space([0.0, 1.0, 0.0], 0.0);
            builder.constraint(format!("ground{}", id.index()), Obstacle::new(id, ground).with_friction(friction));
        }
        // In the plane four particles have five rods, a rigid body; in space six.
        let pairs = [(0, 1), (1, 2), (0, 2), (2, 3), (1, 3), (0, 3)];
        for &(a, b) in pairs.iter().take(3 * (d - 1)).take(if d == 2 { 5 } else { 6 }) {
            let length = places[a].iter().zip(&places[b]).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt();
            builder.constraint(format!("rod{a}{b}"), Distance::new(ids[a], ids[b], length));
        }
        builder.force(qhat::Gravity { acceleration: [0.0, -GRAVITY, 0.0] });
        let mut simulation = start(builder, Settings { tolerance: 1e-8, ..settings(Integrator::Dop853, 0.02) });
        for frame in 0..80 {
            simulation.step().unwrap_or_else(|error| panic!("seed {seed}, frame {frame}: {error}"));
            check_terms(&mut simulation, count, friction, &mut seen);
        }
    }
    assert!(seen.sliding > 100 && seen.sticking > 100, "{seen:?}");
}

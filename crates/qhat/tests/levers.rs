//! Joints that rods hold only to second order move as the same joints in a rigid cluster do.

use crate::systems::G;
use qhat::{
    Dimension, Distance, Driven, Feedback, Formulation, Gravity, Integrator, Limits, Obstacle, Particle, ParticleId,
    Relation, RigidCluster, Settings, Simulation, State, StepError, Surface, System, SystemBuilder, Workspace,
    evaluate, rigid_cluster, step,
};

type Point = [f64; 3];

/// Joints of which groups are rigid: in a line, or in space in a plane.
#[derive(Clone)]
struct Case {
    name: &'static str,
    dimension: usize,
    joints: Vec<Point>,
    fixed: Vec<usize>,
    groups: Vec<Vec<usize>>,
    /// Rods beside those of the groups.
    links: Vec<[usize; 2]>,
    /// The velocity of each joint [m/s]: consistent with all rods.
    velocity: fn(Point) -> Point,
}

fn at_rest(_: Point) -> Point {
    [0.0; 3]
}

/// A turn at 1 rad/s about an axis through the origin, and a drift.
fn turning([x, y, z]: Point) -> Point {
    let [a, b, c] = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
    [b * z - c * y + 0.3, c * x - a * z, a * y - b * x - 0.2]
}

fn distance(a: Point, b: Point) -> f64 {
    (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt()
}

impl Case {
    fn lever() -> Case {
        Case {
            name: "lever",
            dimension: 2,
            joints: vec![[-1.0, 0.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0]],
            fixed: vec![1],
            groups: vec![vec![0, 1, 2]],
            links: Vec::new(),
            velocity: at_rest,
        }
    }

    fn all() -> Vec<Case> {
        let square = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.2], [1.0, 1.0, 0.5], [0.0, 1.0, 0.3]];
        vec![
            Case::lever(),
            Case {
                name: "lever with a load on each end and a link between two levers",
                joints: vec![
                    [-1.0, 0.0, 0.0],
                    [0.0; 3],
                    [2.0, 0.0, 0.0],
                    [-1.0, -0.7, 0.0],
                    [2.0, -1.0, 0.0],
                    [3.0, -1.0, 0.0],
                    [3.5, -1.0, 0.0],
                ],
                fixed: vec![1, 5],
                groups: vec![vec![0, 1, 2], vec![4, 5, 6]],
                links: vec![[0, 3], [2, 4]],
                ..Case::lever()
            },
            Case {
                name: "free bar of four joints in space, with a joint on a rod",
                dimension: 3,
                joints: vec![[0.0; 3], [0.1, 0.2, 0.2], [0.5, 1.0, 1.0], [0.75, 1.5, 1.5], [1.0, 0.0, 0.5]],
                fixed: Vec::new(),
                groups: vec![vec![0, 1, 2, 3]],
                links: vec![[3, 4]],
                velocity: turning,
            },
            Case {
                name: "plate in space",
                dimension: 3,
                joints: square.clone(),
                fixed: Vec::new(),
                groups: vec![vec![0, 1, 2, 3]],
                links: Vec::new(),
                velocity: turning,
            },
            Case {
                name: "plate with a hinge on a fixed edge",
                dimension: 3,
                joints: square.clone(),
                fixed: vec![0, 3],
                groups: vec![vec![0, 1, 2, 3]],
                links: Vec::new(),
                velocity: at_rest,
            },
            Case {
                name: "two plates with a common edge",
                dimension: 3,
                joints: [square, vec![[-0.8, 0.0, 0.4], [-0.8, 1.0, 0.7]]].concat(),
                fixed: Vec::new(),
                groups: vec![vec![0, 1, 2, 3], vec![0, 3, 4, 5]],
                links: Vec::new(),
                velocity: turning,
            },
            Case {
                name: "two levers in series about a fixed joint",
                dimension: 2,
                joints: vec![[0.0; 3], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [1.3, 0.4, 0.0], [1.75, 1.0, 0.0]],
                fixed: vec![0],
                groups: vec![vec![0, 1, 2], vec![2, 3, 4]],
                links: Vec::new(),
                velocity: at_rest,
            },
        ]
    }

    fn builder(&self, is_rigid: bool) -> (SystemBuilder, Vec<ParticleId>) {
        let dimension = if self.dimension == 2 { Dimension::Two } else { Dimension::Three };
        let mut builder = System::builder(dimension);
        let joint = |(k, &at): (usize, &Point)| {
            let joint = Particle::at(format!("p{k}"), &at[..self.dimension]).with_mass(1.0 + 0.5 * k as f64);
            let velocity = (self.velocity)(at);
            let fixed = self.fixed.contains(&k);
            builder.particle(if fixed { joint.fixed() } else { joint.with_velocity(&velocity[..self.dimension]) })
        };
        let ids: Vec<ParticleId> = self.joints.iter().enumerate().map(joint).collect();
        let mut rod = |a: usize, b: usize| {
            let name = format!("{a}-{b}");
            builder.constraint(name, Distance::new(ids[a], ids[b], distance(self.joints[a], self.joints[b])))
        };
        self.links.iter().for_each(|&[a, b]| {
            rod(a, b);
        });
        let mut relations = Vec::new();
        let mut done = Vec::new();
        for group in &self.groups {
            let points: Vec<Point> = group.iter().map(|&k| self.joints[k]).collect();
            let pairs = (0..group.len()).flat_map(|b| (0..b).map(move |a| [a, b]));
            let cluster = if is_rigid {
                rigid_cluster(dimension, &points).unwrap()
            } else {
                RigidCluster { rods: pairs.collect(), combinations: Vec::new() }
            };
            for [a, b] in cluster.rods {
                let ends = [group[a].min(group[b]), group[a].max(group[b])];
                if !done.contains(&ends) && ends.iter().any(|end| !self.fixed.contains(end)) {
                    rod(ends[0], ends[1]);
                    done.push(ends);
                }
            }
            for terms in cluster.combinations {
                relations.push(terms.iter().map(|&(k, weight)| (ids[group[k]], weight)).collect::<Vec<_>>());
            }
        }
        for (k, terms) in relations.into_iter().enumerate() {
            builder.constraint(format!("relation {k}"), Relation::homogeneous(terms));
        }
        builder.force(Gravity { acceleration: [0.0, -G, 0.0] });
        (builder, ids)
    }

    /// The joints held by rods, and by rigid clusters.
    fn twins(&self, settings: Settings, add: &dyn Fn(&mut SystemBuilder, &[ParticleId])) -> [Simulation; 2] {
        [false, true].map(|is_rigid| {
            let (mut builder, ids) = self.builder(is_rigid);
            add(&mut builder, &ids);
            let (system, state) = builder.build().unwrap();
            let simulation = Simulation::new(system, state, settings).unwrap();
            assert_eq!(simulation.second_order().is_empty(), is_rigid, "{}", self.name);
            simulation
        })
    }
}

fn no_more(_: &mut SystemBuilder, _: &[ParticleId]) {}

fn settings(integrator: Integrator) -> Settings {
    let h = if integrator.is_adaptive() { 0.02 } else { 1e-3 };
    Settings { integrator, h, tolerance: 1e-9, ..Settings::default() }
}

/// The largest difference of two lists of numbers.
fn off(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The largest difference of positions and velocities.
fn apart(a: &State, b: &State) -> f64 {
    off(a.positions(), b.positions()).max(off(a.velocities(), b.velocities()))
}

/// Under each integrator both take the same steps on the same surface C = 0. Methods that are right to 1e-9 a substep
/// differ by less than ten times that. RATTLE is of second order, and other lengths of its substeps show; 600 steps of
/// `implicit` and `bdf2` gather what their Newton iterations leave, and those of `euler` how far C drifts.
#[test]
fn long_levers_and_plates_move_as_rigid_clusters_do() {
    for case in Case::all() {
        for integrator in Integrator::ALL {
            let settings = settings(integrator);
            let [mut rods, mut cluster] = case.twins(settings, &no_more);
            for _ in 0..(0.6 / settings.h) as usize {
                let report = rods.step().unwrap_or_else(|error| panic!("{} under {integrator}: {error}", case.name));
                cluster.step().unwrap();
                if integrator.projects() {
                    assert!(report.max_relative_length_error < 1e-9, "{} under {integrator}", case.name);
                }
            }
            let apart = apart(rods.state(), cluster.state());
            let is_exact = integrator.is_adaptive() && integrator != Integrator::Rattle;
            let allowed = if is_exact { 1e-8 } else { 1e-6 };
            assert!(apart < allowed, "{} under {integrator}: {apart:e}", case.name);
        }
    }
}

/// The forces are those of the clusters at the start and on the way, exactly in line.
#[test]
fn forces_on_joints_and_supports_are_those_of_the_clusters() {
    for case in Case::all() {
        let [mut rods, mut cluster] = case.twins(settings(Integrator::Dop853), &no_more);
        for _ in 0..10 {
            let (terms, wanted) = (rods.terms(), cluster.terms());
            let q = |simulation: &Simulation| simulation.state().positions().to_vec();
            // Positions differ by the tolerance of the motion.
            let allowed = 1e-8 + 100.0 * off(&q(&rods), &q(&cluster));
            assert!(off(&terms.accelerations, &wanted.accelerations) < allowed, "{}", case.name);
            // On joints that move; two fixed joints of a plate may press against each other by any force.
            let moving = |forces: &[f64]| -> Vec<f64> {
                let each = forces.iter().enumerate();
                each.map(|(k, &force)| if case.fixed.contains(&(k / case.dimension)) { 0.0 } else { force }).collect()
            };
            let (held, wanted_held) = (moving(&terms.constraint_forces), moving(&wanted.constraint_forces));
            assert!(off(&held, &wanted_held) < 10.0 * allowed, "{}: {held:?}, {wanted_held:?}", case.name);
            let ids: Vec<ParticleId> = rods.system().particles().collect();
            let supports = |simulation: &mut Simulation| -> Point {
                let each: Vec<Point> = ids.iter().map(|&id| simulation.support(id)).collect();
                std::array::from_fn(|k| each.iter().map(|force| force[k]).sum())
            };
            let (carried, wanted) = (supports(&mut rods), supports(&mut cluster));
            assert!(off(&carried, &wanted) < 10.0 * allowed, "{}: {carried:?}, {wanted:?}", case.name);
            // Rods that are no part of a lever come first in both.
            let count = case.links.len();
            let (tension, wanted) = (rods.tension(), cluster.tension());
            assert!(off(&tension[..count], &wanted[..count]) < 10.0 * allowed, "{}", case.name);
            let is_unique = rods.tension_is_unique();
            assert!(is_unique[..count].iter().all(|&is_unique| is_unique), "{}", case.name);
            assert!(is_unique[count..].iter().all(|&is_unique| !is_unique), "{}", case.name);
            rods.step().unwrap();
            cluster.step().unwrap();
        }
    }
}

/// What is shown is the system as it was built.
#[test]
fn terms_and_names_are_those_of_the_rods() {
    for case in Case::all() {
        let (system, _) = case.builder(false).0.build().unwrap();
        let [mut simulation, _] = case.twins(settings(Integrator::Dop853), &no_more);
        let (m, shown) = (system.row_count(), simulation.system());
        assert_eq!((shown.row_count(), shown.row_names()), (m, system.row_names()));
        assert_eq!((shown.constraints().len(), shown.row_scales().len()), (system.constraints().len(), m));
        assert!(shown.constraint_at(m).is_none() && shown.links().count() == m);
        let terms = simulation.terms();
        let rows = [&terms.residual, &terms.residual_rate, &terms.acceleration_bias, &terms.right_hand_side];
        assert!(rows.iter().all(|row| row.len() == m) && terms.multipliers.len() == m);
        assert_eq!((terms.jacobian.row_count(), terms.constraint_matrix.to_dense().len()), (m, m * m));
        assert_eq!((terms.multiplier_is_unique.len(), terms.is_open.len(), terms.tension.len()), (m, m, m));
        let pure = evaluate(simulation.system(), simulation.state());
        assert_eq!(pure.accelerations, terms.accelerations);
    }
}

/// A state goes on in a simulation of its own, and under the pure function, with the same bits.
#[test]
fn a_lever_goes_on_from_a_state() {
    let bits = |state: &State| state.positions().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    for integrator in [Integrator::Dop853, Integrator::Auto, Integrator::Bdf2, Integrator::Radau5] {
        let settings = settings(integrator);
        let [mut simulation, _] = Case::lever().twins(settings, &no_more);
        let (built, _) = Case::lever().builder(false).0.build().unwrap();
        for _ in 0..5 {
            simulation.step().unwrap();
        }
        let state = simulation.state().clone();
        let mut again = Simulation::new(built, state.clone(), settings).unwrap();
        let mut extended = Simulation::new(simulation.system().clone(), state.clone(), settings).unwrap();
        let (system, mut stepped) = (simulation.system().clone(), state);
        let mut workspace = Workspace::new(&system);
        for _ in 0..5 {
            for simulation in [&mut simulation, &mut again, &mut extended] {
                simulation.step().unwrap();
            }
            step(&system, &mut stepped, &settings, &mut workspace).unwrap();
            let wanted = bits(simulation.state());
            assert_eq!(bits(&stepped), wanted, "{integrator}: the pure function");
            assert_eq!(bits(extended.state()), wanted, "{integrator}: from its own system");
            assert_eq!(bits(again.state()), wanted, "{integrator}: from the system as built");
        }
    }
}

/// Forces, hand, forms, feedback, integrators and a reset between steps.
#[test]
fn changes_between_steps_act_on_levers() {
    let [mut rods, mut cluster] = Case::lever().twins(settings(Integrator::Dop853), &no_more);
    let start = rods.state().clone();
    let run = |simulation: &mut Simulation| {
        let frames = |simulation: &mut Simulation, count: usize| {
            for _ in 0..count {
                simulation.step().unwrap();
            }
        };
        let end = simulation.system().particle("p2").unwrap();
        frames(simulation, 5);
        let gravity = simulation.system().force_at(0).unwrap();
        simulation.set_force(gravity, Gravity { acceleration: [3.0, -G, 0.0] }).unwrap();
        frames(simulation, 5);
        simulation.grab(end, [1.0, 1.0]).unwrap();
        frames(simulation, 5);
        simulation.drag_to([0.0, 1.5]).unwrap();
        frames(simulation, 5);
        simulation.release();
        simulation.set_formulation(Formulation::Classic).unwrap();
        frames(simulation, 5);
        simulation.set_settings(settings(Integrator::Bdf2)).unwrap();
        frames(simulation, 20);
        simulation.set_settings(settings(Integrator::Rk4)).unwrap();
        simulation.set_feedback(Feedback { ks: 10.0, kd: 5.0, ..Feedback::NONE }).unwrap();
        frames(simulation, 20);
        simulation.set_settings(settings(Integrator::Dop853)).unwrap();
        frames(simulation, 5);
    };
    run(&mut rods);
    run(&mut cluster);
    let apart = apart(rods.state(), cluster.state());
    assert!(apart < 1e-6, "{apart:e}");
    assert!(rods.energy_error().abs() < 1e-3, "{}", rods.energy_error());
    for simulation in [&mut rods, &mut cluster] {
        simulation.reset().unwrap();
    }
    assert_eq!(rods.state().positions(), start.positions());
    assert_eq!(rods.second_order().len(), 1);
    run(&mut rods);
    run(&mut cluster);
    let apart = self::apart(rods.state(), cluster.state());
    assert!(apart < 1e-6, "after a reset: {apart:e}");
}

/// A lever falls on the ground, strikes it with both ends, slides and comes to rest.
#[test]
fn a_lever_strikes_the_ground_as_a_bar_does() {
    let mut case = Case::lever();
    case.fixed.clear();
    case.joints = vec![[0.0, 0.2, 0.0], [0.6, 0.65, 0.0], [0.8, 0.8, 0.0]];
    let ground = |builder: &mut SystemBuilder, ids: &[ParticleId]| {
        for (k, &id) in ids.iter().enumerate() {
            let ground = Obstacle::new(id, Surface::half_space([0.0, 1.0], 0.0));
            builder.constraint(format!("ground {k}"), ground.with_friction(0.3));
        }
    };
    let [mut rods, mut cluster] = case.twins(settings(Integrator::Dop853), &ground);
    let mut impacts = 0;
    for frame in 0..60 {
        let (report, wanted) = (rods.step().unwrap(), cluster.step().unwrap());
        let names = |report: &qhat::StepReport| -> Vec<(String, &'static str)> {
            report.events.iter().map(|event| (event.constraint.clone(), event.kind.name())).collect()
        };
        assert_eq!(names(&report), names(&wanted), "frame {frame}");
        impacts += report.events.iter().filter(|event| event.kind.name() == "impact").count();
        let apart = apart(rods.state(), cluster.state());
        assert!(apart < 1e-6, "frame {frame}: {apart:e}");
    }
    assert!(impacts >= 2, "{impacts} impacts");
}

/// A driven rod turns a lever, and a rope on its other end goes taut.
#[test]
fn a_drive_turns_a_lever_and_a_rope_stops_it() {
    let drive = |builder: &mut SystemBuilder, ids: &[ParticleId]| {
        let anchor = builder.particle(Particle::at("anchor", [-1.0, -1.0]).fixed());
        let length = Driven::text("1 + 0.3*sin(t)").unwrap();
        builder.constraint("drive", Distance::driven(ids[0], anchor, length));
        let post = builder.particle(Particle::at("post", [1.0, 0.6]).fixed());
        let weight = builder.particle(Particle::at("weight", [1.0, -0.5]));
        builder.constraint("rope", Limits::rope(ids[2], weight, 0.6));
        builder.constraint("stay", Limits::rope(post, weight, 1.5));
    };
    let [mut rods, mut cluster] = Case::lever().twins(settings(Integrator::Dop853), &drive);
    for frame in 0..50 {
        let (report, wanted) = (rods.step().unwrap(), cluster.step().unwrap());
        assert_eq!(report.events.len(), wanted.events.len(), "frame {frame}");
        let apart = apart(rods.state(), cluster.state());
        assert!(apart < 1e-6, "frame {frame}: {apart:e}");
    }
    assert!((rods.state().work().drives - cluster.state().work().drives).abs() < 1e-6);
}

/// Rods of a lever never break, by force or by impulse, and others break when they should.
#[test]
fn other_rods_break_as_beside_a_cluster() {
    let mut case = Case::lever();
    case.joints.push([1.0, -0.5, 0.0]);
    let [mut rods, mut cluster] = [false, true].map(|is_rigid| {
        let (mut builder, ids) = case.builder(is_rigid);
        if !is_rigid {
            // The same rods again, with a strength of nothing.
            builder = System::builder(Dimension::Two);
            let joints = case.joints.iter().enumerate().map(|(k, at)| {
                let joint = Particle::at(format!("p{k}"), &at[..2]).with_mass(1.0 + 0.5 * k as f64);
                builder.particle(if k == 1 { joint.fixed() } else { joint })
            });
            let ids: Vec<ParticleId> = joints.collect();
            for (a, b) in [(0, 1), (1, 2), (0, 2)] {
                let rod = Distance::new(ids[a], ids[b], distance(case.joints[a], case.joints[b]));
                let rod = Distance { breaks_at: Some(1e-3), breaks_at_impulse: Some(1e-3), ..rod };
                builder.constraint(format!("{a}-{b}"), rod);
            }
            builder.force(Gravity { acceleration: [0.0, -G, 0.0] });
        }
        let weak = Distance { breaks_at: Some(35.0), ..Distance::new(ids[2], ids[3], 0.5) };
        builder.constraint("weak", weak);
        let ground = Obstacle::new(ids[2], Surface::half_space([0.0, 1.0], -0.9));
        builder.constraint("ground", ground.with_restitution(0.2));
        let (system, state) = builder.build().unwrap();
        Simulation::new(system, state, settings(Integrator::Dop853)).unwrap()
    });
    let mut broke = Vec::new();
    for frame in 0..80 {
        let (report, wanted) = (rods.step().unwrap(), cluster.step().unwrap());
        assert_eq!(report.events.len(), wanted.events.len(), "frame {frame}: {:?}", report.events);
        broke.extend(report.events.into_iter().filter(|event| event.kind.name() == "broke").map(|e| e.constraint));
        let apart = apart(rods.state(), cluster.state());
        assert!(apart < 1e-6, "frame {frame}: {apart:e}");
    }
    assert_eq!(broke, ["weak"]);
    assert_eq!(rods.system().broken_links(rods.state()), [3]);
}

/// The rod from end to end breaks, and then the brace of the joint between: what is left is a hinge, and a simulation
/// that goes on from there has no lever.
#[test]
fn a_broken_rod_makes_no_lever() {
    let mut builder = System::builder(Dimension::Two);
    let joints = [[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let joint = |(k, at): (usize, [f64; 2])| {
        let joint = Particle::at(format!("p{k}"), at);
        builder.particle(if k == 0 { joint.fixed() } else { joint })
    };
    let ids: Vec<ParticleId> = joints.into_iter().enumerate().map(joint).collect();
    for (a, b, breaks_at) in
        [(0, 1, None), (1, 2, None), (0, 2, Some(1e-3)), (0, 3, None), (2, 3, None), (1, 3, Some(2.0))]
    {
        let [x, y] = [a, b].map(|k: usize| [joints[k][0], joints[k][1], 0.0]);
        builder.constraint(format!("{a}-{b}"), Distance { breaks_at, ..Distance::new(ids[a], ids[b], distance(x, y)) });
    }
    builder.force(Gravity { acceleration: [0.0, -G, 0.0] });
    let (system, state) = builder.build().unwrap();
    let settings = settings(Integrator::Dop853);
    let mut simulation = Simulation::new(system.clone(), state, settings).unwrap();
    assert!(simulation.second_order().is_empty());
    simulation.step().unwrap();
    assert_eq!(simulation.system().broken_links(simulation.state()), [2, 5]);
    let mut again = Simulation::new(system, simulation.state().clone(), settings).unwrap();
    assert!(again.second_order().is_empty());
    for _ in 0..20 {
        simulation.step().unwrap();
        again.step().unwrap();
    }
    assert_eq!(again.state().positions(), simulation.state().positions());
}

/// A joint 3e-6 beside the line, and rods whose lengths add up to 1e-10: the joint is put on the line.
#[test]
fn a_joint_nearly_on_the_line_is_put_on_it() {
    let mut case = Case::lever();
    case.joints[2] = [1.0, 3e-6, 0.0];
    let (system, state) = case.builder(false).0.build().unwrap();
    for integrator in [Integrator::Dop853, Integrator::Implicit, Integrator::Auto] {
        let mut simulation = Simulation::new(system.clone(), state.clone(), settings(integrator)).unwrap();
        assert_eq!(simulation.second_order().len(), 1);
        let moved = simulation.projection().moved;
        assert!(moved > 1e-6 && moved < 1e-5, "{moved:e}");
        for _ in 0..50 {
            let report = simulation.step().unwrap();
            assert!(report.max_relative_length_error < 1e-10, "{integrator}: {:e}", report.max_relative_length_error);
        }
        let q = simulation.state().positions();
        assert!((q[0] * q[5] - q[1] * q[4]).abs() < 1e-10, "{integrator}: on one line with the pivot");
    }
}

/// A lever that a drive cannot turn further: the error names the drive, and no row that was not given.
#[test]
fn errors_name_what_was_given() {
    let drive = |builder: &mut SystemBuilder, ids: &[ParticleId]| {
        let anchor = builder.particle(Particle::at("anchor", [-3.0, 0.5]).fixed());
        let length = Driven::text("sqrt(4.25) + t").unwrap();
        builder.constraint("drive", Distance::driven(ids[0], anchor, length));
    };
    for integrator in [Integrator::Dop853, Integrator::Rattle] {
        let [mut rods, _] = Case::lever().twins(settings(integrator), &drive);
        let error = (0..200).find_map(|_| rods.step().err()).expect("the drive ends");
        let (StepError::DriveBlocked { drive, .. } | StepError::DriveEnds { drive, .. }) = &error else {
            panic!("{integrator}: {error}");
        };
        assert_eq!(drive, "drive", "{integrator}: {error}");
    }
}

//! Rods that hold joints only to second order: found where they are, and only there.

use crate::systems::gravity;
use qhat::{Dimension, Distance, Integrator, Particle, Settings, Simulation, System, Warning};

struct Frame {
    dimension: Dimension,
    joints: Vec<Vec<f64>>,
    fixed: Vec<usize>,
    rods: Vec<[usize; 2]>,
    breaks_at: Option<f64>,
}

impl Frame {
    fn plane(joints: &[[f64; 2]], fixed: &[usize], rods: &[[usize; 2]]) -> Frame {
        let joints = joints.iter().map(|x| x.to_vec()).collect();
        Frame { dimension: Dimension::Two, joints, fixed: fixed.to_vec(), rods: rods.to_vec(), breaks_at: None }
    }

    fn space(joints: &[[f64; 3]], fixed: &[usize], rods: &[[usize; 2]]) -> Frame {
        let joints = joints.iter().map(|x| x.to_vec()).collect();
        Frame { dimension: Dimension::Three, joints, fixed: fixed.to_vec(), rods: rods.to_vec(), breaks_at: None }
    }

    fn simulation(&self) -> Simulation {
        let mut builder = System::builder(self.dimension);
        for (k, x) in self.joints.iter().enumerate() {
            let joint = Particle::at(format!("p{k}"), x.clone());
            builder.particle(if self.fixed.contains(&k) { joint.fixed() } else { joint });
        }
        for &[a, b] in &self.rods {
            let squares = self.joints[a].iter().zip(&self.joints[b]).map(|(x, y)| (x - y) * (x - y));
            let [one, other] = [a, b].map(|k| builder.particle_at(k).unwrap());
            let rod = Distance::new(one, other, squares.sum::<f64>().sqrt());
            builder.constraint(format!("{a}-{b}"), Distance { breaks_at: self.breaks_at, ..rod });
        }
        builder.force(gravity());
        let (system, state) = builder.build().unwrap();
        let settings = Settings { integrator: Integrator::Dop853, tolerance: 1e-8, ..Settings::default() };
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        simulation.record_tension(true);
        simulation
    }

    /// The joints of each clique that is held to second order only, and both numbers of degrees of freedom.
    fn found(&self) -> (Vec<Vec<usize>>, Option<[usize; 2]>) {
        let simulation = self.simulation();
        let joints = simulation.second_order().iter().map(|clique| clique.particles.iter().map(|id| id.index()));
        let freedom = simulation.freedom().map(|freedom| [freedom.here, freedom.nearby]);
        (joints.map(Iterator::collect).collect(), freedom)
    }
}

/// The lever of three rods: A and C about B, which is fixed.
fn lever() -> Frame {
    Frame::plane(&[[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]], &[1], &[[0, 1], [1, 2], [0, 2]])
}

#[test]
fn a_lever_of_three_rods_has_one_degree_of_freedom_and_no_tensions() {
    assert_eq!(lever().found(), (vec![vec![0, 1, 2]], Some([2, 1])));
    let mut simulation = lever().simulation();
    let terms = simulation.terms();
    let told = terms.warnings.iter().find_map(|warning| match warning {
        Warning::SecondOrder { joints } => Some((joints.clone(), warning.to_string())),
        _ => None,
    });
    let (joints, words) = told.expect("a warning");
    assert_eq!(joints, [["p0", "p1", "p2"]]);
    assert!(words.contains("`p0`, `p1`, `p2`") && words.contains("`kind = \"rigid\"`"), "{words}");
    for _ in 0..50 {
        assert_eq!(simulation.step().unwrap().max_tension, None, "tensions that are noise have no largest");
    }
}

/// A weight hangs from the lever by a rod whose tension is no noise.
#[test]
fn a_reset_goes_on_recording_tensions() {
    let joints = [[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [1.0, -1.0]];
    let mut simulation = Frame::plane(&joints, &[1], &[[0, 1], [1, 2], [0, 2], [2, 3]]).simulation();
    assert_eq!(simulation.second_order().len(), 1);
    let before = simulation.step().unwrap().max_tension;
    assert!(before.is_some());
    simulation.reset().unwrap();
    assert_eq!(simulation.step().unwrap().max_tension, before);
}

/// The noise is at least 80 N, and the rods carry 33 N at most as a stiff lever would.
#[test]
fn noise_breaks_no_rod() {
    let mut simulation = Frame { breaks_at: Some(1e-3), ..lever() }.simulation();
    for frame in 0..100 {
        let report = simulation.step().unwrap();
        assert!(report.events.is_empty(), "frame {frame}: {:?}", report.events);
    }
    assert!(simulation.system().broken_links(simulation.state()).is_empty());
}

/// With its ends in other rods, free joints and more joints in the line, a lever is still one.
#[test]
fn levers_within_mechanisms_are_found() {
    // A link hangs on each end.
    let linked = Frame::plane(
        &[[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [-1.0, -1.0], [1.0, -1.0]],
        &[1],
        &[[0, 1], [1, 2], [0, 2], [0, 3], [2, 4]],
    );
    assert_eq!(linked.found(), (vec![vec![0, 1, 2]], Some([4, 3])));
    // Four joints in a line, every distance held: 2·4 − 3 at first order, a free bar has three.
    let all = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    let bar = Frame::plane(&[[0.0, 0.0], [0.3, 0.4], [0.9, 1.2], [1.2, 1.6]], &[], &all);
    assert_eq!(bar.found(), (vec![vec![0, 1, 2, 3]], Some([5, 3])));
    // In space each joint between moves in two directions.
    let bar = Frame::space(&[[0.0; 3], [1.0, 2.0, 2.0], [2.0, 4.0, 4.0]], &[], &[[0, 1], [1, 2], [0, 2]]);
    assert_eq!(bar.found(), (vec![vec![0, 1, 2]], Some([7, 5])));
}

/// A joint between two fixed ones, on the line of both: nothing can move.
#[test]
fn a_joint_straight_between_two_fixed_ones_is_held_to_second_order() {
    let taut = Frame::plane(&[[0.0, 0.0], [1.0, 0.0], [3.0, 0.0]], &[0, 2], &[[0, 1], [1, 2]]);
    assert_eq!(taut.found(), (vec![vec![0, 1, 2]], Some([1, 0])));
}

/// Four joints of a plane in space with all distances: the rods hold none of them out of the plane.
#[test]
fn a_flat_tetrahedron_is_held_to_second_order() {
    let all = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(Frame::space(&corners, &[], &all).found(), (vec![vec![0, 1, 2, 3]], Some([7, 6])));
    // Every affine image of a plane is a plane.
    let tilted = corners.map(|[x, y, _]| [0.6 * x, 0.8 * x + 0.28 * y, 0.96 * y]);
    assert_eq!(Frame::space(&tilted, &[], &all).found(), (vec![vec![0, 1, 2, 3]], Some([7, 6])));
    // One joint out of the plane: a tetrahedron.
    let raised = [corners[0], corners[1], corners[2], [0.0, 1.0, 0.1]];
    assert_eq!(Frame::space(&raised, &[], &all).found(), (vec![], None));
}

/// Rods that repeat each other, with every joint held by others, are redundant and nothing more.
#[test]
fn a_chord_in_two_pieces_within_a_truss_is_redundant_only() {
    // The middle joint of the chord is braced from below.
    let truss = Frame::plane(
        &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, -1.0]],
        &[0],
        &[[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]],
    );
    assert_eq!(truss.found(), (vec![], None));
    // In space the same brace leaves the joint free across the plane.
    let joints = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, -1.0, 0.0]];
    let rods = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];
    let framed = Frame::space(&joints, &[0], &rods);
    let (cliques, freedom) = framed.found();
    assert!(cliques.contains(&vec![0, 1, 2]), "{cliques:?}");
    assert_eq!(freedom, Some([4, 3]));
    // The rows that hold the plane hold the line in it, and no row repeats another.
    let report = framed.simulation().step().unwrap();
    assert!(!report.warnings.contains(&Warning::Singular), "{:?}", report.warnings);
    // A square with both diagonals, in the plane.
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let braced = Frame::plane(&square, &[], &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]]);
    assert_eq!(braced.found(), (vec![], None));
}

/// A triangle that is flat to a thousandth is a triangle.
#[test]
fn a_low_triangle_is_no_line() {
    let low = Frame::plane(&[[-1.0, 0.0], [0.0, 1e-3], [1.0, 0.0]], &[1], &[[0, 1], [1, 2], [0, 2]]);
    assert_eq!(low.found(), (vec![], None));
}

/// The search takes each rod of a hub once: a wheel has no lines but those through its hub.
#[test]
fn a_wheel_of_many_spokes_has_no_clique() {
    let n = 500;
    let mut joints = vec![[0.0, 0.0]];
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
    joints.extend((0..n).map(|i| [libm::cos(angle(i)), libm::sin(angle(i))]));
    let mut rods: Vec<[usize; 2]> = (1..=n).map(|i| [0, i]).collect();
    rods.extend((1..n).map(|i| [i, i + 1]));
    let simulation = Frame::plane(&joints, &[], &rods).simulation();
    assert!(simulation.second_order().is_empty());
}

//! scratch
use qhat::*;
fn gravity() -> Gravity {
    Gravity { acceleration: [0.0, -9.81, 0.0] }
}
fn truss(bays: usize) {
    let mut b = System::builder(Dimension::Two);
    let p: Vec<[ParticleId; 2]> = (0..=bays)
        .map(|i| {
            [0, 1].map(|z| {
                let particle = Particle::at(format!("p{i}{z}"), [i as f64, z as f64]);
                b.particle(if i == 0 { particle.fixed() } else { particle })
            })
        })
        .collect();
    let mut rod = |b: &mut SystemBuilder, x: ParticleId, y: ParticleId, l: f64| {
        b.constraint(format!("r{}-{}", x.0, y.0), Distance::new(x, y, l));
    };
    for i in 0..bays {
        rod(&mut b, p[i][0], p[i + 1][0], 1.0);
        rod(&mut b, p[i][1], p[i + 1][1], 1.0);
        rod(&mut b, p[i + 1][0], p[i + 1][1], 1.0);
        rod(&mut b, p[i][0], p[i + 1][1], 2f64.sqrt());
        rod(&mut b, p[i][1], p[i + 1][0], 2f64.sqrt());
    }
    b.force(gravity());
    let (system, state) = b.build().unwrap();
    let clock = std::time::Instant::now();
    let mut s =
        Simulation::new(system, state, Settings { integrator: Integrator::Dop853, ..Settings::default() }).unwrap();
    let made = clock.elapsed().as_secs_f64();
    for _ in 0..10 {
        s.step().unwrap();
    }
    let stepped = clock.elapsed().as_secs_f64() - made;
    let t = s.terms();
    let off = t
        .constraint_forces
        .iter()
        .enumerate()
        .skip(4)
        .map(|(k, f)| (f + t.applied_forces[k]).abs())
        .fold(0.0, f64::max);
    let most = t.multipliers.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    println!(
        "truss {bays}: rank {:?} of {} off {off:.2e} largest lambda {most:.3e} ratio {:.1e}; start {made:.3} s, ten steps {stepped:.3} s, energy {:.1e}",
        t.rank,
        t.multipliers.len(),
        off / most,
        s.energy_error_max()
    );
}
fn twice(integrator: Integrator, h: f64, steps: usize) {
    let mut b = System::builder(Dimension::Two);
    let f = b.particle(Particle::at("f", [0.0, 0.0]).fixed());
    let a = b.particle(Particle::at("a", [1.0, 0.0]));
    b.constraint("length", Distance::new(f, a, 1.0));
    b.constraint("squared", Distance { form: DistanceForm::Squared, ..Distance::new(f, a, 1.0) });
    b.force(gravity());
    let (system, state) = b.build().unwrap();
    let mut s = Simulation::new(system, state, Settings { integrator, h, ..Settings::default() }).unwrap();
    for _ in 0..steps {
        if let Err(e) = s.step() {
            println!("{integrator} {h}: {e}");
            return;
        }
    }
    println!("twice {integrator} {h}: {:?} energy {:.2e}", s.state().positions(), s.energy_error_max());
}
fn main() {
    for n in [10, 100, 200, 1000] {
        truss(n);
    }
    for i in [
        Integrator::Auto,
        Integrator::Dop853,
        Integrator::Rattle,
        Integrator::Implicit,
        Integrator::Bdf2,
        Integrator::Rk4,
    ] {
        twice(i, 0.2, 1);
        twice(i, 0.01, 1000);
    }
}

use qhat::*;

fn gravity() -> Gravity {
    Gravity { acceleration: [0.0, -9.81, 0.0] }
}

fn settings(integrator: Integrator, h: f64, tolerance: f64) -> Settings {
    Settings { integrator, h, tolerance, ..Settings::default() }
}

fn parallelogram(tolerance: f64, loops: usize, integrator: Integrator, masses: [f64; 2]) {
    let mut b = System::builder(Dimension::Two);
    let mut last: Option<ParticleId> = None;
    for k in 0..=loops {
        let x = k as f64;
        let a = b.particle(Particle::at(format!("a{k}"), [x, 0.0]).fixed());
        let c = b.particle(Particle::at(format!("b{k}"), [x, 1.0]).with_velocity([1.0, 0.0]).with_mass(masses[k % 2]));
        b.constraint(format!("r{k}"), Distance::new(a, c, 1.0));
        if let Some(l) = last {
            b.constraint(format!("c{k}"), Distance::new(l, c, 1.0));
        }
        last = Some(c);
    }
    b.force(gravity());
    let (system, state) = b.build().unwrap();
    let mut s = Simulation::new(system, state, settings(integrator, 0.05, tolerance)).unwrap();
    let (mut subs, mut rej) = (0, 0);
    for k in 0..80 {
        match s.step() {
            Ok(r) => {
                subs += r.substeps;
                rej += r.rejected;
            }
            Err(e) => {
                println!("   at {k}: {e}");
                break;
            }
        }
    }
    let q = s.state().positions();
    println!(
        "parallelogram loops {loops} tol {tolerance:e} {integrator}: q {:.9} {:.9} energy {:.2e} substeps {subs} rejected {rej}",
        q[2],
        q[3],
        s.energy_error_max()
    );
}

fn main() {
    if let Ok(t) = std::env::var("TOL") {
        parallelogram(t.parse().unwrap(), 1, Integrator::Dop853, [1.0, 1.0]);
        return;
    }
    for tol in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
        parallelogram(tol, 1, Integrator::Dop853, [1.0, 1.0]);
    }
    for tol in [1e-4, 1e-9, 1e-11] {
        parallelogram(tol, 5, Integrator::Dop853, [1.0, 1.0]);
        parallelogram(tol, 5, Integrator::Dopri5, [1.0, 3.0]);
        parallelogram(tol, 5, Integrator::Rattle, [1.0, 3.0]);
    }
}

//! Many simulations at once, on every core.

use crate::error::StepError;
use crate::report::StepReport;
use crate::simulation::Simulation;
use crate::threads;

/// Takes one [step](Simulation::step) of every simulation. They know nothing of each other, so the bits are those of
/// one step after the other. To run many frames, [`run_all`] is quicker.
///
/// Returns one outcome each, in their order.
pub fn step_all(simulations: &mut [Simulation]) -> Vec<Result<StepReport, StepError>> {
    each(0, simulations, &|_, simulation| simulation.step())
}

/// Runs every simulation for a number of frames, and collects what `observe` makes of each frame. `observe` gets the
/// place of the simulation in the slice, the simulation, and the report of the frame.
///
/// Each simulation runs all its frames while it is in the cache of a core. With small systems that is faster than as
/// many calls of [`step_all`], which walk through all memory once a frame; the bits are the same.
///
/// Returns one list each, in their order, with one item a frame; or the error of the first frame that failed, where
/// that simulation stopped.
///
/// # Threads
/// With the feature `rayon`, which is on by default, the work is spread over the global pool of rayon, which has a
/// thread for every core, or as many as the environment variable `RAYON_NUM_THREADS` says. A pool of your own takes
/// over by `ThreadPool::install`:
///
/// ```
/// # use qhat::{Dimension, Gravity, Particle, Settings, Simulation, System, run_all};
/// # let mut builder = System::builder(Dimension::Two);
/// # builder.with_particle(Particle::at("stone", [0.0, 0.0])).force(Gravity::new([0.0, -10.0]));
/// # let (system, state) = builder.build()?;
/// # let stone = Simulation::new(system, state, Settings::default())?;
/// let mut stones = vec![stone; 10];
/// let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build()?;
/// let heights = pool.install(|| run_all(&mut stones, 100, |_, stone, _| stone.state().positions()[1]));
/// assert!((heights[9].as_ref().unwrap()[99] + 5.0).abs() < 1e-9); // 10 m/s² for 1 s
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn run_all<T: Send>(
    simulations: &mut [Simulation],
    frames: usize,
    observe: impl Fn(usize, &mut Simulation, &StepReport) -> T + Sync,
) -> Vec<Result<Vec<T>, StepError>> {
    each(0, simulations, &|place, simulation| {
        let frame = |_| simulation.step().map(|report| observe(place, simulation, &report));
        (0..frames).map(frame).collect()
    })
}

/// Applies a function to each simulation and its place, halves at a time.
fn each<R: Send>(
    first: usize,
    simulations: &mut [Simulation],
    work: &(impl Fn(usize, &mut Simulation) -> R + Sync),
) -> Vec<R> {
    match simulations {
        [] => Vec::new(),
        [one] => vec![work(first, one)],
        many => {
            let middle = many.len() / 2;
            let (left, right) = many.split_at_mut(middle);
            let halves = threads::both(|| each(first, left, work), || each(first + middle, right, work));
            let (mut outcomes, rest) = halves;
            outcomes.extend(rest);
            outcomes
        }
    }
}

//! What must not allocate, in a process of its own: the allocator counts for all threads.

use qhat::{Dimension, Distance, Gravity, Limits, Obstacle, Parameter, Particle, Quantity, Surface, System};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System as Allocator;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<Allocator> = &INSTRUMENTED_SYSTEM;

/// A chain with a soft rod, a rope that breaks and a ground with friction, so that every derived number is renewed.
#[test]
fn bind_allocates_nothing() {
    let mut builder = System::builder(Dimension::Two);
    let ids: Vec<_> = (0..50).map(|k| builder.particle(Particle::at(format!("p{k}"), [k as f64, 1.0]))).collect();
    let rods: Vec<_> = ids.windows(2).map(|pair| Distance::new(pair[0], pair[1], 1.0)).collect();
    let rods: Vec<_> = rods.into_iter().enumerate().map(|(k, rod)| builder.constraint(format!("r{k}"), rod)).collect();
    let soft = Distance { compliance: 1e-3, ..Distance::new(ids[0], ids[2], 2.0) };
    let soft = builder.constraint("soft", soft);
    let rope = builder.constraint("rope", Limits::rope(ids[0], ids[9], 10.0).breaking_at(5.0));
    let ground = Obstacle::new(ids[7], Surface::half_space([0.0, 1.0], 0.0)).with_friction(0.2);
    let ground = builder.constraint("ground", ground);
    let gravity = builder.force(Gravity::new([0.0, -9.81]));
    builder.parameter(Parameter::new("a", 1.0)).unwrap();
    let number = |id, key: &str| Quantity::Constraint(id, key.to_owned(), 0);
    let uses = [
        (number(rods[3], "length"), "a"),
        (number(soft, "compliance"), "a/1000"),
        (number(rope, "breaks_at"), "5 + sin(a)"),
        (number(ground, "friction"), "0.2*a^2"),
        (Quantity::Force(gravity, "acceleration".into(), 1), "-9.81*a"),
        (Quantity::Mass(ids[5]), "sqrt(a)"),
        (Quantity::Position(ids[49], 0), "48 + a"),
    ];
    for (quantity, text) in uses {
        builder.depends(quantity, text).unwrap();
    }
    let (mut system, _) = builder.build().unwrap();
    let region = Region::new(ALLOCATOR);
    for k in 0..100 {
        system.bind(&[1.0 + 1e-3 * f64::from(k)]).unwrap();
    }
    let counted = region.change();
    assert_eq!((counted.allocations, counted.reallocations, counted.deallocations), (0, 0, 0));
}

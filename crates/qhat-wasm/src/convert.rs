//! Conversion of the engine's records to JavaScript records, field by field, and of the page's controls to calls of the
//! engine.

use crate::record::{Record, error, list, number, numbers, point, strings, text};
use crate::{Controls, Projection, Shapes, StepReport, Structure, Terms};
use js_sys::Float64Array;
use qhat::{
    Constraint, DistanceForm, EventKind, Feedback, Formulation, Link, NailForm, Settings, Simulation, System, Warning,
    WarningLog,
};
use qhat_shapes::{Shape, Source};
use wasm_bindgen::{JsCast, JsValue};

/// Most cells of J or A, whichever is larger, for which both are passed to the page. A person cannot read larger
/// matrices.
const LARGEST_GRID: usize = 4096;

pub(crate) fn structure(simulation: &Simulation, name: &str, description: &str, duration: f64) -> Structure {
    let system = simulation.system();
    Record::new()
        .with("name", name)
        .with("description", description)
        .with("dimension", system.dimension() as u32)
        .with("duration", duration)
        .with("particle_names", strings(system.particle_names()))
        .with("row_names", strings(system.row_names()))
        .with("masses", numbers(system.masses()))
        .with("fixed", list(system.particles().map(|particle| system.is_fixed(particle))))
        .with("shapes", shapes(system, &qhat_shapes::shapes(system, simulation.state())))
        .finish()
}

pub(crate) fn shapes(system: &System, shapes: &[Shape]) -> Shapes {
    let links: Vec<Link<'_>> = system.links().collect();
    let records = shapes.iter().map(|shape| {
        let (source, index, name) = match shape.of {
            Source::Constraint(i) => ("constraint", i, system.constraints()[i].name.as_str()),
            Source::Force(i) => ("force", i, ""),
        };
        Record::new()
            .with("kind", shape.kind.name())
            .with("of", Record::new().with("list", source).with("index", index as u32))
            .with("name", name)
            .with("particles", list(shape.particles.iter().map(|particle| particle.index() as u32)))
            .with("points", numbers(shape.points.as_flattened()))
            .with("size", shape.size)
            .with("driven", shape.driven)
            .with("link", shape.link.map_or(JsValue::NULL, |place| link(place, &links[place]).into()))
    });
    list(records).unchecked_into()
}

fn link(place: usize, link: &Link<'_>) -> Record {
    let length = |length: Option<f64>| length.map_or(JsValue::NULL, JsValue::from);
    Record::new()
        .with("place", place as u32)
        .with("shortest", length(link.shortest))
        .with("longest", length(link.longest))
        .with("rows", list(link.rows.clone().map(|row| row as u32)))
}

pub(crate) fn energy(energy: &qhat::Energy) -> Record {
    Record::new()
        .with("kinetic", energy.kinetic)
        .with("potential", energy.potential)
        .with("total", energy.total())
        .with("balance", energy.balance())
}

/// A report; each of its warnings tells how often and when the run so far has raised it.
pub(crate) fn report(report: &qhat::StepReport, log: &WarningLog) -> StepReport {
    // The warning about auto's choice is shown beside the choice and not among the other warnings.
    let is_choice = |warning: &&Warning| matches!(warning, Warning::TooStiff { .. });
    let too_stiff = report.warnings.iter().find(is_choice);
    let warnings = report.warnings.iter().filter(|warning| !is_choice(warning));
    let warnings = warnings.filter_map(|warning| log.entry(warning));
    Record::new()
        .with("substeps", report.substeps as f64)
        .with("rejected", report.rejected as f64)
        .with("factorizations", report.factorizations as f64)
        .with("iterations", report.iterations as f64)
        .with("smallest_substep", report.smallest_substep)
        .with("max_residual", report.max_residual)
        .with("max_residual_rate", report.max_residual_rate)
        .with("max_relative_length_error", report.max_relative_length_error)
        .with("max_tension", report.max_tension.map_or(JsValue::NULL, max_tension))
        .with("energy", energy(&report.energy))
        .with("integrator", report.integrator.name())
        .with("solver", report.solver.to_string())
        .with("events", list(report.events.iter().map(event)))
        .with("too_stiff", too_stiff.map_or(JsValue::NULL, |warning| warning.to_string().into()))
        .with("warnings", strings(warnings))
        .finish()
}

fn max_tension(largest: qhat::MaxTension) -> JsValue {
    let record = Record::new().with("tension", largest.tension).with("constraint", largest.link.index() as f64);
    record.with("time", largest.time).with("is_unique", largest.is_unique).finish()
}

/// An event: its kind, its constraint and its time; for an impact also the closing speed.
fn event(event: &qhat::Event) -> Record {
    let speed = match event.kind {
        EventKind::Impact { speed } => Some(speed),
        _ => None,
    };
    let record = Record::new().with("kind", event.kind.name());
    let record = record.with("constraint", event.constraint.as_str()).with("time", event.time);
    match speed {
        Some(speed) => record.with("speed", speed),
        None => record,
    }
}

pub(crate) fn projection(projection: &qhat::Projection) -> Projection {
    Record::new()
        .with("moved", projection.moved)
        .with("velocity_changed", projection.velocity_changed)
        .with("is_moved", projection.is_moved)
        .with("is_turned", projection.is_turned)
        .with("residual_before", projection.residual_before)
        .with("iterations", projection.iterations as f64)
        .finish()
}

pub(crate) fn terms(terms: &qhat::Terms) -> Terms {
    let grid = terms.positions.len().max(terms.residual.len()) * terms.residual.len();
    let dense = |matrix: &dyn Fn() -> Vec<f64>| -> JsValue {
        if grid <= LARGEST_GRID { numbers(&matrix()).into() } else { JsValue::NULL }
    };
    let rank = terms.rank.map_or(JsValue::NULL, |rank| JsValue::from(rank as f64));
    let vector = |values: &Vec<f64>| -> Float64Array { numbers(values) };
    Record::new()
        .with("time", terms.time)
        .with("positions", vector(&terms.positions))
        .with("velocities", vector(&terms.velocities))
        .with("inverse_masses", vector(&terms.inverse_masses))
        .with("applied_forces", vector(&terms.applied_forces))
        .with("residual", vector(&terms.residual))
        .with("residual_rate", vector(&terms.residual_rate))
        .with("jacobian", dense(&|| terms.jacobian.to_dense()))
        .with("acceleration_bias", vector(&terms.acceleration_bias))
        .with("constraint_matrix", dense(&|| terms.constraint_matrix.to_dense()))
        .with("rhs_bias", vector(&terms.rhs_bias))
        .with("rhs_forces", vector(&terms.rhs_forces))
        .with("rhs_stiffness", vector(&terms.rhs_stiffness))
        .with("rhs_damping", vector(&terms.rhs_damping))
        .with("right_hand_side", vector(&terms.right_hand_side))
        .with("multipliers", vector(&terms.multipliers))
        .with("constraint_forces", vector(&terms.constraint_forces))
        .with("accelerations", vector(&terms.accelerations))
        .with("tension", vector(&terms.tension))
        .with("tension_is_unique", list(terms.tension_is_unique.iter().copied()))
        .with("multiplier_is_unique", list(terms.multiplier_is_unique.iter().copied()))
        .with("is_open", list(terms.is_open.iter().copied()))
        .with("rank", rank)
        .with("warnings", strings(&terms.warnings))
        .finish()
}

pub(crate) fn controls(simulation: &Simulation) -> Controls {
    let feedback = simulation.system().feedback();
    Record::new()
        .with("h", simulation.settings().h)
        .with("integrator", simulation.settings().integrator.name())
        .with("frame_budget", simulation.settings().frame_budget as f64)
        .with("frame_work", simulation.settings().frame_work as f64)
        .with("formulation", formulation(simulation.system()))
        .with("ks", feedback.ks)
        .with("kd", feedback.kd)
        .with("diagonal_drag", feedback.diagonal_drag)
        .with("elasticity", feedback.elasticity)
        .with("gravity", list(simulation.gravity()))
        .with("drag", simulation.drag())
        .finish()
}

/// Sets only the controls that differ. Setting a control to its present value could cause a projection or a new
/// factorization, which would change the motion.
pub(crate) fn set_controls(simulation: &mut Simulation, wanted: &JsValue) -> Result<(), JsValue> {
    let integrator = text(wanted, "integrator").parse().map_err(|cause| error("SettingsError", cause))?;
    // The cast turns a fraction, a negative number or NaN into a count, which the engine accepts or rejects.
    let count = |name| number(wanted, name) as usize;
    let settings = Settings {
        h: number(wanted, "h"),
        integrator,
        frame_budget: count("frame_budget"),
        frame_work: count("frame_work"),
        ..*simulation.settings()
    };
    if settings != *simulation.settings() {
        simulation.set_settings(settings).map_err(|cause| error("StepError", cause))?;
    }
    let feedback = Feedback {
        ks: number(wanted, "ks"),
        kd: number(wanted, "kd"),
        diagonal_drag: number(wanted, "diagonal_drag"),
        elasticity: number(wanted, "elasticity"),
    };
    if feedback != *simulation.system().feedback() {
        simulation.set_feedback(feedback).map_err(|cause| error("SettingsError", cause))?;
    }
    let (gravity, drag) = (point(wanted, "gravity"), number(wanted, "drag"));
    if gravity != simulation.gravity() {
        simulation.set_gravity(gravity).map_err(|cause| error("ForceError", cause))?;
    }
    if drag != simulation.drag() {
        simulation.set_drag(drag).map_err(|cause| error("ForceError", cause))?;
    }
    let forms = text(wanted, "formulation");
    if forms != formulation(simulation.system()) {
        let chosen = match forms.as_str() {
            "classic" => Formulation::Classic,
            "modern" => Formulation::Modern,
            _ => return Ok(()), // `mixed` describes a scene and cannot be chosen
        };
        simulation.set_formulation(chosen).map_err(|cause| error("StepError", cause))?;
    }
    Ok(())
}

/// The formulation of the constraints; `mixed` if they have different formulations.
fn formulation(system: &System) -> &'static str {
    // A constraint with one form only belongs to both formulations.
    let classic = system.constraints().iter().filter_map(|named| {
        if let Constraint::Distance(distance) = &named.constraint {
            Some(distance.form == DistanceForm::Squared)
        } else if let Constraint::Nail(nail) = &named.constraint {
            Some(nail.form == NailForm::Scalar)
        } else {
            None
        }
    });
    let (mut any, mut all) = (false, true);
    for is_classic in classic {
        any |= is_classic;
        all &= is_classic;
    }
    match (any, all) {
        (false, _) => "modern",
        (true, true) => "classic",
        (true, false) => "mixed",
    }
}

/// A point of two or three components as the engine takes it; a missing component is zero.
pub(crate) fn target(components: &[f64]) -> [f64; 3] {
    std::array::from_fn(|k| components.get(k).copied().unwrap_or(0.0))
}

/// A parameter of a scene. A missing limit is null.
pub(crate) fn parameter(parameter: &qhat::Parameter) -> Record {
    let limit = |limit: f64| if limit.is_finite() { JsValue::from(limit) } else { JsValue::NULL };
    let [least, greatest] = parameter.range.map(limit);
    Record::new()
        .with("name", parameter.name.as_str())
        .with("value", parameter.value)
        .with("min", least)
        .with("max", greatest)
        .with("unit", parameter.unit.as_str())
}

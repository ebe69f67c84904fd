//! Guides of particles: wires, endless lines, rings, angles.

use super::path::Path;
use super::surfaces::trace_ring;
use super::view::View;
use crate::shape::{Shape, ShapeKind};
use std::f64::consts::TAU;

/// The radius of the arc of an angle \[px\].
const ANGLE_RADIUS: f64 = 24.0;
/// Length by which the line for the direction of an angle extends beyond the arc \[px\].
const REFERENCE: f64 = 10.0;

/// A wire, an endless line or a ring that a bead runs along.
pub(super) fn trace_guide(view: &View<'_>, shape: &Shape, path: &mut Path) {
    match shape.kind {
        ShapeKind::Ring => trace_ring(view, shape, path),
        ShapeKind::Line => trace_line(view, shape, path),
        _ => path.polygon(shape.points.iter().map(|&point| view.camera.spot(point))),
    }
}

/// A line across the whole picture.
fn trace_line(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let camera = &view.camera;
    let [[ax, ay], [mut bx, mut by]] = view.ends(shape);
    if shape.particles.len() < 2 {
        let [dx, dy] = camera.direction(shape.points.last().copied().unwrap_or_default());
        [bx, by] = [ax + dx, ay + dy];
    }
    let length = (bx - ax).hypot(by - ay);
    if length < 1e-9 {
        return;
    }
    let [ux, uy] = [(bx - ax) / length, (by - ay) / length];
    let [mx, my] = camera.middle;
    let nearest = (mx - ax) * ux + (my - ay) * uy;
    let at = |along: f64| [ax + along * ux, ay + along * uy];
    path.segment(at(nearest - camera.reach()), at(nearest + camera.reach()));
}

/// An arc at the corner from the first arm, or from the direction, to the second arm, over at most half a turn.
pub(super) fn trace_angle(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let [.., c, d] = shape.particles[..] else { return };
    let towards = |[x, y]: [f64; 2]| y.atan2(x);
    let arm = |a, b| {
        let [[ax, ay], [bx, by]] = [view.spot(a), view.spot(b)];
        towards([bx - ax, by - ay])
    };
    let [x, y] = view.spot(c);
    let first = (shape.particles.len() == 4).then(|| shape.particles[0]);
    let from = match first {
        Some(a) => arm(a, shape.particles[1]),
        None => towards(view.camera.direction(shape.points.first().copied().unwrap_or_default())),
    };
    let turn = arm(c, d) - from;
    let shorter = turn - TAU * (turn / TAU).round();
    // The direction from which the angle counts is drawn where no arm shows it.
    if first != Some(c) {
        let far = ANGLE_RADIUS + REFERENCE;
        path.segment([x, y], [x + far * from.cos(), y + far * from.sin()]);
    }
    path.arc([x, y], ANGLE_RADIUS, from, shorter);
}

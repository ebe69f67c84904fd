//! Springs and nails.

use super::path::Path;
use super::view::View;
use crate::shape::{Shape, ShapeKind};

/// Turns of a drawn spring, the same number at any length.
const TURNS: u32 = 6;
/// Width by which the ring of a nail extends beyond its particle, and the cross beyond the ring \[px\].
const NAIL: f64 = 4.0;
/// Number of springs above which springs are drawn thinner.
const MANY_SPRINGS: usize = 60;

/// A spring: straight ends, and a zig-zag between.
pub(super) fn trace_coil(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let springs = view.shapes.iter().filter(|shape| shape.kind == ShapeKind::Spring);
    let width = if springs.take(MANY_SPRINGS + 1).count() > MANY_SPRINGS { 3.0 } else { 5.0 };
    let [[ax, ay], [bx, by]] = view.ends(shape);
    let length = (bx - ax).hypot(by - ay);
    path.go([ax, ay]);
    if length > 1.0 {
        let [ux, uy] = [(bx - ax) / length, (by - ay) / length];
        let end = (0.2 * length).min(14.0);
        let coil = length - 2.0 * end;
        for k in 0..=2 * TURNS {
            let along = end + coil * (f64::from(k) + 0.5) / f64::from(2 * TURNS + 1);
            let side = if k % 2 == 0 { width } else { -width };
            path.line([ax + ux * along - uy * side, ay + uy * along + ux * side]);
        }
    }
    path.line([bx, by]);
}

/// A ring with a cross, drawn under the particle.
pub(super) fn trace_nail(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let [x, y] = view.camera.spot(shape.points[0]);
    let radius = NAIL + shape.particles.first().map_or(0.0, |particle| view.radii[particle.index()]);
    path.circle([x, y], radius);
    let arm = radius + NAIL;
    path.segment([x - arm, y], [x + arm, y]);
    path.segment([x, y - arm], [x, y + arm]);
}

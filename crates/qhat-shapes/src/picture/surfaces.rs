//! Ground, planes, balls, boxes, rings, wheels and areas.

use super::number::nice_ceiling;
use super::path::{Path, Spot};
use super::vector::{Vec3, dot, frame, minus, plus, scaled};
use super::view::View;
use crate::shape::Shape;
use std::f64::consts::TAU;

/// Distance and depth of the strokes of a hatch \[px\].
const HATCH: f64 = 12.0;
/// Approximate distance of the lines in a plane \[px\], and their number to each side.
const PLANE_CELL: f64 = 60.0;
const PLANE_CELLS: i32 = 8;
/// Number of straight pieces of a ring. In a picture of a thousand pixels they are within a pixel of the ring.
const RING_PIECES: u32 = 96;

/// In the plane, the ground is a line across the picture with a hatch below; in space it is a plane.
pub(super) fn trace_ground(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let camera = &view.camera;
    if camera.dimension == 3 {
        return;
    }
    let [x, y] = camera.spot(shape.points[0]);
    // y of the picture points down.
    let [nx, ny, _] = shape.points[1];
    let [nx, ny] = [nx, -ny];
    let [ux, uy] = [-ny, nx];
    let [mx, my] = camera.middle;
    let reach = camera.reach();
    let nearest = (mx - x) * ux + (my - y) * uy;
    let at = |along: f64| [x + along * ux, y + along * uy];
    path.segment(at(nearest - reach), at(nearest + reach));
    let [first, last] = [((nearest - reach) / HATCH).ceil() as i64, ((nearest + reach) / HATCH).floor() as i64];
    for k in first..=last {
        let [px, py] = at(k as f64 * HATCH);
        let end = [px - HATCH * (nx - 0.7 * ux), py - HATCH * (ny - 0.7 * uy)];
        // The line goes on outside the picture; the hatch is left out there.
        if [px, end[0]].iter().any(|x| (0.0..=camera.size[0]).contains(x)) {
            path.segment([px, py], end);
        }
    }
}

/// Lines of a grid in a plane, around the point that is nearest to the middle of the view.
pub(super) fn trace_plane(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let camera = &view.camera;
    let (point, [n, u, v]) = (shape.points[0], frame(shape.points[1]));
    if camera.dimension == 2 || dot(camera.towards, n).abs() < 1e-3 {
        return;
    }
    let cell = nice_ceiling(PLANE_CELL / camera.scale);
    let away = minus(camera.centre, point);
    // The grid starts a whole number of cells from the plane's own point, so that its lines are fixed in the scene.
    let [i, j] = [u, v].map(|axis| (dot(away, axis) / cell).round());
    let at = |a: i32, b: i32| {
        let [a, b] = [(i + f64::from(a)) * cell, (j + f64::from(b)) * cell];
        camera.spot(plus(point, plus(scaled(u, a), scaled(v, b))))
    };
    let half = PLANE_CELLS / 2;
    for k in -half..=half {
        path.segment(at(k, -half), at(k, half));
        path.segment(at(-half, k), at(half, k));
    }
}

/// A circle at right angles to the axis, which is the last point of the shape.
pub(super) fn trace_ring(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let axis = shape.points.last().copied().unwrap_or([0.0, 0.0, 1.0]);
    trace_around(view, shape, axis, path);
}

/// The three great circles of a ball in space at right angles to the axes; without them the ball looks like a disc.
pub(super) fn trace_great_circles(view: &View<'_>, shape: &Shape, path: &mut Path) {
    if view.camera.dimension == 3 {
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            trace_around(view, shape, axis, path);
        }
    }
}

/// A circle about the first end of a shape, at right angles to an axis.
fn trace_around(view: &View<'_>, shape: &Shape, axis: Vec3, path: &mut Path) {
    let [[x, y], _] = view.ends(shape);
    let [_, u, v] = frame(axis).map(|axis| view.camera.direction(scaled(axis, shape.size)));
    path.polygon((0..RING_PIECES).map(|i| {
        let angle = TAU * f64::from(i) / f64::from(RING_PIECES);
        let [c, s] = [angle.cos(), angle.sin()];
        [x + c * u[0] + s * v[0], y + c * u[1] + s * v[1]]
    }));
    path.close();
}

pub(super) fn trace_area(view: &View<'_>, shape: &Shape, path: &mut Path) {
    path.polygon(shape.particles.iter().map(|&particle| view.spot(particle)));
    path.close();
}

pub(super) fn trace_ball(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let [centre, _] = view.ends(shape);
    path.circle(centre, shape.size * view.camera.scale);
}

/// The rectangle of a box, or in space its visible faces. These do not overlap, so the fill is even.
pub(super) fn trace_box(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let camera = &view.camera;
    let [centre, half] = [shape.points[0], shape.points[1]];
    let flat = camera.dimension == 2;
    for axis in if flat { 2..3 } else { 0..3 } {
        let towards = camera.towards[axis];
        if towards == 0.0 {
            continue;
        }
        let side = towards.signum();
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        // All faces go the same way round in the picture, so that overlapping faces of two boxes do not cancel.
        let corners = [[-1.0, -1.0], [side, -side], [1.0, 1.0], [-side, side]];
        path.polygon(corners.map(|[a, b]| {
            let mut corner = centre;
            corner[axis] += if flat { 0.0 } else { side * half[axis] };
            corner[u] += a * half[u];
            corner[v] += b * half[v];
            camera.spot(corner)
        }));
        path.close();
    }
}

/// A pitch circle with the spoke to its marked point.
pub(super) fn trace_wheel(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let [centre, rim]: [Spot; 2] = view.ends(shape);
    let radius = shape.size * view.camera.scale;
    path.circle(centre, radius);
    let angle = (rim[1] - centre[1]).atan2(rim[0] - centre[0]);
    path.segment(centre, [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()]);
}

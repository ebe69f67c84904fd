//! Links in the colour of their tension, and other shapes that go from one particle to another.

use super::number::format;
use super::path::{Path, number};
use super::pen::{Pen, Stroke};
use super::vector::{minus, scaled};
use super::view::{View, link_width, sag};
use crate::shape::{Shape, ShapeKind, Source};

/// A rope counts as taut if its slack is less than this part of its length: half a pixel for a rope across the picture.
const TAUT: f64 = 5e-4;
/// Length of the stubs at the ends of a broken link \[px\], and the largest part of the distance of the ends that a
/// stub takes.
const STUB: [f64; 2] = [14.0, 0.3];

/// Draws broken links as stubs, and the others that carry a tension or hold a length in the colour of their tension.
pub(super) fn draw(view: &View<'_>, pen: &mut Pen) {
    let width = link_width(view.picture.tension.len());
    let mut stubs = Path::default();
    view.links().filter(|(shape, _)| view.is_broken(shape)).for_each(|(shape, _)| trace_stubs(view, shape, &mut stubs));
    let stroke = Stroke { colour: view.palette.outline, width: 0.6 * width, dash: Some([3.0, 4.0]), fill: 0.0 };
    pen.path("broken", &stubs, stroke);

    let mut drawn: Vec<(&Shape, usize)> =
        view.links().filter(|&(shape, place)| is_straight(view, shape, place)).collect();
    let [far, range] = view.depths();
    let in_space = view.camera.dimension == 3 && range > 0.0;
    // The nearness of a link to the viewer, from 0 to 1.
    let nearness = |shape: &Shape| {
        let depth = |k: usize| view.screen[shape.particles[k].index()][2];
        if in_space { (0.5 * (depth(0) + depth(1)) - far) / range } else { 1.0 }
    };
    if in_space {
        drawn.sort_by(|(a, _), (b, _)| nearness(a).total_cmp(&nearness(b)));
    }
    pen.open("g", &[("class", "links"), ("stroke-width", &number(width)), ("stroke-linecap", "round")]);
    for (shape, place) in drawn {
        let tension = view.tension(place);
        let colour = view.palette.tension(tension, view.limit);
        let [[x1, y1], [x2, y2]] = view.ends(shape).map(|spot| spot.map(number));
        let mut attributes =
            vec![("class", shape.kind.name()), ("x1", &x1), ("y1", &y1), ("x2", &x2), ("y2", &y2), ("stroke", &colour)];
        // Far links are thinner and paler: the depth cue of a view without perspective.
        let part = nearness(shape);
        let [opacity, thickness] = [0.45 + 0.55 * part, width * (0.6 + 0.6 * part)].map(number);
        if in_space {
            attributes.extend([("stroke-opacity", opacity.as_str()), ("stroke-width", &thickness)]);
        }
        pen.titled("line", &attributes, &title(view, shape, tension));
    }
    pen.close("g");
}

/// The title of a link: its kind, its name and its tension.
fn title(view: &View<'_>, shape: &Shape, tension: f64) -> String {
    let name = match shape.of {
        Source::Constraint(i) => view.picture.system.constraints().get(i).map_or("", |named| named.name.as_str()),
        Source::Force(_) => "",
    };
    let how = if tension > 0.0 {
        " pull"
    } else if tension < 0.0 {
        " push"
    } else {
        ""
    };
    format!("{} {name}: {} N{how}", shape.kind.name(), format(tension.abs(), 3))
}

/// Whether a link is drawn as a straight line in the colour of its tension: a rod until it breaks, a rope or strut
/// while it has a tension. All other links are drawn in their own style only.
fn is_straight(view: &View<'_>, shape: &Shape, place: usize) -> bool {
    !view.is_broken(shape) && (shape.kind == ShapeKind::Rod || view.tension(place).abs() > 0.0)
}

fn trace_stubs(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let [[ax, ay], [bx, by]] = view.ends(shape);
    let length = (bx - ax).hypot(by - ay);
    let part = STUB[1].min(STUB[0] / length.max(1.0));
    let [dx, dy] = [part * (bx - ax), part * (by - ay)];
    path.segment([ax, ay], [ax + dx, ay + dy]);
    path.segment([bx, by], [bx - dx, by - dy]);
}

pub(super) fn trace_between(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let [from, to] = view.ends(shape);
    path.segment(from, to);
}

/// The thick half of a piston, from its first end to the middle.
pub(super) fn trace_piston(view: &View<'_>, shape: &Shape, path: &mut Path) {
    let [from, to] = view.ends(shape);
    path.segment(from, [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])]);
}

fn is_slack(view: &View<'_>, shape: &Shape) -> bool {
    shape.kind == ShapeKind::Rope && view.distance(shape) < shape.size * (1.0 - TAUT)
}

fn is_beyond(view: &View<'_>, shape: &Shape) -> bool {
    view.distance(shape) > shape.size * (1.0 + TAUT)
}

pub(super) fn trace_taut(view: &View<'_>, shape: &Shape, path: &mut Path) {
    if !is_slack(view, shape) {
        trace_between(view, shape, path);
    }
}

/// A slack rope is drawn as a parabola of about its length.
pub(super) fn trace_slack(view: &View<'_>, shape: &Shape, path: &mut Path) {
    if !is_slack(view, shape) {
        return;
    }
    let [from, to] = view.ends(shape);
    let [a, b] = [0, 1].map(|k: usize| view.places[shape.particles[k].index()]);
    // The middle of a quadratic curve lies halfway between the chord and the control point.
    let [dx, dy] = view.camera.direction(scaled(view.down, 2.0 * sag(shape.size, minus(a, b))));
    path.go(from);
    path.curve([0.5 * (from[0] + to[0]) + dx, 0.5 * (from[1] + to[1]) + dy], to);
}

/// A strut at its shortest length.
pub(super) fn trace_pressed(view: &View<'_>, shape: &Shape, path: &mut Path) {
    if !is_beyond(view, shape) {
        trace_between(view, shape, path);
    }
}

/// A strut whose ends are farther apart.
pub(super) fn trace_loose(view: &View<'_>, shape: &Shape, path: &mut Path) {
    if is_beyond(view, shape) {
        trace_between(view, shape, path);
    }
}

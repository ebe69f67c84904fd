//! The frame of a still: the grid behind the scene, its name and time, the scale of colours, the scale bar, the axes.

use super::number::{format, nice_ceiling};
use super::path::{Path, Spot, number};
use super::pen::{Pen, Stroke};
use super::view::View;

/// Approximate distance of grid lines \[px\].
const GRID: f64 = 90.0;
/// Distance from the edge of the picture to text and legend \[px\].
const EDGE: f64 = 28.0;
/// Width and height of the scale of colours \[px\]: whole pixels for each of its steps.
const RAMP: [f64; 2] = [205.0, 10.0];
/// Sizes of the title, of the time and of the legend's text \[px\].
const TITLE: f64 = 24.0;
const TIME: f64 = 15.0;
const SMALL: f64 = 12.0;
/// Digits of the time. With six, frames of a millisecond have different times for a quarter of an hour.
const TIME_DIGITS: usize = 6;
/// The mean width of a letter, relative to the size of the text.
const LETTER: f64 = 0.56;

/// The background and, in the plane, a grid of round lengths.
pub(super) fn draw_background(view: &View<'_>, pen: &mut Pen) {
    let camera = &view.camera;
    let [width, height] = camera.size.map(number);
    pen.element("rect", &[("width", &width), ("height", &height), ("fill", view.palette.canvas)]);
    if camera.dimension == 3 {
        return;
    }
    let step = nice_ceiling(GRID / camera.scale) * camera.scale;
    let mut path = Path::default();
    // The origin of the scene lies on one vertical and one horizontal line.
    let origin = camera.spot([0.0; 3]);
    for (k, end) in [(0, camera.size[1]), (1, camera.size[0])] {
        let mut at = origin[k].rem_euclid(step);
        while at < camera.size[k] {
            let line: [Spot; 2] = if k == 0 { [[at, 0.0], [at, end]] } else { [[0.0, at], [end, at]] };
            path.segment(line[0], line[1]);
            at += step;
        }
    }
    pen.path("grid", &path, Stroke { colour: view.palette.grid, width: 1.0, dash: None, fill: 0.0 });
}

/// Name, time, legend, scale bar and axes.
pub(super) fn draw_labels(view: &View<'_>, pen: &mut Pen) {
    let [width, height] = view.camera.size;
    let name = view.picture.name;
    let letters = name.chars().count().max(1) as f64;
    let title = TITLE.min((width - 2.0 * EDGE) / (LETTER * letters));
    pen.text(name, [EDGE, EDGE + 20.0], title, view.palette.ink, "start");
    let mut time = format!("t = {} s", format(view.picture.time, TIME_DIGITS));
    if !view.picture.note.is_empty() {
        time = format!("{time}, {}", view.picture.note);
    }
    pen.text(&time, [EDGE, EDGE + 44.0], TIME, view.palette.outline, "start");
    if !view.picture.tension.is_empty() {
        draw_legend(view, pen, [EDGE, height - EDGE]);
    }
    draw_scale(view, pen, [width - EDGE, height - EDGE]);
}

/// The scale of colours, its lower left corner at a spot.
fn draw_legend(view: &View<'_>, pen: &mut Pen, [x, y]: Spot) {
    let [width, thickness] = RAMP;
    let top = y - SMALL - 8.0 - thickness;
    // Without smoothing: with it, readers of SVG leave a seam between neighbours.
    pen.open("g", &[("class", "legend"), ("shape-rendering", "crispEdges")]);
    let colours: Vec<String> = view.palette.scale().collect();
    let part = width / colours.len() as f64;
    for (i, colour) in colours.iter().enumerate() {
        let [x, y, wide, high] = [x + i as f64 * part, top, part, thickness].map(number);
        pen.element("rect", &[("x", &x), ("y", &y), ("width", &wide), ("height", &high), ("fill", colour)]);
    }
    let outline = view.palette.outline;
    let limit = format(view.limit, 3);
    for (text, at, anchor) in [("push", 0.0, "start"), ("pull", width, "end")] {
        pen.text(text, [x + at, top - 6.0], SMALL, outline, anchor);
    }
    let [least, most] = [format!("−{limit} N"), format!("+{limit} N")];
    for (text, at, anchor) in [(least.as_str(), 0.0, "start"), ("0", 0.5 * width, "middle"), (&most, width, "end")] {
        pen.text(text, [x + at, y], SMALL, outline, anchor);
    }
    pen.close("g");
}

/// A bar of a round number of metres, its lower right corner at a spot; the axes above it in space.
fn draw_scale(view: &View<'_>, pen: &mut Pen, [x, y]: Spot) {
    let metres = nice_ceiling(GRID / view.camera.scale / 1.25);
    let length = metres * view.camera.scale;
    let text = format!("{} m", format(metres, 3));
    let mut path = Path::default();
    path.polygon([[x - length, y - 5.0], [x - length, y], [x, y], [x, y - 5.0]]);
    pen.path("scale", &path, Stroke { colour: view.palette.outline, width: 1.5, dash: None, fill: 0.0 });
    pen.text(&text, [x - 0.5 * length, y - 8.0], SMALL, view.palette.outline, "middle");
    if view.camera.dimension == 3 {
        draw_axes(view, pen, [x - 40.0, y - 66.0]);
    }
}

fn draw_axes(view: &View<'_>, pen: &mut Pen, [x, y]: Spot) {
    let length = 26.0;
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        let [dx, dy] = [view.camera.right[k] * length, -view.camera.up[k] * length];
        let mut path = Path::default();
        path.segment([x, y], [x + dx, y + dy]);
        pen.path("axis", &path, Stroke { colour: view.palette.outline, width: 1.5, dash: None, fill: 0.0 });
        // The baseline lies a third of the text's size below the middle of the text.
        pen.text(name, [x + 1.4 * dx, y + 1.4 * dy + SMALL / 3.0], SMALL, view.palette.outline, "middle");
    }
}

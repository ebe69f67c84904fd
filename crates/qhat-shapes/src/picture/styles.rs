//! The styles of shapes. All shapes of a style make one path; the paths are drawn from back to front in the order of
//! the list.

use super::path::Path;
use super::pen::{Pen, Stroke};
use super::view::View;
use super::{curves, glyphs, links, surfaces};
use crate::shape::{Shape, ShapeKind};

/// The colour of a style, by its place in the palette.
#[derive(Clone, Copy)]
enum Colour {
    Ink,
    Outline,
    Guide,
    Background,
    Accent,
    Spring,
}

type Trace = fn(&View<'_>, &Shape, &mut Path);

struct Style {
    kinds: &'static [ShapeKind],
    colour: Colour,
    /// The width of the border \[px\]; 0 for shapes without a border.
    width: f64,
    dash: Option<[f64; 2]>,
    /// The opacity of the inside, from 0 to 1.
    fill: f64,
    trace: Trace,
}

const fn style(kinds: &'static [ShapeKind], colour: Colour, width: f64, trace: Trace) -> Style {
    Style { kinds, colour, width, dash: None, fill: 0.0, trace }
}

const fn dashed(style: Style, dash: [f64; 2]) -> Style {
    Style { dash: Some(dash), ..style }
}

const fn filled(style: Style, fill: f64) -> Style {
    Style { fill, ..style }
}

use Colour::{Accent, Background, Guide, Ink, Outline, Spring};
use ShapeKind as Kind;

/// A rod has no style: it is drawn in the colour of its tension, with the taut ropes and struts.
const STYLES: &[Style] = &[
    filled(style(&[Kind::Area], Accent, 0.0, surfaces::trace_area), 0.14),
    style(&[Kind::Ground], Outline, 1.25, surfaces::trace_ground),
    style(&[Kind::Plane, Kind::Ground], Guide, 1.0, surfaces::trace_plane),
    filled(style(&[Kind::Ball], Outline, 1.5, surfaces::trace_ball), 0.16),
    style(&[Kind::Bowl], Outline, 1.5, surfaces::trace_ball),
    style(&[Kind::Ball, Kind::Bowl], Guide, 1.0, surfaces::trace_great_circles),
    filled(style(&[Kind::Box], Outline, 1.5, surfaces::trace_box), 0.16),
    filled(style(&[Kind::Wheel], Outline, 2.0, surfaces::trace_wheel), 0.12),
    style(&[Kind::Wire, Kind::Line, Kind::Ring], Guide, 5.0, curves::trace_guide),
    style(&[Kind::Wire, Kind::Line, Kind::Ring], Background, 2.0, curves::trace_guide),
    dashed(style(&[Kind::Tie], Outline, 1.5, links::trace_between), [1.5, 5.0]),
    dashed(style(&[Kind::Rope], Ink, 1.25, links::trace_slack), [4.0, 4.0]),
    style(&[Kind::Cord, Kind::Rope], Ink, 1.75, links::trace_taut),
    style(&[Kind::Strut], Outline, 4.0, links::trace_pressed),
    dashed(style(&[Kind::Strut], Outline, 2.0, links::trace_loose), [6.0, 5.0]),
    style(&[Kind::Spring], Spring, 1.5, glyphs::trace_coil),
    style(&[Kind::DrivenRod, Kind::Actuator], Outline, 2.5, links::trace_between),
    style(&[Kind::DrivenRod, Kind::Actuator], Outline, 7.0, links::trace_piston),
    style(&[Kind::Angle], Accent, 2.0, curves::trace_angle),
    style(&[Kind::Nail], Ink, 1.5, glyphs::trace_nail),
];

/// Draws all shapes except links with a tension and particles.
pub(super) fn draw(view: &View<'_>, pen: &mut Pen) {
    for style in STYLES {
        let mut path = Path::default();
        for shape in view.shapes.iter().filter(|shape| style.kinds.contains(&shape.kind) && !view.is_broken(shape)) {
            (style.trace)(view, shape, &mut path);
        }
        let colour = match style.colour {
            Ink => view.palette.ink,
            Outline => view.palette.outline,
            Guide => view.palette.guide,
            Background => view.palette.canvas,
            Accent => view.palette.accent,
            Spring => view.palette.spring,
        };
        let names: Vec<&str> = style.kinds.iter().map(|kind| kind.name()).collect();
        let stroke = Stroke { colour, width: style.width, dash: style.dash, fill: style.fill };
        pen.path(&names.join(" "), &path, stroke);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_but_rods_has_a_style() {
        let missing: Vec<_> =
            Kind::ALL.iter().filter(|kind| !STYLES.iter().any(|style| style.kinds.contains(kind))).collect();
        assert_eq!(missing, [&Kind::Rod]);
    }
}

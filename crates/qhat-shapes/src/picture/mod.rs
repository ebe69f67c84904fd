//! A still as SVG: layers from back to front, each in its own file.
//!
//! Sizes of glyphs and text are those of the page at a window of 1200 × 800. A picture of another size has the same
//! layout in its own units, see [`Options::size`].

mod bounds;
mod camera;
mod curves;
mod frame;
mod glyphs;
mod links;
mod number;
mod palette;
mod particles;
mod path;
mod pen;
mod styles;
mod surfaces;
#[cfg(test)]
mod tests;
mod vector;
mod view;

use pen::Pen;
use qhat::{Gravity, Simulation, State, System};
use view::View;

/// The content of a still.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// The system, whose constraints and forces are drawn.
    pub system: &'a System,
    /// The state with the positions of the particles.
    pub state: &'a State,
    /// The time in the title, at which driven shapes are drawn \[s\].
    pub time: f64,
    /// The tension of every link \[N\], in the order of [`System::links`]; a number that is not finite means that the
    /// tension is not known.
    pub tension: &'a [f64],
    /// The places of broken links in [`System::links`].
    pub broken: &'a [usize],
    /// The title.
    pub name: &'a str,
    /// A note beside the time, for facts that a reader must know about this state; may be empty.
    pub note: &'a str,
}

impl<'a> Picture<'a> {
    /// The present state of a simulation, with the tensions and broken links that [`Reading::of`] found.
    pub fn new(simulation: &'a Simulation, reading: &'a Reading, name: &'a str) -> Self {
        let (system, state) = (simulation.system(), simulation.state());
        Picture {
            system,
            state,
            time: state.time(),
            tension: &reading.tension,
            broken: &reading.broken,
            name,
            note: "",
        }
    }
}

/// Options of a still: size and theme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Width and height \[px\]. Text and glyphs grow and shrink with the picture, but not below three quarters of their
    /// usual size.
    pub size: [u32; 2],
    /// Whether strokes are light on a dark background.
    pub dark: bool,
}

impl Default for Options {
    fn default() -> Self {
        Options { size: [1200, 800], dark: false }
    }
}

impl Options {
    /// The least width and height \[px\]; title and legend need this much.
    pub const LEAST: u32 = 240;
    /// The largest width and height of a PNG \[px\]: a PNG of this size takes 256 MiB while it is drawn.
    pub const MOST: u32 = 8192;
}

/// A copy of the tensions and broken links of a running simulation, for a still.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The tension of every link \[N\].
    pub tension: Vec<f64>,
    /// The places of broken links.
    pub broken: Vec<usize>,
}

impl Reading {
    /// Reads the tensions and broken links of the present state of a simulation.
    pub fn of(simulation: &mut Simulation) -> Self {
        let tension = simulation.tension();
        Reading { tension, broken: simulation.system().broken_links(simulation.state()) }
    }
}

/// A still as an SVG document of its own, with the same bytes for the same picture and options.
///
/// Every particle and every link carries its name and tension as a title, which a browser shows under the pointer.
/// Text is in the font Inter if the reader of the SVG has it, else in the sans-serif font of the reader.
pub fn svg(picture: &Picture<'_>, options: &Options) -> String {
    let shapes = crate::list::shapes_at(picture.system, picture.state, picture.time);
    let view = View::new(picture, options, &shapes);
    let mut pen = Pen::new(view.palette.canvas);
    pen.open_document(picture.name, options.size, view.camera.size);
    frame::draw_background(&view, &mut pen);
    styles::draw(&view, &mut pen);
    links::draw(&view, &mut pen);
    particles::draw(&view, &mut pen);
    frame::draw_labels(&view, &mut pen);
    pen.finish()
}

/// The acceleration of gravity \[m/s²\]; zero if the system has no gravity.
fn gravity(system: &System) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for force in system.forces() {
        if let qhat::Force::Gravity(Gravity { acceleration }) = force {
            sum = vector::plus(sum, *acceleration);
        }
    }
    sum
}

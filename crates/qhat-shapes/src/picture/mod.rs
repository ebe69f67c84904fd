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

/// What a still shows.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// The system, whose constraints and forces are drawn.
    pub system: &'a System,
    /// Where its particles are, and the time in the title.
    pub state: &'a State,
    /// The time in the title, and of driven shapes \[s\].
    pub time: f64,
    /// The tension of every link \[N\], in the order of [`System::links`]; a number that is not finite is not known.
    pub tension: &'a [f64],
    /// The places of broken links in [`System::links`].
    pub broken: &'a [usize],
    /// The title.
    pub name: &'a str,
    /// Words beside the time, for what a reader must know of this state; may be empty.
    pub note: &'a str,
}

impl<'a> Picture<'a> {
    /// A simulation as it is, with the tensions and broken links that [`Reading::of`] found.
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

/// How a still is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Width and height \[px\]. Text and glyphs grow with the picture, and shrink with it to three quarters at most.
    pub size: [u32; 2],
    /// Light strokes on a dark background.
    pub dark: bool,
}

impl Default for Options {
    fn default() -> Self {
        Options { size: [1200, 800], dark: false }
    }
}

impl Options {
    /// The least width and height at which title and legend have room \[px\].
    pub const LEAST: u32 = 240;
    /// The largest width and height \[px\]: a PNG of this size takes 256 MiB while it is drawn.
    pub const MOST: u32 = 8192;
}

/// The parts of a running simulation that a still shows, with tensions and broken links of their own.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The tension of every link \[N\].
    pub tension: Vec<f64>,
    /// The places of broken links.
    pub broken: Vec<usize>,
}

impl Reading {
    /// Asks a simulation for the tensions and broken links of its state.
    pub fn of(simulation: &mut Simulation) -> Self {
        let tension = simulation.tension();
        Reading { tension, broken: simulation.system().broken_links(simulation.state()) }
    }
}

/// A still as an SVG document of its own, with the same bytes for the same picture and options.
///
/// Every particle and every link carries its name and tension as a title, which a browser shows under the pointer.
/// Text is in the font Inter where the reader has it, else in the reader's sans-serif font.
pub fn svg(picture: &Picture<'_>, options: &Options) -> String {
    let shapes = crate::list::shapes_at(picture.system, picture.state, picture.time);
    let view = View::new(picture, options, &shapes);
    let mut pen = Pen::new();
    pen.open_document(picture.name, options.size, view.camera.size);
    frame::draw_background(&view, &mut pen);
    styles::draw(&view, &mut pen);
    links::draw(&view, &mut pen);
    particles::draw(&view, &mut pen);
    frame::draw_labels(&view, &mut pen);
    pen.finish()
}

/// The acceleration of gravity \[m/s²\]; zero without.
fn gravity(system: &System) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for force in system.forces() {
        if let qhat::Force::Gravity(Gravity { acceleration }) = force {
            sum = vector::plus(sum, *acceleration);
        }
    }
    sum
}

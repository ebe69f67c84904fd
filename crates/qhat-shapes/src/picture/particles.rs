//! Particles: a free particle is a ball whose size shows its mass, a fixed particle is a square.

use super::path::number;
use super::pen::Pen;
use super::view::{RADII, View};

pub(super) fn draw(view: &View<'_>, pen: &mut Pen) {
    let system = view.picture.system;
    let mut order: Vec<usize> = (0..system.particle_count()).collect();
    if view.camera.dimension == 3 {
        order.sort_by(|&i, &k| view.screen[i][2].total_cmp(&view.screen[k][2]));
    }
    pen.open("g", &[("class", "particles"), ("fill", view.palette.particle), ("stroke", view.palette.canvas)]);
    for i in order {
        let fixed = system.inverse_masses()[i] == 0.0;
        let radius = view.radii[i];
        if view.crowded && !fixed && radius == RADII[0] {
            continue;
        }
        let [x, y, _] = view.screen[i];
        let name = &system.particle_names()[i];
        // The rim of a small ball is thinner, so that it does not hide the ball.
        let rim = number((0.25 * radius).clamp(0.0, 1.5));
        if fixed {
            let half = radius + 1.0;
            let [x, y, side] = [x - half, y - half, 2.0 * half].map(number);
            let attributes = [("x", &x), ("y", &y), ("width", &side), ("height", &side), ("stroke-width", &rim)];
            pen.titled("rect", &attributes.map(|(name, value)| (name, value.as_str())), name);
        } else {
            let [x, y, radius] = [x, y, radius].map(number);
            let attributes = [("cx", &x), ("cy", &y), ("r", &radius), ("stroke-width", &rim)];
            pen.titled("circle", &attributes.map(|(name, value)| (name, value.as_str())), name);
        }
    }
    pen.close("g");
}

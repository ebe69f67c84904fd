//! Colours, with the names and values of the page (playground/src/style/colours.css). A picture has no style sheet to
//! read them from, so they stand here a second time, and a test compares the two.
//!
//! Tension is blue and compression orange. People with any common kind of colour blindness can tell the two apart, and
//! both differ in lightness from the grey of a link without load.

/// The colours of one theme.
#[derive(Debug)]
pub(super) struct Palette {
    pub(super) canvas: &'static str,
    pub(super) grid: &'static str,
    pub(super) ink: &'static str,
    pub(super) outline: &'static str,
    /// The colour of wires and rails, nearer to the background than the colours of moving parts.
    pub(super) guide: &'static str,
    pub(super) accent: &'static str,
    pub(super) particle: &'static str,
    pub(super) spring: &'static str,
    push: [u8; 3],
    slack: [u8; 3],
    pull: [u8; 3],
}

pub(super) const LIGHT: Palette = Palette {
    canvas: "#f6f5f1",
    grid: "#e7e5de",
    ink: "#1c2126",
    outline: "#6a7078",
    guide: "#a9aca9",
    accent: "#0b7a66",
    particle: "#262c33",
    spring: "#767c85",
    push: [201, 88, 10],
    slack: [168, 172, 178],
    pull: [22, 92, 204],
};

pub(super) const DARK: Palette = Palette {
    canvas: "#12161b",
    grid: "#1e242b",
    ink: "#e8ebee",
    outline: "#929ba6",
    guide: "#6b7682",
    accent: "#46d0ae",
    particle: "#e8ebee",
    spring: "#848d98",
    push: [255, 158, 66],
    slack: [92, 100, 110],
    pull: [96, 172, 255],
};

/// Steps of the scale; odd, so that zero has a colour of its own.
pub(super) const STEPS: usize = 41;

impl Palette {
    /// The colour of a tension \[N\] on a scale of `limit` \[N\] each way; grey where the tension is not known.
    pub(super) fn tension(&self, tension: f64, limit: f64) -> String {
        self.step(step(tension, limit))
    }

    /// The colours of the scale, from full compression over slack to full tension.
    pub(super) fn scale(&self) -> impl Iterator<Item = String> + '_ {
        (0..STEPS).map(|step| self.step(step))
    }

    fn step(&self, step: usize) -> String {
        let part = 2.0 * step as f64 / (STEPS - 1) as f64 - 1.0;
        let end = if part < 0.0 { self.push } else { self.pull };
        // A square root lifts weak colours off the grey; the sign and the order stay.
        let weight = part.abs().sqrt();
        let [r, g, b]: [u8; 3] = std::array::from_fn(|k| {
            let (from, to) = (f64::from(self.slack[k]), f64::from(end[k]));
            (from + (to - from) * weight).round() as u8
        });
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

fn step(tension: f64, limit: f64) -> usize {
    let middle = ((STEPS - 1) / 2) as f64;
    let part = if tension.is_finite() && limit > 0.0 { (tension / limit).clamp(-1.0, 1.0) } else { 0.0 };
    (middle + middle * part).round() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The light and the dark value of a colour of the page.
    fn on_the_page(name: &str) -> [&'static str; 2] {
        let sheet = include_str!("../../../../playground/src/style/colours.css");
        let start = format!("--{name}: light-dark(");
        let line = sheet.lines().find_map(|line| line.trim().strip_prefix(&start)).expect(name);
        let values = line.strip_suffix(");").and_then(|values| values.split_once(", "));
        values.map(|(light, dark)| [light, dark]).expect(name)
    }

    #[test]
    fn every_colour_is_that_of_the_page() {
        for (palette, theme) in [(LIGHT, 0), (DARK, 1)] {
            let Palette { canvas, grid, ink, outline, guide, accent, particle, spring, push, slack, pull } = palette;
            let texts = [
                ("canvas", canvas),
                ("grid", grid),
                ("ink", ink),
                ("outline", outline),
                ("guide", guide),
                ("accent", accent),
                ("particle", particle),
                ("spring", spring),
            ];
            for (name, colour) in texts {
                assert_eq!(colour, on_the_page(name)[theme], "{name}");
            }
            for (name, [r, g, b]) in [("push", push), ("slack", slack), ("pull", pull)] {
                assert_eq!(format!("#{r:02x}{g:02x}{b:02x}"), on_the_page(name)[theme], "{name}");
            }
        }
    }
}

//! Colours, the same as on the page (`playground/src/style/colours.css`); `playground/tests/unit/palette.test.ts`
//! compares both.
//!
//! Tension is blue and compression orange. People with any common kind of colour blindness can tell the two apart, and
//! both differ in lightness from the grey of a link without load.

/// The colours of one theme.
#[derive(Debug)]
pub(super) struct Palette {
    pub(super) background: &'static str,
    pub(super) grid: &'static str,
    pub(super) ink: &'static str,
    pub(super) muted: &'static str,
    /// The colour of wires and rails, nearer to the background than the colours of moving parts.
    pub(super) guide: &'static str,
    pub(super) accent: &'static str,
    pub(super) particle: &'static str,
    pub(super) spring: &'static str,
    compression: [u8; 3],
    slack: [u8; 3],
    pull: [u8; 3],
}

pub(super) const LIGHT: Palette = Palette {
    background: "#f6f5f1",
    grid: "#e7e5de",
    ink: "#1c2126",
    muted: "#6a7078",
    guide: "#a9aca9",
    accent: "#0b7a66",
    particle: "#262c33",
    spring: "#767c85",
    compression: [201, 88, 10],
    slack: [168, 172, 178],
    pull: [22, 92, 204],
};

pub(super) const DARK: Palette = Palette {
    background: "#12161b",
    grid: "#1e242b",
    ink: "#e8ebee",
    muted: "#929ba6",
    guide: "#6b7682",
    accent: "#46d0ae",
    particle: "#e8ebee",
    spring: "#848d98",
    compression: [255, 158, 66],
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
        let end = if part < 0.0 { self.compression } else { self.pull };
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

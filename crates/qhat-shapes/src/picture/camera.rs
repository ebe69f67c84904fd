//! The camera: maps points of the scene \[m\] to the picture \[px\], without perspective. A scene in the plane is seen
//! from the front.

use super::path::Spot;
use super::vector::{Vec3, dot, minus, plus, scaled};

/// The angles by which the view of a scene in space is turned about the vertical and tilted \[rad\], as on the page.
const ORBIT: [f64; 2] = [-0.6, 0.35];
/// The part of the free area that a scene in the plane fills.
const FIT: f64 = 0.94;

/// The least and the largest scale \[px/m\]. Beyond them products of lengths overflow or underflow.
const SCALES: [f64; 2] = [1e-100, 1e100];

/// The margins that title and legend cover on each side \[px\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Inset {
    pub(super) side: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
}

/// A view without perspective.
#[derive(Clone, Debug)]
pub(super) struct Camera {
    pub(super) dimension: usize,
    /// Width and height of the layout \[px\].
    pub(super) size: [f64; 2],
    /// The scale \[px/m\].
    pub(super) scale: f64,
    /// The point of the scene in the middle of the free area \[m\].
    pub(super) centre: Vec3,
    pub(super) middle: Spot,
    pub(super) right: Vec3,
    pub(super) up: Vec3,
    /// The unit vector towards the viewer.
    pub(super) towards: Vec3,
}

impl Camera {
    /// A camera that shows all of these points. Up is against gravity, along y or along z.
    pub(super) fn new(dimension: usize, gravity: Vec3, size: [f64; 2], inset: Inset, points: &[Vec3]) -> Self {
        let [right, up, towards] = axes(dimension, gravity);
        let room = [size[0] - 2.0 * inset.side, size[1] - inset.top - inset.bottom];
        let middle = [0.5 * size[0], inset.top + 0.5 * room[1]];
        let along = |axis: Vec3| {
            let places = points.iter().map(|&point| dot(point, axis)).filter(|place| place.is_finite());
            places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| [low.min(place), high.max(place)])
        };
        let [x, y, z] = [right, up, towards].map(along);
        let halfway = |[low, high]: [f64; 2]| if low <= high { 0.5 * low + 0.5 * high } else { 0.0 };
        let extent = [x, y].map(|[low, high]| if low < high { high - low } else { 0.0 });
        let largest = extent[0].max(extent[1]);
        let fitted = [0, 1].map(|k: usize| FIT * room[k].max(40.0) / extent[k].max(1e-9 * largest));
        // A single particle has no extent. Its scale shows a metre as a fifth of the free area.
        let lone = room[0].min(room[1]).max(40.0) / 5.0;
        let scale = if largest < 1e-12 { lone } else { fitted[0].min(fitted[1]).clamp(SCALES[0], SCALES[1]) };
        let across = plus(scaled(right, halfway(x)), scaled(up, halfway(y)));
        let centre = plus(across, scaled(towards, halfway(z)));
        Camera { dimension, size, scale, centre, middle, right, up, towards }
    }

    /// x and y \[px\], and depth towards the viewer \[m\].
    pub(super) fn place(&self, point: Vec3) -> [f64; 3] {
        let away = minus(point, self.centre);
        let [x, y] = [dot(self.right, away), dot(self.up, away)];
        [self.middle[0] + self.scale * x, self.middle[1] - self.scale * y, dot(self.towards, away)]
    }

    pub(super) fn spot(&self, point: Vec3) -> Spot {
        let [x, y, _] = self.place(point);
        [x, y]
    }

    /// The vector in the picture \[px\] of a vector of the scene \[m\].
    pub(super) fn direction(&self, along: Vec3) -> Spot {
        [self.scale * dot(self.right, along), -self.scale * dot(self.up, along)]
    }

    /// The distance from the middle beyond which every point is outside the picture \[px\].
    pub(super) fn reach(&self) -> f64 {
        self.size[0] + self.size[1]
    }
}

/// The unit vectors to the right, up and towards the viewer.
fn axes(dimension: usize, gravity: Vec3) -> [Vec3; 3] {
    if dimension == 2 {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    }
    let y_up = gravity[1].abs() > gravity[2].abs();
    // The axes are made for y up, and turned if z is up.
    let oriented = |[x, y, z]: Vec3| if y_up { [x, y, z] } else { [x, -z, y] };
    let [[cy, sy], [cp, sp]] = ORBIT.map(|angle| [angle.cos(), angle.sin()]);
    [[cy, 0.0, -sy], [-sy * sp, cp, -cy * sp], [sy * cp, sp, cy * cp]].map(oriented)
}

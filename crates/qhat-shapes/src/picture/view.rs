//! One still, ready to draw: where everything is in the picture, and how large glyphs are.

use super::camera::{Camera, Inset};
use super::number::nice_ceiling;
use super::palette::{DARK, LIGHT, Palette};
use super::path::Spot;
use super::vector::{Vec3, dot, minus, norm, scaled};
use super::{Options, Picture, bounds, gravity};
use crate::shape::Shape;

/// The size at which glyphs and text are as on the page \[px\].
const USUAL: [f64; 2] = [1200.0, 800.0];
/// A small picture gets glyphs and text of at least this many times their size on the page: smaller text is not read.
const LEAST_ZOOM: f64 = 0.75;
/// Room around a scene \[px\].
const INSET: Inset = Inset { side: 44.0, top: 88.0, bottom: 92.0 };

/// A usual ball's radius is at most this part of a mean rod in the picture.
const ROD_SHARE: f64 = 0.22;
/// The radius of the smallest and of the largest ball \[px\].
pub(super) const RADII: [f64; 2] = [1.5, 18.0];
/// Below this largest tension \[N\] all of them are rounding.
const ROUNDING: f64 = 1e-12;

/// What all layers draw from.
pub(super) struct View<'a> {
    pub(super) picture: &'a Picture<'a>,
    pub(super) shapes: &'a [Shape],
    pub(super) palette: &'static Palette,
    pub(super) camera: Camera,
    /// Where particles are in the scene \[m\]; z = 0 in two dimensions.
    pub(super) places: Vec<Vec3>,
    /// x, y \[px\] and depth \[m\] of every particle.
    pub(super) screen: Vec<[f64; 3]>,
    /// Of every particle \[px\].
    pub(super) radii: Vec<f64>,
    /// Whether rods are so short that the smallest balls would touch and hide them all.
    pub(super) crowded: bool,
    /// The way things fall, a unit vector; zero where nothing falls.
    pub(super) down: Vec3,
    /// N at the ends of the scale of colours.
    pub(super) limit: f64,
    broken: Vec<bool>,
}

impl<'a> View<'a> {
    pub(super) fn new(picture: &'a Picture<'a>, options: &Options, shapes: &'a [Shape]) -> Self {
        let system = picture.system;
        let d = system.dimension();
        let component = |place: &[f64], k: usize| place.get(k).copied().unwrap_or(0.0);
        let places: Vec<Vec3> =
            picture.state.positions().chunks(d).map(|x| [0, 1, 2].map(|k| component(x, k))).collect();
        let asked = options.size.map(f64::from);
        let zoom = (asked[0] / USUAL[0]).min(asked[1] / USUAL[1]).max(LEAST_ZOOM);
        let fall = gravity(system);
        let points = bounds::points(picture, &places, shapes);
        let camera = Camera::new(d, fall, asked.map(|length| length / zoom), INSET, &points);
        let screen = places.iter().map(|&place| camera.place(place)).collect();
        let size = norm(fall);
        let (radii, crowded) = radii(picture, &camera);
        let mut broken = vec![false; picture.tension.len()];
        for &place in picture.broken {
            if let Some(link) = broken.get_mut(place) {
                *link = true;
            }
        }
        let loudest = picture.tension.iter().filter(|t| t.is_finite()).fold(0.0f64, |most, t| most.max(t.abs()));
        View {
            picture,
            shapes,
            palette: if options.dark { &DARK } else { &LIGHT },
            camera,
            places,
            screen,
            radii,
            crowded,
            down: if size > 0.0 { scaled(fall, 1.0 / size) } else { [0.0; 3] },
            limit: nice_ceiling(if loudest > ROUNDING { loudest } else { 0.0 }),
            broken,
        }
    }

    /// Where a particle is in the picture.
    pub(super) fn spot(&self, particle: qhat::ParticleId) -> Spot {
        let [x, y, _] = self.screen[particle.index()];
        [x, y]
    }

    /// The two ends of a shape: particles first, then points.
    pub(super) fn ends(&self, shape: &Shape) -> [Spot; 2] {
        let particles = shape.particles.iter().map(|&particle| self.spot(particle));
        let mut all = particles.chain(shape.points.iter().map(|&point| self.camera.spot(point)));
        let first = all.next().unwrap_or_default();
        [first, all.next().unwrap_or(first)]
    }

    /// How far apart the two particles of a shape are \[m\].
    pub(super) fn distance(&self, shape: &Shape) -> f64 {
        let [a, b] = [0, 1].map(|k: usize| self.places[shape.particles[k].index()]);
        norm(minus(a, b))
    }

    /// The tension of a link \[N\].
    pub(super) fn tension(&self, place: usize) -> f64 {
        self.picture.tension.get(place).copied().unwrap_or(f64::NAN)
    }

    pub(super) fn is_broken(&self, shape: &Shape) -> bool {
        shape.link.is_some_and(|place| self.broken.get(place) == Some(&true))
    }

    pub(super) fn links(&self) -> impl Iterator<Item = (&Shape, usize)> {
        self.shapes.iter().filter_map(|shape| Some((shape, shape.link?)))
    }

    /// The depth of the farthest particle and how much nearer the nearest is \[m\].
    pub(super) fn depths(&self) -> [f64; 2] {
        let depths = self.screen.iter().map(|place| place[2]);
        let [far, near] = depths.fold([f64::INFINITY, f64::NEG_INFINITY], |[far, near], z| [far.min(z), near.max(z)]);
        [far, near - far]
    }
}

/// How far the middle of a slack rope of a length hangs below the middle of its ends \[m\].
///
/// A slack rope hangs in a parabola with about its length L: the sag f of a flat one over d is √(3 d (L − d)/8), of a
/// folded one L/2, and √(3 (L² − d²))/4 is the first and near the second.
pub(super) fn sag(length: f64, apart: Vec3) -> f64 {
    (3.0 * (length * length - dot(apart, apart)).max(0.0)).sqrt() / 4.0
}

/// Radii grow with the cube root of the mass, as balls of one stuff do. Crowded scenes get smaller balls, and balls
/// never hide the rods between them.
fn radii(picture: &Picture<'_>, camera: &Camera) -> (Vec<f64>, bool) {
    let [least, largest] = RADII;
    let rods = picture.system.links().filter(|link| link.is_rod()).filter_map(|link| link.longest);
    let (count, sum) = rods.fold((0, 0.0), |(count, sum), length| (count + 1, sum + length));
    let shown = if count > 0 { camera.scale * sum / f64::from(count) } else { f64::INFINITY };
    let masses = picture.system.masses();
    let usual_radius = match masses.len() {
        0..=20 => 6.0,
        21..=60 => 4.5,
        61..=300 => 3.5,
        _ => 2.0,
    };
    let base = f64::min(usual_radius, (ROD_SHARE * shown).max(least));
    let mut sorted = masses.to_vec();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() / 2).copied().filter(|mass| *mass > 0.0).unwrap_or(1.0);
    let radius = |mass: &f64| (base * (mass / usual).cbrt()).clamp(least, largest);
    (masses.iter().map(radius).collect(), shown < 2.0 * least)
}

/// The width of links \[px\].
pub(super) fn link_width(count: usize) -> f64 {
    match count {
        0..=60 => 3.5,
        61..=300 => 2.75,
        _ => 2.0,
    }
}

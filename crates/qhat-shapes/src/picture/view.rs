//! The view of one still: the positions of all particles in the picture, and the sizes of glyphs.

use super::camera::{Camera, Inset};
use super::number::nice_ceiling;
use super::palette::{DARK, LIGHT, Palette};
use super::path::Spot;
use super::vector::{Vec3, dot, minus, norm, scaled};
use super::{Options, Picture, bounds, gravity};
use crate::shape::Shape;

/// The size of a picture whose glyphs and text have the same size as on the page \[px\].
const USUAL: [f64; 2] = [1200.0, 800.0];
/// Least size of glyphs and text in small pictures, relative to their size on the page. Smaller text is not readable.
const LEAST_ZOOM: f64 = 0.75;
/// Margins around a scene \[px\].
const INSET: Inset = Inset { side: 44.0, top: 88.0, bottom: 92.0 };

/// Largest radius of a ball of median mass, relative to the mean length of a rod in the picture.
const ROD_SHARE: f64 = 0.22;
/// The radius of the smallest and of the largest ball \[px\].
pub(super) const RADII: [f64; 2] = [1.5, 18.0];
/// If the largest tension is below this \[N\], all tensions count as roundoff.
const ROUNDING: f64 = 1e-12;

/// The data that all layers draw from.
pub(super) struct View<'a> {
    pub(super) picture: &'a Picture<'a>,
    pub(super) shapes: &'a [Shape],
    pub(super) palette: &'static Palette,
    pub(super) camera: Camera,
    /// Positions of the particles in the scene \[m\]; z = 0 in two dimensions.
    pub(super) places: Vec<Vec3>,
    /// Positions in the picture: x, y \[px\] and depth \[m\] of every particle.
    pub(super) screen: Vec<[f64; 3]>,
    /// The radius of every particle \[px\].
    pub(super) radii: Vec<f64>,
    /// Whether rods are so short in the picture that the smallest balls would touch and hide them.
    pub(super) crowded: bool,
    /// The unit vector of gravity; zero without gravity.
    pub(super) down: Vec3,
    /// The tension at the end of the scale of colours \[N\].
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

    /// The position of a particle in the picture.
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

    /// The distance of the two particles of a shape \[m\].
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

    /// The depth of the farthest particle, and the difference to the depth of the nearest \[m\].
    pub(super) fn depths(&self) -> [f64; 2] {
        let depths = self.screen.iter().map(|place| place[2]);
        let [far, near] = depths.fold([f64::INFINITY, f64::NEG_INFINITY], |[far, near], z| [far.min(z), near.max(z)]);
        [far, near - far]
    }
}

/// The sag of a slack rope \[m\]: the distance of its middle below the middle of its ends.
///
/// A slack rope is drawn as a parabola of about its length L over the distance d of its ends. The sag is √(3 d (L −
/// d)/8) if L is close to d, and L/2 at d = 0. The formula √(3 (L² − d²))/4 agrees with the first and is near the
/// second.
pub(super) fn sag(length: f64, apart: Vec3) -> f64 {
    (3.0 * (length * length - dot(apart, apart)).max(0.0)).sqrt() / 4.0
}

/// The radii of balls, and whether rods are too short to be seen between them. A radius grows with the cube root of the
/// mass, as for balls of one material. Scenes with many particles or short rods get smaller balls.
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

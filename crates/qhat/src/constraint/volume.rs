//! Volume: a tetrahedron, or any closed surface of triangles, keeps its volume V(t), which may be driven. In space.
//!
//! ```text
//! a, b, c   the corners of each face, counted from x_0
//! C = Σ a·(b × c)/6 − V(t)           [m³],  λ: the pressure inside [Pa]
//! ∂C/∂a = Σ (b × c)/6 over the faces at a, turned so that a comes first
//! C_t = −V̇
//! ```
//!
//! V is positive where the corners of a face run counterclockwise as seen from outside. The surface must be closed:
//! each side belongs to two faces that run along it in opposite directions. Then neither C nor its gradient depends
//! on the point that positions count from. Fails where all corners lie on one line or at one point, because the
//! gradient vanishes there.

use super::error::ConstraintError;
use super::smooth::{At, Gradient, LONG, Residual, Smooth};
use crate::driven::Driven;
use crate::number::{Number, cross, dot, minus, norm, plus, raised};
use crate::point::Motion;
use crate::space::ParticleId;
use std::collections::HashSet;

/// A closed surface that keeps its volume, in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// The corners of the surface, each once.
    particles: Vec<ParticleId>,
    /// The corners of each face, as indices into `particles`.
    faces: Vec<[usize; 3]>,
    /// For each particle and each face at it: the other two corners of the face, in order.
    around: Vec<Vec<[usize; 2]>>,
    pub(crate) volume: Driven,
}

impl Volume {
    /// A closed surface of triangles that encloses V \[m³\].
    pub fn new(triangles: &[[ParticleId; 3]], volume: impl Into<Driven>) -> Self {
        let mut particles: Vec<ParticleId> = triangles.iter().flatten().copied().collect();
        particles.sort_unstable();
        particles.dedup();
        let place = |id: ParticleId| particles.binary_search(&id).expect("it was put there");
        let faces: Vec<[usize; 3]> = triangles.iter().map(|corners| corners.map(place)).collect();
        let mut around = vec![Vec::new(); particles.len()];
        for &[a, b, c] in &faces {
            around[a].push([b, c]);
            around[b].push([c, a]);
            around[c].push([a, b]);
        }
        Volume { particles, faces, around, volume: volume.into() }
    }

    /// The faces, each as its three corners.
    pub fn triangles(&self) -> impl Iterator<Item = [ParticleId; 3]> + '_ {
        self.faces.iter().map(|corners| corners.map(|corner| self.particles[corner]))
    }

    /// A tetrahedron with (b − a)·((c − a) × (d − a))/6 = V \[m³\].
    pub fn tetrahedron([a, b, c, d]: [ParticleId; 4], volume: impl Into<Driven>) -> Self {
        Volume::new(&[[a, c, b], [a, b, d], [a, d, c], [b, c, d]], volume)
    }
}

impl Smooth for Volume {
    const ONLY_IN: Option<usize> = Some(3);

    fn particle(&self, i: usize) -> Option<ParticleId> {
        self.particles.get(i).copied()
    }

    fn row<N: Number, const D: usize>(&self, _: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        const SIXTH: f64 = 1.0 / 6.0;
        let (volume, rate) = self.volume.at(at.t);
        let origin = at.x(0);
        let place = |i: usize| raised(minus(at.x(i), origin));
        let mut six_fold = N::constant(0.0);
        for &[a, b, c] in &self.faces {
            six_fold = six_fold + dot(place(a), cross(place(b), place(c)));
        }
        for faces in &self.around {
            let mut sum = [N::constant(0.0); 3];
            for &[b, c] in faces {
                sum = plus(sum, cross(place(b), place(c)));
            }
            gradient.push(std::array::from_fn(|k| sum[k].times(SIXTH)));
        }
        Residual { C: six_fold.times(SIXTH) - volume, C_t: -rate }
    }

    fn scale(&self, extent: f64) -> f64 {
        self.volume.value(0.0).abs().max(extent * extent * extent)
    }

    /// The blocks of two corners b, c of the faces around a particle are ⅙ [x]× of the third corner. In a closed mesh
    /// the faces at an edge leave differences of corners, so that ⅙ Σ |x_c − x_b| √2 bounds the sum of a column.
    fn curvature_bound<const D: usize>(&self, motion: Motion<'_, D>) -> Option<f64> {
        if self.particles.len() <= LONG {
            return None;
        }
        let x = |i: usize| raised(motion.x(self.particles[i]));
        let around = |i: usize, faces: &Vec<[usize; 2]>| -> f64 {
            let reach = |&[b, c]: &[usize; 2]| norm(minus(x(b), x(i))) + norm(minus(x(c), x(i)));
            faces.iter().map(reach).sum::<f64>() * std::f64::consts::SQRT_2 / 6.0
        };
        Some(self.around.iter().enumerate().map(|(i, faces)| around(i, faces)).fold(0.0, f64::max))
    }

    fn check(&self) -> Result<(), ConstraintError> {
        let mut sides = HashSet::new();
        for (face, &[a, b, c]) in self.faces.iter().enumerate() {
            if a == b || b == c || c == a {
                return Err(ConstraintError::FaceCorners { face });
            }
            if ![[a, b], [b, c], [c, a]].into_iter().all(|side| sides.insert(side)) {
                return Err(ConstraintError::FaceTurned { face });
            }
        }
        if self.faces.is_empty() || sides.iter().any(|&[a, b]| !sides.contains(&[b, a])) {
            return Err(ConstraintError::NotClosed);
        }
        Ok(self.volume.check("a volume")?)
    }
}

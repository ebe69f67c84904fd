//! Projection of the velocities of a step onto Ċ = 0, in the metric of the step's own matrix M + h_e² K.
//!
//! The factor of that matrix is at hand, and a particle on a tight rod hardly moves sideways in its metric, as it would
//! in the metric of M alone.

use super::newton::{Base, Newton, Tried};
use crate::energy;
use crate::point::{Motion, block, dot, larger, largest};

/// Passes of one projection. The factor belongs to a q near by: each pass gains as many digits as J has in common
/// there, four or more.
const PASSES: usize = 4;

/// |Ċ|, relative to the speed of the fastest particle over the extent, below which it is roundoff.
const CONSISTENT: f64 = 1e-13;

/// Change of q̇ over |Ċ| and the extent, and over the speed of the fastest particle, above which Ċ says nothing of the
/// change: where cranks pass the line of their pivots the two ratios are 40 to 750 and 0.75 to 2. In shipped scenes,
/// at their h and at five times h, a second ratio above 0.5 comes with a first of at most 4.5; the heavy end of a
/// chain has a first of up to 61, with a second of up to 0.25.
const ILL_DETERMINED: f64 = 10.0;
const TURNED: f64 = 0.5;

impl Newton {
    /// Takes Ċ out of q̇. `is_factored` says whether this step has factored its matrix. Returns the work of the drives
    /// in the projection [J].
    pub(super) fn project_velocities<const D: usize>(
        &mut self,
        base: &Base,
        mut is_factored: bool,
        tried: &mut Tried<'_>,
    ) -> f64 {
        let system = tried.system;
        let fastest = largest(tried.qd);
        let mut drives = 0.0;
        for _ in 0..PASSES {
            self.r.fill(0.0);
            let mut worst = 0.0_f64;
            let (rows, qd) = (&tried.equation.rows, &*tried.qd);
            for row in 0..self.s.len() {
                let is_active = !self.matrix.graph.idle[row] && system.softness[row].is_rigid();
                let entries = system.layout.start[row]..system.layout.start[row + 1];
                let terms = entries.map(|e| dot(rows.J.entry::<D>(e), block(qd, system.layout.particle[e])));
                let rate = terms.sum::<f64>() + rows.Ct[row];
                self.s[row] = if is_active { -rate } else { 0.0 };
                worst = larger(worst, self.s[row].abs() * self.per_scale[row]);
            }
            if worst * system.extent <= CONSISTENT * fastest {
                break;
            }
            if !is_factored {
                is_factored = self.factor::<D>(base, tried);
            }
            if !is_factored {
                break;
            }
            self.matrix.solve::<D>(system, &mut self.r, &mut self.s);
            let change = largest(&self.r);
            // Near a position where the rank drops, Ċ hardly sees a direction in which q̇ is ill determined, and its
            // correction would turn the motion onto another branch.
            if change > ILL_DETERMINED * worst * system.extent && change > TURNED * fastest {
                break;
            }
            // s is the impulse with the opposite sign.
            drives -= energy::drive_power(system, &tried.equation.rows.Ct, &self.s);
            for (id, change) in self.matrix.graph.particle.iter().zip(self.r.chunks_exact(D)) {
                for (v, change) in tried.qd[id.0 * D..][..D].iter_mut().zip(change) {
                    *v += change;
                }
            }
        }
        tried.equation.constrain(system, Motion::<D> { q: tried.q, qd: tried.qd, t: base.end });
        drives
    }
}

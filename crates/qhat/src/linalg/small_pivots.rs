//! SmallPivots: the course of a factorization at a pivot that is too small to divide by.

/// The answer to a small pivot, and the record of those that were met.
#[derive(Debug)]
pub(crate) struct SmallPivots<'a> {
    /// Added to the diagonal, except for unknowns of hubs.
    pub(crate) shift: f64,
    /// A pivot up to this number is small.
    pub(crate) below: f64,
    /// The pivot that takes the place of a small one; `None` ends the factorization. An infinite pivot leaves the
    /// unknown out: its column of L is zero, its row is never subtracted from another, and every solution is zero
    /// there.
    pub(crate) instead: Option<f64>,
    /// The places of the small pivots in the order of elimination, and their values.
    pub(crate) met: &'a mut Vec<(usize, f64)>,
}

impl SmallPivots<'_> {
    /// The pivot to divide by at place k; `None` where the factorization ends.
    #[cold]
    pub(super) fn pivot_instead(&mut self, k: usize, pivot: f64) -> Option<f64> {
        let instead = self.instead.filter(|_| !pivot.is_nan())?;
        self.met.push((k, pivot));
        Some(instead)
    }
}

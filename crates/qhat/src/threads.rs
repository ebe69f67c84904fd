//! Work on several threads, where there are any: natively with the feature `rayon`; else, and in the browser, one thing after
//! the other.
//!
//! Only what does not depend on each other is handed out, cut the same way on any number of threads, so the bits do not depend
//! on it. `RAYON_NUM_THREADS=1` keeps everything on one.

/// Does both, perhaps at the same time.
pub(crate) fn both<A: Send, B: Send>(one: impl FnOnce() -> A + Send, other: impl FnOnce() -> B + Send) -> (A, B) {
    #[cfg(all(feature = "rayon", not(target_family = "wasm")))]
    return rayon::join(one, other);
    #[cfg(not(all(feature = "rayon", not(target_family = "wasm"))))]
    return (one(), other());
}

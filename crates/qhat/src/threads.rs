//! Work on several threads, where there are any: natively with the feature `rayon`; else, and in the browser, one thing
//! after the other.
//!
//! Tasks are independent of each other and are cut the same way on any number of threads, so the bits do not depend on
//! the number of threads. `RAYON_NUM_THREADS=1` keeps all work on one thread.

/// Runs both tasks, at the same time where a second thread is free.
pub(crate) fn both<A: Send, B: Send>(one: impl FnOnce() -> A + Send, other: impl FnOnce() -> B + Send) -> (A, B) {
    #[cfg(all(feature = "rayon", not(target_family = "wasm")))]
    return rayon::join(one, other);
    #[cfg(not(all(feature = "rayon", not(target_family = "wasm"))))]
    return (one(), other());
}

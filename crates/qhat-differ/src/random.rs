//! Random numbers that follow from a seed alone, equal on every machine.
//!
//! SplitMix64 (Steele, Lea, Flood, Fast splittable pseudorandom number generators, 2014): a counter that grows by an
//! odd constant, and a mixing of its bits.

/// A source of random numbers.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The source that belongs to a seed.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number of [0, 1).
    pub fn unit(&mut self) -> f64 {
        // The 53 bits that a number between 0.5 and 1 holds.
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number of [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A number whose logarithm is evenly distributed between those of two positive numbers.
    pub fn decade(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.between(libm::log(low), libm::log(high)))
    }

    /// A whole number of 0 to `count` − 1.
    ///
    /// # Panics
    /// If `count` is 0.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// True with a probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// One item of a list.
    ///
    /// # Panics
    /// If the list is empty.
    pub fn pick<'a, T>(&mut self, items: &'a [T]) -> &'a T {
        &items[self.below(items.len())]
    }

    /// Two different whole numbers below `count`.
    ///
    /// # Panics
    /// If `count` is below 2.
    pub fn two(&mut self, count: usize) -> [usize; 2] {
        let first = self.below(count);
        let second = (first + 1 + self.below(count - 1)) % count;
        [first, second]
    }

    /// A vector with components of [−size, size); the third is 0 in the plane.
    pub fn vector(&mut self, dimension: usize, size: f64) -> [f64; 3] {
        std::array::from_fn(|axis| if axis < dimension { self.between(-size, size) } else { 0.0 })
    }
}

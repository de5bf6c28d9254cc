//! A memory for values of a pure function of a whole number, of fixed size.

/// Remembers the last values asked for. What it returns does not depend on what it remembers.
#[derive(Clone, Debug)]
pub struct Ring {
    /// (argument, value); the argument's lowest bits say where.
    slots: Vec<(i64, [f64; 3])>,
}

impl Ring {
    /// For at least `size` arguments in a row.
    pub fn new(size: usize) -> Self {
        Self { slots: vec![(i64::MIN, [0.0; 3]); size.next_power_of_two()] }
    }

    /// The value at `k`, made if it is not remembered.
    #[inline]
    pub fn get(&mut self, k: i64, make: impl FnOnce() -> [f64; 3]) -> [f64; 3] {
        let mask = self.slots.len() as i64 - 1;
        let slot = &mut self.slots[(k & mask) as usize];
        if slot.0 != k {
            *slot = (k, make());
        }
        slot.1
    }
}

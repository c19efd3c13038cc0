//! The bad triangles, those with the shortest edges first.

use std::collections::VecDeque;

/// The number of keys, which are exponents and one digit.
const KEYS: usize = 1 << 12;

/// A triangle that was bad, and its vertices: it is still there if it has these.
pub(super) type Entry = (u32, [u32; 3]);

/// Entries in the order of their keys. Those with equal keys leave in the order in which they came.
pub(super) struct Queue {
    of_key: Vec<VecDeque<Entry>>,
    /// No key below this has entries.
    lowest: usize,
}

impl Queue {
    pub(super) fn new() -> Self {
        Queue { of_key: vec![VecDeque::new(); KEYS], lowest: KEYS }
    }

    pub(super) fn push(&mut self, key: usize, entry: Entry) {
        let key = key.min(KEYS - 1);
        self.of_key[key].push_back(entry);
        self.lowest = self.lowest.min(key);
    }

    pub(super) fn pop(&mut self) -> Option<Entry> {
        while let Some(entries) = self.of_key.get_mut(self.lowest) {
            if let Some(entry) = entries.pop_front() {
                return Some(entry);
            }
            self.lowest += 1;
        }
        None
    }
}

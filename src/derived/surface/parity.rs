//! Disjoint sets whose members are on one of two sides.

/// Disjoint sets of the numbers below a count. Of two numbers in the same set it is known whether they
/// are on the same side or on opposite ones.
#[derive(Debug)]
pub(super) struct ParitySets {
    /// A lower number of the same set; the number itself if it is the lowest.
    parent: Vec<u32>,
    /// Whether each number is on the opposite side of its parent.
    is_opposite: Vec<bool>,
}

impl ParitySets {
    /// Creates one set for each number.
    pub(super) fn new(count: usize) -> Self {
        ParitySets { parent: (0..count as u32).collect(), is_opposite: vec![false; count] }
    }

    /// Returns the lowest number in the set of `i`, and whether `i` is on the opposite side.
    pub(super) fn find(&mut self, mut i: u32) -> (u32, bool) {
        let mut is_opposite = false;
        loop {
            let parent = self.parent[i as usize];
            let above = self.parent[parent as usize];
            if above != parent {
                // Halves the path.
                self.parent[i as usize] = above;
                self.is_opposite[i as usize] ^= self.is_opposite[parent as usize];
            }
            is_opposite ^= self.is_opposite[i as usize];
            if above == parent {
                return (parent, is_opposite);
            }
            i = above;
        }
    }

    /// Puts two numbers on the same side or on opposite ones. Has no effect if they are in the same
    /// set already, where their sides are known.
    pub(super) fn unite(&mut self, i: u32, j: u32, are_opposite: bool) {
        let ((i, i_side), (j, j_side)) = (self.find(i), self.find(j));
        if i != j {
            self.parent[i.max(j) as usize] = i.min(j);
            self.is_opposite[i.max(j) as usize] = i_side ^ j_side ^ are_opposite;
        }
    }

    /// Makes the lowest number of each set the parent of all, for [`root`](Self::root).
    pub(super) fn flatten(&mut self) {
        for i in 0..self.parent.len() {
            let parent = self.parent[i] as usize;
            if parent != i {
                self.is_opposite[i] ^= self.is_opposite[parent];
                self.parent[i] = self.parent[parent];
            }
        }
    }

    /// Returns the lowest number in the set of `i`, and whether `i` is on the opposite side, if the
    /// sets are flat.
    pub(super) fn root(&self, i: u32) -> (u32, bool) {
        (self.parent[i as usize], self.is_opposite[i as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_known_within_sets() {
        let mut sets = ParitySets::new(9);
        for i in (2..8).rev() {
            sets.unite(i, i + 1, i % 2 == 0);
        }
        sets.unite(0, 1, true);
        // The first word counts.
        sets.unite(8, 3, true);
        let sides = [false, true, true, false, false, true, true];
        for (i, side) in (2..).zip(sides) {
            assert_eq!(sets.find(i), (2, side ^ sides[0]), "{i}");
        }
        sets.flatten();
        assert_eq!((sets.root(1), sets.root(0)), ((0, true), (0, false)));
        assert!((2..).zip(sides).all(|(i, side)| sets.root(i) == (2, side)));
    }
}

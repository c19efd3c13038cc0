//! Disjoint sets whose members are on one of two sides.

/// Disjoint sets of the numbers below a count, at most 2³¹. Of two numbers in the same set it is known
/// whether they are on the same side or on opposite ones.
#[derive(Debug)]
pub(super) struct ParitySets {
    /// Twice a lower number of the same set, or twice the number itself if it is the lowest; one more if
    /// it is on the opposite side of that.
    links: Vec<u32>,
}

impl ParitySets {
    /// Creates one set for each number.
    pub(super) fn new(count: usize) -> Self {
        ParitySets { links: (0..count as u32).map(|i| 2 * i).collect() }
    }

    /// Returns the lowest number in the set of `i`, and whether `i` is on the opposite side.
    fn find(&mut self, mut i: u32) -> (u32, bool) {
        let mut side = 0;
        loop {
            let link = self.links[i as usize];
            let above = self.links[link as usize / 2];
            side ^= link & 1;
            if above / 2 == link / 2 {
                return (link / 2, side == 1);
            }
            // Halves the path.
            self.links[i as usize] = above ^ (link & 1);
            side ^= above & 1;
            i = above / 2;
        }
    }

    /// Puts two numbers on the same side or on opposite ones. Has no effect if they are in the same
    /// set already, where their sides are known.
    pub(super) fn unite(&mut self, i: u32, j: u32, are_opposite: bool) {
        let ((i, i_side), (j, j_side)) = (self.find(i), self.find(j));
        if i != j {
            self.links[i.max(j) as usize] = 2 * i.min(j) + u32::from(i_side ^ j_side ^ are_opposite);
        }
    }

    /// Links all numbers to the lowest ones of their sets, for [`root`](Self::root).
    pub(super) fn flatten(&mut self) {
        for i in 0..self.links.len() {
            let link = self.links[i];
            self.links[i] = self.links[link as usize / 2] ^ (link & 1);
        }
    }

    /// Returns the lowest number in the set of `i`, and whether `i` is on the opposite side, if the
    /// sets are flat.
    pub(super) fn root(&self, i: u32) -> (u32, bool) {
        let link = self.links[i as usize];
        (link / 2, link & 1 == 1)
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

//! Items in the order of small keys.

/// Items in the order of their keys, which are below a count. Those of equal keys stay in their order.
#[derive(Debug)]
pub(super) struct Groups<T> {
    /// Where the items of each key end.
    ends: Vec<usize>,
    pub(super) items: Vec<T>,
}

impl<T: Copy> Groups<T> {
    /// Sorts items by their keys, by counting these.
    pub(super) fn new(count: usize, keyed: impl Iterator<Item = (u32, T)> + Clone) -> Self {
        // At first where those of each key start.
        let mut ends = vec![0; count];
        keyed.clone().for_each(|(key, _)| ends[key as usize] += 1);
        let mut before = 0;
        for end in &mut ends {
            before += std::mem::replace(end, before);
        }
        let Some((_, first)) = keyed.clone().next() else { return Groups { ends, items: Vec::new() } };
        let mut items = vec![first; before];
        for (key, item) in keyed {
            let place = &mut ends[key as usize];
            items[*place] = item;
            *place += 1;
        }
        Groups { ends, items }
    }

    /// Sorts the items of each key, and calls `visit` with them, by ascending keys.
    pub(super) fn for_each_sorted(&mut self, mut visit: impl FnMut(&[T]))
    where
        T: Ord,
    {
        let mut start = 0;
        for &end in &self.ends {
            let items = &mut self.items[start..end];
            items.sort_unstable();
            visit(items);
            start = end;
        }
    }
}

// What the kernels for points count.
struct InputCounts {
    // Points at the same place of the lattice as one of a lower number.
    merged: atomic<u32>,
    // Those of them that have the same coordinates too.
    duplicates: atomic<u32>,
    // Points with a coordinate that was rounded to the lattice.
    rounded: atomic<u32>,
    unused: u32,
}

// The places of cells along the curve of src/input/hilbert.rs, which has the shape of d2/hilbert.
//!include d2/hilbert

// The cells on each axis are 2 to this power.
fn cell_bits() -> u32 {
    return 15;
}

fn place_of_cell(cell: vec3u) -> u32 {
    return hilbert_key(cell << vec3u(16));
}

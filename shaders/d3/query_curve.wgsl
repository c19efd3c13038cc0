// The places of cells along the curve of src/input/hilbert.rs (Hamilton and Rau-Chaplin, *Compact
// Hilbert indices*, 2008). Another one than that of d3/hilbert.

// The cells on each axis are 2 to this power.
fn cell_bits() -> u32 {
    return 10;
}

// Rotates a number of three bits, by 1 to 3.
fn rotated_left(bits: u32, by: u32) -> u32 {
    return ((bits << by) | (bits >> (3 - by))) & 7;
}

// The curve enters an octant's part at `entry` and leaves it along axis `direction`; for each place
// in it, four bits have the change of the one and of the other.
const ENTRIES: u32 = 0x56633000;
const DIRECTIONS: u32 = 0x31122110;

fn place_of_cell(cell: vec3u) -> u32 {
    var entry = 0u;
    var direction = 0u;
    var index = 0u;
    for (var i = 0u; i < 10; i++) {
        let bits = (cell >> vec3u(9 - i)) & vec3u(1);
        let octant = bits.x | (bits.y << 1) | (bits.z << 2);
        // The inverse of the Gray code.
        let code = rotated_left(octant ^ entry, 3 - (direction + 1) % 3);
        let place = code ^ (code >> 1) ^ (code >> 2);
        index = (index << 3) | place;
        entry ^= rotated_left((ENTRIES >> (4 * place)) & 7, direction + 1);
        direction = (direction + ((DIRECTIONS >> (4 * place)) & 7) + 1) % 3;
    }
    return index;
}

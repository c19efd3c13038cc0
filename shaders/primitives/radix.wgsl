// One pass of a radix sort by eight bits of the key, least significant digit first.
//!include primitives/workgroup

// A workgroup takes tiles of this many pairs.
const RADIX_TILE: u32 = 2048;
const RADIX_DIGITS: u32 = 256;
// With so many tiles or fewer, one workgroup scans the counts of all digits.
const RADIX_FEW: u32 = 8;

struct SortParams {
    // The number of pairs.
    count: u32,
    // Where the digit begins in the key.
    shift: u32,
}

fn radix_tiles(count: u32) -> u32 {
    return count / RADIX_TILE + u32(count % RADIX_TILE != 0);
}

fn radix_digit(key: u32, shift: u32) -> u32 {
    return (key >> shift) & (RADIX_DIGITS - 1);
}

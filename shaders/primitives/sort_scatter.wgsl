// Last of three kernels of a radix sort's pass: every pair goes to its place.
//
// A tile is taken in rows of one pair per invocation. Each digit has a mask with one bit per
// invocation: what lies below an invocation's own bit is how many pairs of its digit come before it
// in the row. That keeps the sort stable.
//!include primitives/radix
//!include primitives/workgroup_scan

@group(0) @binding(0) var<storage, read> params: SortParams;
@group(0) @binding(1) var<storage, read> pairs: array<vec2u>;
@group(0) @binding(2) var<storage, read> counts: array<u32>;
@group(0) @binding(3) var<storage, read> totals: array<u32>;
@group(0) @binding(4) var<storage, read_write> sorted: array<vec2u>;

// Where the next pair of each digit goes.
var<workgroup> places: array<u32, RADIX_DIGITS>;
// Word w of a digit's mask is at w·RADIX_DIGITS + digit.
var<workgroup> masks: array<atomic<u32>, 8 * RADIX_DIGITS>;

fn clear_masks(digit: u32) {
    atomicStore(&masks[digit], 0);
    atomicStore(&masks[RADIX_DIGITS + digit], 0);
    atomicStore(&masks[2 * RADIX_DIGITS + digit], 0);
    atomicStore(&masks[3 * RADIX_DIGITS + digit], 0);
    atomicStore(&masks[4 * RADIX_DIGITS + digit], 0);
    atomicStore(&masks[5 * RADIX_DIGITS + digit], 0);
    atomicStore(&masks[6 * RADIX_DIGITS + digit], 0);
    atomicStore(&masks[7 * RADIX_DIGITS + digit], 0);
}

// Returns four words of a digit's mask, from word w on.
fn four_masks(w: u32, digit: u32) -> vec4u {
    let at = w * RADIX_DIGITS + digit;
    return vec4u(
        atomicLoad(&masks[at]),
        atomicLoad(&masks[at + RADIX_DIGITS]),
        atomicLoad(&masks[at + 2 * RADIX_DIGITS]),
        atomicLoad(&masks[at + 3 * RADIX_DIGITS])
    );
}

// Returns the bits of the invocations before `local` in the words from word w on.
fn bits_before(w: u32, local: u32) -> vec4u {
    let words = vec4u(w, w + 1, w + 2, w + 3);
    let word = vec4u(local / 32);
    return select(select(vec4u(0), vec4u((1u << (local % 32)) - 1), words == word), vec4u(0xffffffff), words < word);
}

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32
) {
    let digit_start = workgroup_scan(totals[local], local).before;
    let word = local / 32;
    let bit = 1u << (local % 32);
    clear_masks(local);
    let tiles = radix_tiles(params.count);
    for (var tile = group.x; tile < tiles; tile += groups.x) {
        places[local] = digit_start + counts[local * tiles + tile];
        workgroupBarrier();
        let end = min(RADIX_TILE, params.count - tile * RADIX_TILE);
        for (var row = 0u; row < end; row += WORKGROUP) {
            let inside = row + local < end;
            var pair = vec2u();
            if inside { pair = pairs[tile * RADIX_TILE + row + local]; }
            let digit = radix_digit(pair.x, params.shift);
            if inside { atomicOr(&masks[word * RADIX_DIGITS + digit], bit); }
            workgroupBarrier();
            let low = four_masks(0, digit);
            let high = four_masks(4, digit);
            let ones = countOneBits(low & bits_before(0, local)) + countOneBits(high & bits_before(4, local));
            let rank = ones.x + ones.y + ones.z + ones.w;
            let all_ones = countOneBits(low) + countOneBits(high);
            let occurrences = all_ones.x + all_ones.y + all_ones.z + all_ones.w;
            let place = places[digit] + rank;
            workgroupBarrier();
            if inside {
                sorted[place] = pair;
                // The last of each digit makes ready for the next row.
                if rank + 1 == occurrences {
                    places[digit] = place + 1;
                    clear_masks(digit);
                }
            }
            workgroupBarrier();
        }
    }
}

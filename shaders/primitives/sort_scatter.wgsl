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

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32
) {
    let digit_start = workgroup_scan(totals[local], local).before;
    let word = local / 32;
    let bit = 1u << (local % 32);
    for (var w = 0u; w < 8; w++) {
        atomicStore(&masks[w * RADIX_DIGITS + local], 0);
    }
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
            var rank = 0u;
            var occurrences = 0u;
            for (var w = 0u; w < 8; w++) {
                let mask = atomicLoad(&masks[w * RADIX_DIGITS + digit]);
                let before = select(select(0u, bit - 1, w == word), 0xffffffffu, w < word);
                rank += countOneBits(mask & before);
                occurrences += countOneBits(mask);
            }
            let place = places[digit] + rank;
            workgroupBarrier();
            if inside {
                sorted[place] = pair;
                // The last of each digit makes ready for the next row.
                if rank + 1 == occurrences {
                    places[digit] = place + 1;
                    for (var w = 0u; w < 8; w++) {
                        atomicStore(&masks[w * RADIX_DIGITS + digit], 0);
                    }
                }
            }
            workgroupBarrier();
        }
    }
}

// Second of three kernels of a radix sort's pass, one workgroup per digit, or one invocation where
// there are few tiles: the digit's counts become the numbers of its occurrences in the tiles
// before.
//!include primitives/radix
//!include primitives/workgroup_scan

@group(0) @binding(0) var<storage, read> params: SortParams;
@group(0) @binding(1) var<storage, read_write> counts: array<u32>;
// The occurrences of each digit.
@group(0) @binding(2) var<storage, read_write> totals: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let tiles = radix_tiles(params.count);
    var before = 0u;
    if tiles <= RADIX_FEW {
        for (var tile = 0u; tile < tiles; tile++) {
            let value = counts[local * tiles + tile];
            counts[local * tiles + tile] = before;
            before += value;
        }
        totals[local] = before;
        return;
    }
    let digit = group.x;
    for (var step = 0u; step < tiles; step += WORKGROUP) {
        let tile = step + local;
        let at = digit * tiles + tile;
        var value = 0u;
        if tile < tiles { value = counts[at]; }
        let scanned = workgroup_scan(value, local);
        if tile < tiles { counts[at] = before + scanned.before; }
        before += scanned.total;
    }
    if local == 0 {
        totals[digit] = before;
    }
}

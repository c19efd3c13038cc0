// Second of three kernels of an exclusive scan, one workgroup: the parts' sums become their
// offsets, and the sum of all is put behind them.
//!include primitives/scan
//!include primitives/workgroup_scan

@group(0) @binding(0) var<storage, read> params: ScanParams;
@group(0) @binding(1) var<storage, read_write> sums: array<u32>;

// The sum of a part; 0 where there is no part.
fn sum_of(part: u32) -> u32 {
    return select(0u, sums[part], part * scan_part_size(params.count) < params.count);
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(local_invocation_index) local: u32) {
    const EACH = SCAN_GROUPS / WORKGROUP;
    var sum = 0u;
    for (var i = 0u; i < EACH; i++) {
        sum += sum_of(local * EACH + i);
    }
    let scanned = workgroup_scan(sum, local);
    var before = scanned.before;
    for (var i = 0u; i < EACH; i++) {
        let value = sum_of(local * EACH + i);
        sums[local * EACH + i] = before;
        before += value;
    }
    if local == 0 {
        sums[SCAN_GROUPS] = scanned.total;
    }
}

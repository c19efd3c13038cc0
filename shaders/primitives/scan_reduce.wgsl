// First of three kernels of an exclusive scan: the sum of each workgroup's part.
//!include primitives/scan
//!include primitives/workgroup_scan

@group(0) @binding(0) var<storage, read> params: ScanParams;
@group(0) @binding(1) var<storage, read> values: array<u32>;
// The sum of each part; SCAN_GROUPS + 1 of them.
@group(0) @binding(2) var<storage, read_write> sums: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let part = scan_part(params.count, group.x);
    var sum = 0u;
    for (var i = part.x + local; i < part.y; i += WORKGROUP) {
        sum += values[i];
    }
    let scanned = workgroup_scan(sum, local);
    if local == 0 {
        sums[group.x] = scanned.total;
    }
}

// Last of three kernels of an exclusive scan: each workgroup scans its part, from its offset on.
//!include primitives/scan
//!include primitives/workgroup_scan

@group(0) @binding(0) var<storage, read> params: ScanParams;
@group(0) @binding(1) var<storage, read> values: array<u32>;
// The offset of each part.
@group(0) @binding(2) var<storage, read> sums: array<u32>;
@group(0) @binding(3) var<storage, read_write> offsets: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let part = scan_part(params.count, group.x);
    var before = sums[group.x];
    for (var step = part.x; step < part.y; step += SCAN_STEP) {
        let first = step + 4 * local;
        // Out-of-range values count as 0.
        var value = vec4u();
        if first < part.y { value.x = values[first]; }
        if first + 1 < part.y { value.y = values[first + 1]; }
        if first + 2 < part.y { value.z = values[first + 2]; }
        if first + 3 < part.y { value.w = values[first + 3]; }
        let scanned = workgroup_scan(value.x + value.y + value.z + value.w, local);
        let x = before + scanned.before;
        if first < part.y { offsets[first] = x; }
        if first + 1 < part.y { offsets[first + 1] = x + value.x; }
        if first + 2 < part.y { offsets[first + 2] = x + value.x + value.y; }
        if first + 3 < part.y { offsets[first + 3] = x + value.x + value.y + value.z; }
        before += scanned.total;
    }
}

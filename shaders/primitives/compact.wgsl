// Stream compaction: the numbers of the marked entries, in order. `offsets` is the exclusive scan
// of `marks`.
//!include primitives/scan

@group(0) @binding(0) var<storage, read> params: ScanParams;
// 0 or 1 each.
@group(0) @binding(1) var<storage, read> marks: array<u32>;
@group(0) @binding(2) var<storage, read> offsets: array<u32>;
@group(0) @binding(3) var<storage, read_write> kept: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < params.count; i += groups.x * WORKGROUP) {
        if marks[i] != 0 {
            kept[offsets[i]] = i;
        }
    }
}

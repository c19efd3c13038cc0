// Makes the simplices that Phase 1 starts with, and lists them: all their facets are to be checked,
// since the host knows nothing of points that stand for others, which break ties differently. One
// invocation per simplex.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
// The words of InputCounts.
@group(0) @binding(1) var<storage, read> counts: array<u32>;
// Corners, by place among the points, where NONE is infinity; then neighbours.
@group(0) @binding(2) var<storage, read> start_simplices: array<array<vec4u, 2>>;
@group(0) @binding(3) var<storage, read> start_vertices: array<u32>;
@group(0) @binding(4) var<storage, read_write> simplices: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> status: array<Status>;
@group(0) @binding(7) var<storage, read_write> actives: array<Active>;
//!include common/count_words
//!include common/start_slots
//!include {dim}/split

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < control.start_simplices; i += groups.x * WORKGROUP) {
        let slot = start_slot(i);
        for (var k = 0u; k < CORNERS; k++) {
            let corner = start_simplices[i][0][k];
            var v = control.infinite;
            if corner != NONE {
                v = start_vertices[corner];
            }
            simplices[slot][k] = v;
            let across = start_simplices[i][1][k];
            neighbors[slot][k] = 4 * start_slot(across >> 2) + (across & 3);
        }
        if CORNERS < 4 {
            simplices[slot].w = 0;
            neighbors[slot].w = 0;
        }
        atomicStore(&status[slot].flags, (1u << CORNERS) - 1);
        actives[i] = Active(slot, 0);
        take_slot(slot);
    }
    if id.x == 0 {
        control.merged = counts[COUNT_MERGED];
    }
}

// Puts the simplices of a mesh into slots, and a ghost on each facet of its hull. One invocation
// per simplex.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
// The words of InputCounts.
@group(0) @binding(1) var<storage, read> counts: array<u32>;
// The vertex of each point.
@group(0) @binding(2) var<storage, read> vertex_of: array<u32>;
@group(0) @binding(5) var<storage, read_write> simplices: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> neighbors: array<vec4u>;
//!include common/count_words
//!include common/moved_slots
//!include {dim}/moved_mesh
//!include {dim}/split

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < control.moved_simplices; t += groups.x * WORKGROUP) {
        let slot = moved_slot(t);
        var simplex = moved_points(t);
        for (var k = 0u; k < CORNERS; k++) {
            simplex = replaced(simplex, k, vertex_of[simplex[k]]);
        }
        for (var k = 0u; k < CORNERS; k++) {
            var across = moved_across(t, k);
            if across != NONE {
                across = 4 * moved_slot(across >> 2) + (across & 3);
            } else {
                let ghost = atomicAdd(&control.moved_hull, 1u);
                if ghost < control.moved_ghosts {
                    let there = moved_slot(control.moved_simplices + ghost);
                    simplices[there] = packed(ghost_beyond(simplex, k));
                    neighbors[there][CORNERS - 1] = 4 * slot + k;
                    take_slot(there);
                    across = 4 * there + CORNERS - 1;
                }
            }
            neighbors[slot][k] = across;
        }
        simplices[slot] = packed(simplex);
        take_slot(slot);
    }
    if id.x == 0 {
        control.merged = counts[COUNT_MERGED];
        atomicStore(&control.inserted, control.infinite - control.merged);
    }
}

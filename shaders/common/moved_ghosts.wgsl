// Joins the ghosts of a mesh whose points have moved: two that share a ridge of the hull are found
// by walking through the simplices around it. One invocation per ridge of a ghost.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> neighbors: array<vec4u>;
//!include common/moved_slots

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    // Infinity is the last corner of the ghosts.
    let last = CORNERS - 1;
    // No ridge has more simplices around it than there are.
    let limit = control.moved_simplices;
    for (var i = id.x; i < control.moved_ghosts * last; i += groups.x * WORKGROUP) {
        let slot = moved_slot(control.moved_simplices + i / last);
        let k = i % last;
        // The facet of the simplex at hand that the walk came through, and the vertex opposite
        // to the one through which it goes on.
        var entry = neighbors[slot][last];
        var left = simplices[slot][k];
        var steps = 0u;
        while simplices[entry >> 2][last] != control.infinite && steps <= limit {
            let apex = simplices[entry >> 2][entry & 3];
            entry = neighbors[entry >> 2][place_of(unpacked(simplices[entry >> 2]), left)];
            left = apex;
            steps += 1;
        }
        if steps > limit {
            atomicMax(&control.inverted, BROKEN);
        } else {
            neighbors[slot][k] = (entry & ~3u) | place_of(unpacked(simplices[entry >> 2]), left);
        }
    }
    if id.x == 0 && atomicLoad(&control.moved_hull) != control.moved_ghosts {
        atomicMax(&control.inverted, BROKEN);
    }
}

// Removes the facets of the removals that won all of their tetrahedra. As in flips, the new tetrahedra overwrite the
// old ones. One invocation per removal.
//!include d3/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read_write> simplices: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> status: array<OwnedStatus>;
@group(0) @binding(4) var<storage, read_write> messages: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> removals: array<Removal>;
//!include d3/removal

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let base = control.bid_base;
    let count = min(atomicLoad(&control.next_node), control.history);
    for (var i = id.x; i < count; i += groups.x * WORKGROUP) {
        var removal = removals[i];
        let facets = removal.facets;
        var has_won = true;
        for (var j = 0u; j < 2 * facets; j++) {
            has_won = has_won && atomicLoad(&status[removal.tets[j]].vote) == base + i;
        }
        if !has_won {
            removals[i].facets = 0;
            continue;
        }
        // The corners of the ring, and what is across its edges on both sides.
        let len = facets + 2;
        var x: array<u32, MOST_FACETS + 2>;
        var near_d: array<u32, MOST_FACETS + 2>;
        var near_e: array<u32, MOST_FACETS + 2>;
        var faces: array<vec2u, MOST_FACETS + 2>;
        for (var j = 0u; j < len; j++) {
            let edge = (removal.ring >> (4 * j)) & 0xf;
            let at_d = removal.tets[2 * (edge >> 2)];
            let at_e = removal.tets[2 * (edge >> 2) + 1];
            let c = corners_of(simplices[at_d], removal.d, edge);
            let opposite = place_of(simplices[at_e], simplices[at_d][c.z]);
            x[j] = simplices[at_d][c.x];
            near_d[j] = neighbors[at_d][c.z];
            near_e[j] = neighbors[at_e][opposite];
            faces[j] = vec2u(4 * at_d + c.z, 4 * at_e + opposite);
        }
        for (var j = 0u; j < 2 * facets; j++) {
            let t = removal.tets[j];
            messages[t] = vec4u(NONE);
            status[t].made = vec2u(select(0u, CHECK, j < len), 0);
            atomicStore(&status[t].vote, base + count);
            if j >= len {
                simplices[t] = vec4u(0);
                atomicOr(&control.free[t / BLOCK], 1u << (t % BLOCK));
            }
        }
        // (x_j, x_j+1, d, e): faces 0 and 1 lead to the next one and to the one before, faces 2 and 3 are old facets
        // with e and with d.
        for (var j = 0u; j < len; j++) {
            let t = removal.tets[j];
            let next = (j + 1) % len;
            simplices[t] = vec4u(x[j], x[next], removal.d, removal.e);
            neighbors[t] = vec4u(4 * removal.tets[next] + 1, 4 * removal.tets[(j + len - 1) % len], near_e[j], near_d[j]);
            messages[faces[j].x >> 2][faces[j].x & 3] = 4 * t + 3;
            messages[faces[j].y >> 2][faces[j].y & 3] = 4 * t + 2;
        }
    }
    if id.x == 0 {
        control.link_bid_base = base;
    }
}

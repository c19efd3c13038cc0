// Looks for facets that are not locally Delaunay and could not be flipped, but can be removed together with facets
// beside them, and bids for the tetrahedra that this changes. One invocation per slot.
//!include d3/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(2) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> status: array<Status>;
@group(0) @binding(5) var<storage, read_write> removals: array<Removal>;
//!include d3/signs
//!include d3/removal

// Returns the removal that facet k of tet, which is at slot t, is a part of; one of no facets if there is none.
//
// Where the edge from d to e passes beside a facet, the facet across that edge is removed, too. No others are,
// so that each of the facets determines the same removal.
fn removal_of(t: u32, tet: vec4u, k: u32) -> Removal {
    let d = tet[k];
    let e = simplices[neighbors[t][k] >> 2][neighbors[t][k] & 3];
    var removal = Removal();
    removal.d = d;
    removal.e = e;
    removal.tets[0] = t;
    removal.tets[1] = neighbors[t][k] >> 2;
    var facets = 1u;
    // The edges to look at, and those of the ring, 4·facet + which of its edges.
    var todo = 0x012u;
    var todo_len = 3u;
    var found = 0u;
    var len = 0u;
    while todo_len != 0 {
        let at = todo & 0xf;
        todo >>= 4;
        todo_len -= 1;
        let at_d = removal.tets[2 * (at >> 2)];
        let at_e = removal.tets[2 * (at >> 2) + 1];
        let c = corners_of(simplices[at_d], d, at);
        let x = simplices[at_d][c.x];
        let y = simplices[at_d][c.y];
        if orient(vec4u(x, y, d, e)) > 0 {
            found |= at << (4 * len);
            len += 1;
            continue;
        }
        let across_d = neighbors[at_d][c.z];
        let across_e = neighbors[at_e][place_of(simplices[at_e], simplices[at_d][c.z])];
        let w = simplices[across_d >> 2][across_d & 3];
        let is_between = w == simplices[across_e >> 2][across_e & 3];
        var is_new = facets < MOST_FACETS && is_between && w != d && w != e && w != control.infinite;
        for (var i = 0u; i < 2 * facets; i++) {
            is_new = is_new && removal.tets[i] != across_d >> 2 && removal.tets[i] != across_e >> 2;
        }
        if !is_new {
            return removal;
        }
        removal.tets[2 * facets] = across_d >> 2;
        removal.tets[2 * facets + 1] = across_e >> 2;
        // The edge opposite w is the one that led here.
        for (var j = 0u; j < 3; j++) {
            if corners_of(simplices[across_d >> 2], d, j).z != (across_d & 3) {
                todo = (todo << 4) | (4 * facets + j);
                todo_len += 1;
            }
        }
        facets += 1;
    }
    // The edges must be one ring, which has no vertex in its middle.
    var ring = found & 0xf;
    var last = ring;
    var ring_len = 1u;
    while ring_len < len {
        let end = ends_of(&removal, last).y;
        var next = 16u;
        for (var i = 1u; i < len; i++) {
            let edge = (found >> (4 * i)) & 0xf;
            next = select(next, edge, ends_of(&removal, edge).x == end);
        }
        if next == 16 {
            return removal;
        }
        ring |= next << (4 * ring_len);
        ring_len += 1;
        last = next;
    }
    removal.ring = ring;
    let is_closed = ends_of(&removal, last).y == ends_of(&removal, ring & 0xf).x;
    removal.facets = select(0u, facets, facets > 1 && len == facets + 2 && is_closed);
    return removal;
}

// Returns the ends of an edge of a facet.
fn ends_of(removal: ptr<function, Removal>, edge: u32) -> vec2u {
    let t = (*removal).tets[2 * (edge >> 2)];
    let c = corners_of(simplices[t], (*removal).d, edge);
    return vec2u(simplices[t][c.x], simplices[t][c.y]);
}

// Bids for the tetrahedra of a removal.
fn bid_for(removal: ptr<function, Removal>, bid: u32) {
    for (var j = 0u; j < 2 * (*removal).facets; j++) {
        atomicMax(&status[(*removal).tets[j]].vote, bid);
    }
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    // Waiting points would not find their tetrahedra, and what is active may be flipped.
    let waiting = control.infinite - atomicLoad(&control.inserted) - control.merged;
    if waiting != 0 || atomicLoad(&control.active_len[control.iteration & 1]) != 0 {
        return;
    }
    if id.x == 0 {
        control.removals += 1;
    }
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        let suspect = (atomicLoad(&status[t].flags) >> SUSPECT_SHIFT) & CHECK;
        let tet = simplices[t];
        if suspect == 0 || any(tet == vec4u(control.infinite)) || all(tet == vec4u(0)) {
            continue;
        }
        let facets = not_unrolled(4);
        for (var k = 0u; k < facets; k++) {
            let e = simplices[neighbors[t][k] >> 2][neighbors[t][k] & 3];
            if ((suspect >> k) & 1) == 0 || e == control.infinite || conflict(tet, e) <= 0 {
                continue;
            }
            var removal = removal_of(t, tet, k);
            if removal.facets != 0 {
                let i = atomicAdd(&control.next_node, 1u);
                if i < control.history {
                    removals[i] = removal;
                    bid_for(&removal, control.bid_base + i);
                }
            }
        }
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
}

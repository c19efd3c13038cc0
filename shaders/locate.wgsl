// Makes the first tetrahedra, lists all points and locates them there. One invocation a point.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
// Key and point of each vertex; the key of points that others stand for is UNITED.
@group(0) @binding(2) var<storage, read> pairs: array<vec2u>;
// The words of InputCounts.
@group(0) @binding(3) var<storage, read> counts: array<u32>;
@group(0) @binding(4) var<storage, read_write> waiting: array<Waiting>;
@group(0) @binding(5) var<storage, read_write> tets: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(7) var<storage, read_write> free: array<u32>;
//!include shared/signs
//!include shared/child_of

const UNITED: u32 = 0xffffffff;
const COUNT_UNITED: u32 = 0;
const COUNT_FOUND: u32 = 8;

// The first tetrahedron, and beyond its facet k the infinite one of the facet's corners and infinity, in the slots after.
fn make_first(first: vec4u, infinite: u32) {
    let base = infinite * BLOCK;
    tets[base] = first;
    neighbors[base] = 4 * (vec4u(base) + vec4u(1, 2, 3, 4)) + 3;
    for (var k = 0u; k < 4; k++) {
        let c = facet(k);
        tets[base + 1 + k] = vec4u(first[c.x], first[c.y], first[c.z], infinite);
        // Beyond the edge opposite a corner, the infinite tetrahedron of the facet opposite that corner, where k's place
        // among the corners is the face.
        var near = vec4u(0, 0, 0, 4 * base + k);
        for (var i = 0u; i < 3; i++) {
            let there = facet(c[i]);
            let face = select(select(2u, 1u, there.y == k), 0u, there.x == k);
            near[i] = 4 * (base + 1 + c[i]) + face;
        }
        neighbors[base + 1 + k] = near;
    }
    free[infinite] = 0xe0;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let first = vec4u(counts[COUNT_FOUND], counts[COUNT_FOUND + 1], counts[COUNT_FOUND + 2], counts[COUNT_FOUND + 3]);
    let infinite = control.infinite;
    for (var p = id.x; p < infinite; p += groups.x * 256) {
        var tet = NONE;
        if all(first != vec4u(p)) && pairs[p].x != UNITED {
            // The kernel point, not infinity, whose number it has.
            let k = child_of(first, infinite, p, NONE);
            let beyond = orient_finite(replaced(first, k, p)) < 0;
            tet = infinite * BLOCK + select(0u, 1 + k, beyond);
        }
        waiting[p] = Waiting(p, tet);
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
    if id.x == 0 {
        make_first(first, infinite);
        atomicAdd(&control.inserted, 4u);
        control.merged = counts[COUNT_UNITED];
    }
}

// Lists the tetrahedra that are flat, and where coordinates were rounded to the lattice also what it does not prove for
// the true ones: tetrahedra whose orientation, or whose facets' being locally Delaunay or not, the filter leaves open. The
// filter's bound counts rounding in; where nothing was rounded, the lattice is the truth. One invocation a slot.
//
// Each facet is looked at from the tetrahedron in the lower slot. That a facet to infinity bounds a finite tetrahedron is a
// matter of this one's orientation.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(2) var<storage, read> tets: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
// As mesh_number makes them.
@group(0) @binding(4) var<storage, read> numbers: array<u32>;
// The words of InputCounts.
@group(0) @binding(5) var<storage, read> counts: array<u32>;
// Number; facets (bits 0 to 3) and orientation (bit 4) that are open.
@group(0) @binding(6) var<storage, read_write> doubtful: array<vec2u>;
//!include shared/predicates
//!include shared/filter
//!include shared/rounded_{width}

const COUNT_ROUNDED: u32 = 2;
const ORIENTATION: u32 = 16;

fn any_rounded(tet: vec4u) -> bool {
    return rounded(tet.x) || rounded(tet.y) || rounded(tet.z) || rounded(tet.w);
}

fn orientation_of(tet: vec4u) -> i32 {
    return orient3d_filter(load_high(tet.x), load_high(tet.y), load_high(tet.z), load_high(tet.w));
}

fn is_flat(tet: vec4u) -> bool {
    return orient3d_exact(load_vertex(tet.x), load_vertex(tet.y), load_vertex(tet.z), load_vertex(tet.w)) == 0;
}

// The facets of tetrahedron t that are open.
fn open_facets(t: u32, tet: vec4u) -> u32 {
    let near = neighbors[t];
    let at_infinity = tet == vec4u(control.infinite);
    var open = 0u;
    for (var k = 0u; k < 4; k++) {
        let u = near[k] >> 2;
        let e = tets[u][near[k] & 3];
        if u < t || e == control.infinite || at_infinity[k] {
            continue;
        }
        var is_open = false;
        if any(at_infinity) {
            let finite = select(tet, vec4u(e), at_infinity);
            is_open = any_rounded(finite) && orientation_of(finite) == 0;
        } else if any_rounded(tet) || rounded(e) {
            is_open = insphere_filter(
                load_high(tet.x), load_high(tet.y), load_high(tet.z), load_high(tet.w), load_high(e)
            ) == 0;
        }
        open |= select(0u, 1u << k, is_open);
    }
    return open;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * 256) {
        let tet = tets[t];
        if all(tet == vec4u(0)) {
            continue;
        }
        var open = 0u;
        if counts[COUNT_ROUNDED] != 0 {
            open = open_facets(t, tet);
        }
        if !any(tet == vec4u(control.infinite)) && orientation_of(tet) == 0 {
            if any_rounded(tet) || is_flat(tet) {
                open |= ORIENTATION;
            }
        }
        if open != 0 {
            doubtful[atomicAdd(&control.uncertain, 1u)] = vec2u(numbers[t] >> 2, open);
        }
    }
}

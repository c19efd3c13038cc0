// Lists what the lattice does not prove for the true coordinates: tetrahedra whose orientation, or whose facets' being
// locally Delaunay or not, the filter leaves open, where a coordinate was rounded. The filter's bound counts rounding in;
// where nothing was rounded, the lattice is the truth. One invocation a tetrahedron.
//
// Each facet is looked at from the tetrahedron of the lower number. That a facet to infinity bounds a finite tetrahedron
// is a matter of this one's orientation.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
// The mesh without gaps.
@group(0) @binding(2) var<storage, read> tets: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
// The last entry is the number of tetrahedra.
@group(0) @binding(4) var<storage, read> sums: array<u32>;
// The words of InputCounts.
@group(0) @binding(5) var<storage, read> counts: array<u32>;
// Tetrahedron; facets (bits 0 to 3) and orientation (bit 4) that are open.
@group(0) @binding(6) var<storage, read_write> uncertain: array<vec2u>;
//!include shared/exact_wide
//!include shared/filter

const COUNT_ROUNDED: u32 = 2;
const ORIENTATION: u32 = 16;

fn rounded(v: u32) -> bool {
    return vertices[2 * v + 1].w != 0;
}

fn any_rounded(tet: vec4u) -> bool {
    return rounded(tet.x) || rounded(tet.y) || rounded(tet.z) || rounded(tet.w);
}

fn orientation_is_open(tet: vec4u) -> bool {
    return any_rounded(tet)
        && orient3d_filter(load_high(tet.x), load_high(tet.y), load_high(tet.z), load_high(tet.w)) == 0;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let infinite = control.infinite;
    let count = select(sums[arrayLength(&sums) - 1], 0u, counts[COUNT_ROUNDED] == 0);
    for (var t = id.x; t < count; t += groups.x * 256) {
        let tet = tets[t];
        let near = neighbors[t];
        let at_infinity = tet == vec4u(infinite);
        var open = 0u;
        if !any(at_infinity) && orientation_is_open(tet) {
            open = ORIENTATION;
        }
        for (var k = 0u; k < 4; k++) {
            let u = near[k] >> 2;
            let e = tets[u][near[k] & 3];
            if u < t || e == infinite || at_infinity[k] {
                continue;
            }
            if any(at_infinity) {
                if orientation_is_open(select(tet, vec4u(e), at_infinity)) {
                    open |= 1u << k;
                }
            } else if any_rounded(tet) || rounded(e) {
                let sign = insphere_filter(
                    load_high(tet.x), load_high(tet.y), load_high(tet.z), load_high(tet.w), load_high(e)
                );
                if sign == 0 {
                    open |= 1u << k;
                }
            }
        }
        if open != 0 {
            uncertain[atomicAdd(&control.uncertain, 1u)] = vec2u(t, open);
        }
    }
}

// Lists the tetrahedra that are flat, or inverted where points have moved, and where coordinates were rounded to the lattice also those
// of which the filter does not decide the orientation or whether a facet is locally Delaunay. The
// filter's bound includes the rounding; where nothing was rounded, the lattice is the truth. The
// stars of their vertices are wanted. One invocation per slot.
//
// Each facet is examined from the tetrahedron in the lower slot. Whether a facet to infinity bounds
// a finite tetrahedron follows from the orientation of that tetrahedron.
//!include d3/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(2) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
// The output of mesh_number.
@group(0) @binding(4) var<storage, read> numbers: array<u32>;
// The words of InputCounts.
@group(0) @binding(5) var<storage, read> counts: array<u32>;
// The number of a tetrahedron, and its undecided facets (bits 0 to 3) and orientation (bit 4).
@group(0) @binding(6) var<storage, read_write> uncertain: array<vec2u>;
// A bit per point.
@group(0) @binding(7) var<storage, read_write> wanted: array<atomic<u32>>;
//!include common/count_words
//!include d3/predicates
//!include d3/filter
//!include d3/rounding_{width}

const ORIENTATION: u32 = 16;

fn any_rounded(tet: vec4u) -> bool {
    return rounded(tet.x) || rounded(tet.y) || rounded(tet.z) || rounded(tet.w);
}

fn orientation_of(tet: vec4u) -> i32 {
    return orient3d_filter(load_high(tet.x), load_high(tet.y), load_high(tet.z), load_high(tet.w));
}

// Returns whether a tetrahedron is not positively oriented on the lattice, or its orientation is not
// certain. Of a ghost, the number of infinity stands for the interior point, and it is never inverted
// unless points have moved. The exact arithmetic is called once, since it is compiled for each call.
fn is_uncertain(tet: vec4u) -> bool {
    let is_ghost = any(tet == vec4u(control.infinite));
    let sign = orientation_of(tet);
    let asks = select(sign == 0 && !any_rounded(tet), sign >= 0 && control.moved_simplices != 0, is_ghost);
    var exact = 0;
    if asks {
        exact = orient3d_exact(load_vertex(tet.x), load_vertex(tet.y), load_vertex(tet.z), load_vertex(tet.w));
    }
    return select(sign <= 0 && (!asks || exact <= 0), asks && exact >= 0, is_ghost);
}

// Returns the undecided facets of tetrahedron t.
fn undecided_facets(t: u32, tet: vec4u) -> u32 {
    let near = neighbors[t];
    let at_infinity = tet == vec4u(control.infinite);
    var undecided = 0u;
    for (var k = 0u; k < 4; k++) {
        let u = near[k] >> 2;
        let e = simplices[u][near[k] & 3];
        if u < t || e == control.infinite || at_infinity[k] {
            continue;
        }
        var is_undecided = false;
        if any(at_infinity) {
            let finite = select(tet, vec4u(e), at_infinity);
            is_undecided = any_rounded(finite) && orientation_of(finite) == 0;
        } else if any_rounded(tet) || rounded(e) {
            is_undecided = insphere_filter(
                load_high(tet.x), load_high(tet.y), load_high(tet.z), load_high(tet.w), load_high(e)
            ) == 0;
        }
        undecided |= select(0u, 1u << k, is_undecided);
    }
    return undecided;
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        let tet = simplices[t];
        if all(tet == vec4u(0)) {
            continue;
        }
        var undecided = 0u;
        if counts[COUNT_ROUNDED] != 0 {
            undecided = undecided_facets(t, tet);
        }
        if is_uncertain(tet) {
            undecided |= ORIENTATION;
        }
        if undecided != 0 {
            uncertain[atomicAdd(&control.uncertain, 1u)] = vec2u(numbers[t] >> 2, undecided);
            for (var k = 0u; k < 4; k++) {
                if tet[k] != control.infinite {
                    let point = index_of(tet[k]);
                    atomicOr(&wanted[point >> 5], 1u << (point & 31));
                }
            }
        }
    }
}

// Marks the triangles of the answer: finite ones that are not flat. Where coordinates were rounded,
// lists the signs that the lattice does not prove for the true ones, which the host evaluates:
// orientations of triangles and corners of the hull, and whether edges are locally Delaunay. Counts
// those that are inverted, which there can be where points have moved. One invocation per slot.
//
// The filter's bound counts rounding in, and the exact value has a bound of its own
// (d2/rounding_wide).
//
// Flat triangles, which only the perturbation of the coordinates makes, lie along the hull: a point
// between two others on a line is inside every circle through these, so no triangle that is not
// flat has them for an edge.
//
// Each edge is examined from the triangle in the lower slot. Whether an edge to infinity bounds a
// finite triangle follows from the orientation of that triangle.
//!include d2/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(2) var<storage, read> pairs: array<vec2u>;
@group(0) @binding(3) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(4) var<storage, read> neighbors: array<vec4u>;
// The words of InputCounts.
@group(0) @binding(5) var<storage, read> counts: array<u32>;
@group(0) @binding(6) var<storage, read_write> marks: array<u32>;
// One per slot; tests beyond that are counted, but not stored.
@group(0) @binding(7) var<storage, read_write> uncertain_tests: array<UncertainTest>;
//!include common/count_words
//!include d2/predicates
//!include d2/filter
//!include d2/rounding_{width}

fn any_rounded(tri: vec3u) -> bool {
    return rounded(tri.x) || rounded(tri.y) || rounded(tri.z);
}

fn orientation_filter(tri: vec3u) -> i32 {
    return orient2d_filter(load_high(tri.x), load_high(tri.y), load_high(tri.z));
}

fn is_uncertain(tri: vec3u) -> bool {
    return any_rounded(tri) && orient2d_rounded(load_position(tri.x), load_position(tri.y), load_position(tri.z)) == 0;
}

fn edge_is_uncertain(tri: vec3u, k: u32, e: u32, infinite: u32) -> bool {
    let at_infinity = tri == vec3u(infinite);
    if e == infinite || at_infinity[k] {
        return false;
    }
    if any(at_infinity) {
        let beyond = select(tri, vec3u(e), at_infinity);
        return orientation_filter(beyond) == 0 && is_uncertain(beyond);
    }
    return (any_rounded(tri) || rounded(e))
        && incircle_filter(load_high(tri.x), load_high(tri.y), load_high(tri.z), load_high(e)) == 0
        && incircle_rounded(load_position(tri.x), load_position(tri.y), load_position(tri.z), load_position(e)) == 0;
}

fn input_index(v: u32) -> u32 {
    var index = v;
    if v != control.infinite {
        index = pairs[v].y;
    }
    return index;
}

fn add_test(tri: vec3u, beyond: u32) {
    let at = atomicAdd(&control.uncertain, 1u);
    if at < control.blocks * BLOCK {
        uncertain_tests[at] = UncertainTest(vec3u(input_index(tri.x), input_index(tri.y), input_index(tri.z)), beyond);
    }
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let infinite = control.infinite;
    let certain = counts[COUNT_ROUNDED] == 0;
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        let tri = simplices[t].xyz;
        let used = any(tri != vec3u(0));
        var kept = used && !any(tri == vec3u(infinite));
        if kept && orientation_filter(tri) <= 0 {
            let sign = orient2d_exact(load_position(tri.x), load_position(tri.y), load_position(tri.z));
            kept = sign != 0;
            if sign < 0 {
                atomicAdd(&control.failed, 1u);
            }
            if is_uncertain(tri) {
                add_test(tri, select(FLAT, COUNTER_CLOCKWISE, kept));
            }
        }
        marks[t] = u32(kept);
        if used && !certain {
            let near = neighbors[t];
            for (var k = 0u; k < 3; k++) {
                let u = near[k] >> 2;
                let e = simplices[u][near[k] & 3];
                if u > t && edge_is_uncertain(tri, k, e, infinite) {
                    add_test(vec3u(tri[k], tri[(k + 1) % 3], tri[(k + 2) % 3]), input_index(e));
                }
            }
        }
    }
}

// Counts the points that have one of their simplices, and copies some simplices for the host, which knows what is exact.
// One invocation per point, and per sample.
//!include {dim}/simplex
//!include common/check_params
@group(0) @binding(0) var<storage, read> check_params: CheckParams;
// CORNERS words per simplex.
@group(0) @binding(1) var<storage, read> corners: array<u32>;
// The tetrahedra across the facets; in 2D the half-edges against those of the triangle. NONE on the hull.
@group(0) @binding(2) var<storage, read> across: array<u32>;
// A simplex of each point, or NONE.
@group(0) @binding(3) var<storage, read> vertex_simplices: array<u32>;
@group(0) @binding(4) var<storage, read_write> checked: array<atomic<u32>>;

var<workgroup> vertices_here: atomic<u32>;

fn has_corner(t: u32, v: u32) -> bool {
    var has = false;
    for (var k = 0u; k < CORNERS; k++) {
        has = has || corners[CORNERS * t + k] == v;
    }
    return has;
}

fn sum_of(t: u32) -> u32 {
    var sum = 0u;
    for (var k = 0u; k < CORNERS; k++) {
        sum += corners[CORNERS * t + k];
    }
    return sum;
}

fn copy_sample(t: u32, to: u32) {
    for (var k = 0u; k < CORNERS; k++) {
        atomicStore(&checked[to + k], corners[CORNERS * t + k]);
        let other = across[CORNERS * t + k];
        var apex = NONE;
        if other != NONE {
            // What the simplex across has beside the corners of the facet.
            let opposite = corners[CORNERS * t + select(k, (k + 2) % 3, CORNERS == 3)];
            apex = sum_of(select(other, other / 3, CORNERS == 3)) - (sum_of(t) - opposite);
        }
        atomicStore(&checked[to + CORNERS + k], apex);
    }
}

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0 {
        atomicStore(&vertices_here, 0u);
    }
    workgroupBarrier();
    for (var i = id.x; i * check_params.stride < check_params.count; i += groups.x * WORKGROUP) {
        copy_sample(i * check_params.stride, CHECK_WORDS + i * 2 * CORNERS);
    }
    var vertices = 0u;
    for (var v = id.x; v < check_params.points; v += groups.x * WORKGROUP) {
        let t = vertex_simplices[v];
        vertices += u32(t < check_params.count && has_corner(t, v));
    }
    atomicAdd(&vertices_here, vertices);
    workgroupBarrier();
    if local == 0 {
        atomicAdd(&checked[CHECK_VERTICES], atomicLoad(&vertices_here));
    }
}

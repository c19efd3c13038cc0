// Lists all points, and finds the simplex of the start that each lies in: one walks there from a
// simplex nearby. One invocation per point.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
//!include common/pairs
// For each stretch of vertices the slot of a simplex, plus 1; 0 where there is none.
@group(0) @binding(3) var<storage, read> start_near: array<u32>;
@group(0) @binding(4) var<storage, read> start_vertices: array<u32>;
@group(0) @binding(5) var<storage, read_write> waiting: array<Waiting>;
@group(0) @binding(6) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(7) var<storage, read> neighbors: array<vec4u>;
//!include common/start_slots
//!include {dim}/signs

// The most steps of a walk. A walk in a Delaunay triangulation ends; but where points lie on a
// sphere, ties are broken in ways in which it might not. Then all simplices are looked at in turn,
// and the walk is counted.
const MAX_STEPS: u32 = 1024;

// Returns a simplex near vertex p.
fn near(p: u32) -> u32 {
    let stretches = (control.infinite + control.start_stride - 1) / control.start_stride;
    var at = p / control.start_stride;
    var slot = start_near[at];
    for (var i = 1u; i < stretches && slot == 0; i++) {
        at = select(at, stretches, at == 0) - 1;
        slot = start_near[at];
    }
    return slot - 1;
}

// Returns the simplex that holds vertex p; NONE if p is one of the corners of the start.
fn holding(p: u32) -> u32 {
    var t = near(p);
    var came = CORNERS;
    for (var step = 1u; step <= MAX_STEPS + control.start_simplices; step++) {
        let simplex = unpacked(simplices[t]);
        if any(simplex == Simplex(p)) {
            return NONE;
        }
        var beyond = CORNERS;
        let corners = not_unrolled(CORNERS);
        for (var k = 0u; k < corners && beyond == CORNERS; k++) {
            if k != came && orient(replaced(simplex, k, p)) < 0 {
                beyond = k;
            }
        }
        if beyond == CORNERS {
            return t;
        }
        if step == MAX_STEPS {
            atomicAdd(&control.long_walks, 1u);
        }
        if step < MAX_STEPS {
            let across = neighbors[t][beyond];
            t = across >> 2;
            came = across & 3;
        } else {
            t = start_slot(min(step - MAX_STEPS, control.start_simplices - 1));
            came = CORNERS;
        }
    }
    return t;
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var p = id.x; p < control.infinite; p += groups.x * WORKGROUP) {
        var t = NONE;
        if pairs[p].x != MERGED_KEY {
            t = holding(p);
        }
        waiting[p] = Waiting(p, t);
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
}

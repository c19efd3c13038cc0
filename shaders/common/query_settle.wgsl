// Goes on with the walks of query_walk where the filter does not decide: by exact signs. A query
// that lies on a facet is in several simplices; the answer is the one whose vertices come first if
// they are sorted. One invocation per query of the list.
//
// What rounding to the lattice leaves open, and what has too many simplices around it, is left to
// the host. So are walks that the device ends: some drivers limit the steps of loops, and what was
// not tested is not taken for decided.
//!include common/query
@group(0) @binding(1) var<storage, read> input: array<u32>;
@group(0) @binding(2) var<storage, read> vertices: array<VertexWords>;
//!include {dim}/query_simplices
//!include {dim}/query_neighbors
@group(0) @binding(6) var<storage, read_write> answers: array<u32>;
@group(0) @binding(7) var<storage, read> undecided: array<u32>;
//!include {dim}/query_signs
//!include {dim}/query_exact

// The simplices around a query.
const MAX_AROUND: u32 = 96;

// Returns the answer for a query on a facet of simplex t, which contains it.
fn first_around(t: u32, query: Query) -> u32 {
    var around: array<u32, MAX_AROUND>;
    var first = t;
    around[0] = t;
    var len = 1u;
    var tested = 0u;
    for (var i = 0u; i < len * CORNERS; i++) {
        let u = around[i / CORNERS];
        let k = i % CORNERS;
        let side = exact_side(u, k, query);
        if side == UNKNOWN {
            return OPEN;
        }
        tested++;
        let next = across(u, k);
        if side != 0 || next < 0 {
            continue;
        }
        var is_new = true;
        for (var j = 0u; j < len; j++) {
            is_new &= around[j] != u32(next);
        }
        if is_new {
            if len == MAX_AROUND {
                return OPEN;
            }
            around[len] = u32(next);
            len++;
            if comes_before(u32(next), first) {
                first = u32(next);
            }
        }
    }
    return select(OPEN, first, tested == len * CORNERS);
}

// Walks on from simplex t, and returns the answer.
fn walked(start: u32, query: Query) -> u32 {
    let max_steps = params.max_steps;
    var t = start;
    for (var steps = 0u; steps < max_steps; steps++) {
        let sides = filtered_sides(t, query.high);
        var on_facet = false;
        var crossed = CORNERS;
        var tested = 0u;
        for (var k = 0u; k < CORNERS && crossed == CORNERS; k++) {
            var side = side_of(sides, k);
            if side == 0 {
                side = exact_side(t, k, query);
            }
            if side == UNKNOWN {
                return OPEN;
            }
            tested++;
            on_facet |= side == 0;
            if side < 0 {
                crossed = k;
            }
        }
        if crossed == CORNERS {
            if tested < CORNERS {
                return OPEN;
            }
            if on_facet {
                return first_around(t, query);
            }
            return t;
        }
        let next = across(t, crossed);
        if next < 0 {
            return ~(4 * t + facet_number(crossed));
        }
        t = u32(next);
    }
    return OPEN;
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let count = atomicLoad(&params.undecided);
    for (var i = id.x; i < count; i += groups.x * WORKGROUP) {
        let query = undecided[i];
        let answer = walked(answers[query], query_at(lattice_point(query)));
        answers[query] = answer;
        if answer == OPEN {
            atomicAdd(&params.open, 1u);
        }
    }
}

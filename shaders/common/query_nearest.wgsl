// Walks along edges to the vertex nearest to each query, as src/derived/nearest.rs does: every
// vertex that is not nearest has a neighbour that is nearer. Of several at the same distance, which
// are connected, the answer is the lowest. One invocation per query.
//
// What rounding to the lattice leaves open, and where too many vertices are nearest, is left to the
// host, as are walks that the device ends: some drivers limit the steps of loops.
//!include common/query
@group(0) @binding(1) var<storage, read> input: array<u32>;
@group(0) @binding(2) var<storage, read> vertices: array<VertexWords>;
//!include {dim}/query_simplices
@group(0) @binding(4) var<storage, read> ring_offsets: array<u32>;
@group(0) @binding(5) var<storage, read> starts: array<vec2u>;
@group(0) @binding(6) var<storage, read> ring: array<u32>;
@group(0) @binding(7) var<storage, read_write> answers: array<u32>;
//!include common/query_near
//!include common/query_start
//!include {dim}/query_exact
//!include common/query_distances

const MAX_NEAREST: u32 = 64;

// Returns the lowest of the vertices as near as v, which is nearest.
fn lowest_nearest(v: u32, query: Query) -> u32 {
    var nearest: array<u32, MAX_NEAREST>;
    nearest[0] = v;
    var lowest = v;
    var len = 1u;
    // The vertex whose ring is looked at, by its place in the list, and what is left of the ring.
    var next = 0u;
    var i = ring_offsets[v];
    var end = ring_offsets[v + 1];
    while next < len {
        if i == end {
            next++;
            if next < len {
                i = ring_offsets[nearest[next]];
                end = ring_offsets[nearest[next] + 1];
            }
            continue;
        }
        let w = ring[i];
        i++;
        let order = compare_distances(w, v, query);
        if order == UNKNOWN {
            return OPEN;
        }
        var is_new = order == 0;
        for (var j = 0u; j < len; j++) {
            is_new &= nearest[j] != w;
        }
        if is_new {
            if len == MAX_NEAREST {
                return OPEN;
            }
            nearest[len] = w;
            len++;
            lowest = min(lowest, w);
        }
    }
    return select(OPEN, lowest, next == len);
}

fn nearest_from(start: u32, query: Query) -> u32 {
    let max_steps = params.max_steps;
    var best = start;
    for (var steps = 0u; steps < max_steps; steps++) {
        let at = best;
        var is_tied = false;
        let end = ring_offsets[at + 1];
        var i = ring_offsets[at];
        for (; i < end; i++) {
            let v = ring[i];
            let order = compare_distances(v, best, query);
            if order == UNKNOWN {
                return OPEN;
            }
            if order < 0 {
                best = v;
            }
            is_tied |= order == 0;
        }
        if i < end {
            return OPEN;
        }
        if best == at {
            if is_tied {
                return lowest_nearest(best, query);
            }
            return best;
        }
    }
    return OPEN;
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var query = id.x; query < params.count; query += groups.x * WORKGROUP) {
        var answer = OPEN;
        if is_near(query) {
            answer = nearest_from(corner(start_of(query), 0), query_at(lattice_point(query)));
        }
        answers[query] = answer;
        if answer == OPEN {
            atomicAdd(&params.open, 1u);
        }
    }
}

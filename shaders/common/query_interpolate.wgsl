// Interpolates values at the vertices linearly, at queries that are located. One invocation per
// query.
//
// The barycentric coordinates are quotients of exact determinants, converted to f32 with a relative
// error of some roundings, however flat the simplex is; the query is its place on the lattice. The
// conversion neither overflows nor underflows: see {dim}/query_measures.
//!include common/query
@group(0) @binding(1) var<storage, read> input: array<u32>;
@group(0) @binding(2) var<storage, read> vertices: array<VertexWords>;
//!include {dim}/query_simplices
// The output of query_walk and query_settle; the host has answered what they left open.
@group(0) @binding(4) var<storage, read> answers: array<u32>;
// One per point.
@group(0) @binding(5) var<storage, read> values: array<f32>;
// The bits of the results: WGSL has no NaN.
@group(0) @binding(6) var<storage, read_write> results: array<u32>;
//!include {dim}/query_measures

const NAN: u32 = 0x7fc00000;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var query = id.x; query < params.count; query += groups.x * WORKGROUP) {
        let t = answers[query];
        if (t >> 31) != 0 {
            results[query] = NAN;
            continue;
        }
        let place = query_at(lattice_point(query));
        var measures: array<f32, 4>;
        var sum = 0.0;
        for (var k = 0u; k < CORNERS; k++) {
            // Rounding may have moved the query across a facet on which it lies nearly.
            let measure = max(measure_beside(t, k, place), 0.0);
            measures[k] = measure;
            sum += measure;
        }
        var value = 0.0;
        for (var k = 0u; k < CORNERS; k++) {
            // A weight of 0 does not spread NaN and infinities, and that of 1 is one.
            let measure = measures[k];
            if measure == sum {
                value = values[corner(t, k)];
            } else if measure != 0.0 {
                value += measure / sum * values[corner(t, k)];
            }
        }
        results[query] = bitcast<u32>(value);
    }
}

// Walks to the simplex that contains each query (Devillers, Pion and Teillaud, *Walking in a
// triangulation*, 2002), as src/derived/locate.rs does, as far as the filter decides. One
// invocation per query.
//
// The walk starts at the same simplex as on the host and crosses the first facet that separates it
// from the query. So it ends at the same facet of the hull, if it leaves there.
//!include common/query
@group(0) @binding(1) var<storage, read> input: array<u32>;
@group(0) @binding(2) var<storage, read> vertices: array<VertexWords>;
//!include {dim}/query_simplices
//!include {dim}/query_neighbors
@group(0) @binding(5) var<storage, read> starts: array<vec2u>;
// The answers: a simplex t, ~(4 t + f) for its facet f of the hull, or OPEN; the simplex where the
// walk is, for queries in `undecided`.
@group(0) @binding(6) var<storage, read_write> answers: array<u32>;
@group(0) @binding(7) var<storage, read_write> undecided: array<u32>;
//!include common/query_near
//!include common/query_start
//!include {dim}/query_signs

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let max_steps = params.max_steps;
    for (var query = id.x; query < params.count; query += groups.x * WORKGROUP) {
        if !is_near(query) {
            answers[query] = OPEN;
            atomicAdd(&params.open, 1u);
            continue;
        }
        let place = high_words(lattice_point(query));
        var t = start_of(query);
        var answer = OPEN;
        var is_undecided = false;
        for (var steps = 0u; steps < max_steps; steps++) {
            let sides = filtered_sides(t, place);
            let k = first_not_positive(sides);
            if k == CORNERS {
                answer = t;
                break;
            }
            if side_of(sides, k) == 0 {
                is_undecided = true;
                break;
            }
            let next = across(t, k);
            if next < 0 {
                answer = ~(4 * t + facet_number(k));
                break;
            }
            t = u32(next);
        }
        if is_undecided {
            answers[query] = t;
            undecided[atomicAdd(&params.undecided, 1u)] = query;
        } else {
            answers[query] = answer;
            if answer == OPEN {
                atomicAdd(&params.open, 1u);
            }
        }
    }
}

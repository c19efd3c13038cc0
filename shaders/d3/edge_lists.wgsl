// Which tetrahedron lists an edge: the lowest that has it, as Mesh3::edges does.
//!include d3/query_neighbors
//!include d3/mesh_edges

const EDGES: u32 = 6;

// Returns what is across one of the two facets of t at an edge: the one that does not lead to `before`.
fn onwards(t: u32, ends: vec2u, before: i32) -> i32 {
    let next = neighbors[t];
    let is_facet = (simplices[t] != vec4u(ends.x)) & (simplices[t] != vec4u(ends.y)) & (next != vec4i(before));
    return select(select(select(select(-1, next.x, is_facet.x), next.y, is_facet.y), next.z, is_facet.z), next.w, is_facet.w);
}

// Returns whether no tetrahedron around an edge has a lower index than t: both ways around it, each
// until it leaves the hull; where it does not, the first way comes back.
fn lists(t: u32, e: u32) -> bool {
    let corners = edge_corners(e);
    let ends = edge(t, e);
    for (var enter = 0u; enter < 4; enter++) {
        if enter == corners.x || enter == corners.y {
            continue;
        }
        var before = t;
        var at = across(t, enter);
        // On wrong neighbours, no device hangs.
        for (var steps = 0u; steps < arrayLength(&simplices) && at >= 0 && u32(at) != t; steps++) {
            let here = u32(at);
            if here < t {
                return false;
            }
            at = onwards(here, ends, i32(before));
            before = here;
        }
        if u32(at) == t {
            return true;
        }
    }
    return true;
}

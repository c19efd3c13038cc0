// Which tetrahedron lists an edge: the lowest that has it, as Mesh3::edges does.
//!include d3/query_neighbors
//!include d3/mesh_edges

const EDGES: u32 = 6;

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
        while at >= 0 && u32(at) != t {
            let here = u32(at);
            if here < t {
                return false;
            }
            // Of the two facets at the edge, the one that was not come through.
            at = -1;
            for (var k = 0u; k < 4; k++) {
                let v = corner(here, k);
                let next = across(here, k);
                if v != ends.x && v != ends.y && next != i32(before) {
                    at = next;
                }
            }
            before = here;
        }
        if u32(at) == t {
            return true;
        }
    }
    return true;
}

// Which triangle lists an edge: the lower one that has it, as Mesh2::edges does.
//!include d2/query_neighbors

const EDGES: u32 = 3;

fn lists(t: u32, e: u32) -> bool {
    // The edge is opposite the vertex before its first one.
    let next = across(t, select(e - 1, 2u, e == 0));
    return next < 0 || t < u32(next);
}

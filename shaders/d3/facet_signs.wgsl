// What the filter tells about a facet.
//
// Expects: simplices; what d3/signs_filtered does.
//!include d3/signs_filtered

// Returns in how many of its edges the tetrahedra on both sides of facet k of t meet in a reflex angle,
// of which two are enough to know, and from bit 2 on the last of those; LOCALLY_DELAUNAY if the facet is,
// which may be known not to be so; UNDECIDED if a sign is undecided. Vertex e lies across the facet.
fn facet_signs(t: u32, tet: vec4u, k: u32, e: u32, is_violated: bool) -> u32 {
    if !is_violated {
        let sign = conflict(tet, e);
        if sign <= 0 {
            return select(LOCALLY_DELAUNAY, UNDECIDED, sign == 0);
        }
    }
    let c = facet(k);
    let apex = simplices[t][k];
    var x = vec3u(simplices[t][c.x], simplices[t][c.y], simplices[t][c.z]);
    var negative = 0u;
    var edge = 0u;
    for (var j = 0u; j < 3 && negative < 2; j++) {
        let sign = orient(vec4u(x.x, x.y, apex, e));
        x = x.yzx;
        if sign == 0 {
            return UNDECIDED;
        }
        if sign < 0 {
            negative += 1;
            edge = j;
        }
    }
    return negative | (edge << 2);
}

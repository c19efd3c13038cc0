// The signs of a facet, as far as the filter decides.
//
// Expects: simplices; what d3/signs_filtered does.
//!include d3/signs_filtered

// Returns LOCALLY_DELAUNAY if facet k of t is, and UNDECIDED if a sign is undecided. Otherwise returns in how
// many edges of the facet the tetrahedra on both sides meet in a reflex angle, at most two, and from bit 2
// on the last of these edges. Vertex e lies across the facet. If `is_violated`, the facet is known not to
// be locally Delaunay.
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

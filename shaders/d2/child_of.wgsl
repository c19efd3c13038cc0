// Returns which child of a triangle, split at p, holds q, by 2 orientations.
//
// The rays from p to the corners divide the triangle. On each side of the line through the first ray
// there are two children; the ray between them decides. `infinite` is infinity's number, or NONE where
// that number stands for the interior point.
//
// Expects: orient_finite of d2/signs.
fn child_of(tri: vec3u, p: u32, q: u32, infinite: u32) -> u32 {
    var before = false;
    var child = 0u;
    for (var step = 0; step < 2; step++) {
        let ray = select(select(2u, 1u, before), 0u, step == 0);
        let three = vec3u(p, tri[ray], q);
        let left = (orient_finite(three) > 0) != any(three == vec3u(infinite));
        // Left of the first ray lie children 2 and 0, parted by ray 1; right of it 1 and 0, parted
        // by ray 2.
        child = select(select(0u, 1u, left), select(2u, 0u, left), before);
        before = left;
    }
    return child;
}

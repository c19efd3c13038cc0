//!include common/layout
//!include common/mixed

// Returns a hash of the facet with these corners, counter-clockwise as seen from outside of the tetrahedron. The same
// facet as the tetrahedron across sees it has the negative hash.
fn facet_hash(corners: vec3u, own: u32, across: u32) -> u32 {
    let hash = mixed((mixed(corners.x) + mixed(corners.y) + mixed(corners.z)) ^ sides_hash(own, across));
    let is_odd = (corners.x > corners.y) != ((corners.y > corners.z) != (corners.x > corners.z));
    return select(hash, 0 - hash, is_odd);
}

//!include common/layout
//!include common/mixed

// Returns a hash of the half-edge between these vertices. The one that runs against it has the negative hash.
fn facet_hash(ends: vec2u, own: u32, across: u32) -> u32 {
    let hash = mixed((mixed(ends.x) + mixed(ends.y)) ^ sides_hash(own, across));
    return select(hash, 0 - hash, ends.x > ends.y);
}

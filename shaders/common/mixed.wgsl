// A hash of a word: two words are as likely as any to have hashes that differ by some number.
fn mixed(word: u32) -> u32 {
    let h = (word + 1) * 0x9e3779b1u;
    let g = (h ^ (h >> 15)) * 0x85ebca77u;
    return g ^ (g >> 13);
}

// Returns the same hash for both sides of a facet: `own` and `across` are where it is found, NONE outside.
fn sides_hash(own: u32, across: u32) -> u32 {
    return select(mixed(min(own, across) ^ mixed(max(own, across))), 0, across == NONE);
}

// Nothing is rounded to a narrow lattice.
fn rounded(v: u32) -> bool {
    return false;
}

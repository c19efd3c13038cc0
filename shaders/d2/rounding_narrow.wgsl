// Nothing is rounded to a narrow lattice: the signs are those of the true coordinates.
//
// Expects: d2/predicates.

fn rounded(v: u32) -> bool {
    return false;
}

fn orient2d_rounded(a: Position, b: Position, c: Position) -> i32 {
    return orient2d_exact(a, b, c);
}

fn incircle_rounded(a: Position, b: Position, c: Position, d: Position) -> i32 {
    return sign_of_volume(incircle_volume(difference(a, d), difference(b, d), difference(c, d)));
}

// The areas of the triangles of a query and the edges of the one that contains it.
//
// A determinant is an integer of 128 bits, below 2^125. Limb i counts 2^(32 i − 64), so that no
// result is below 2^-64, except 0, or above 2^61. Converting four limbs and adding them up rounds
// seven times.
//!include d2/query_rows

fn measure_beside(t: u32, k: u32, query: Query) -> f32 {
    let f = facet_of(t, k);
    let value = determinant(row_to(f.x, query), row_to(f.y, query));
    if sign_of_determinant(value) <= 0 {
        return 0;
    }
    let limbs = vec4f(value.limbs) * vec4f(0x1p-64, 0x1p-32, 1, 0x1p32);
    return (limbs.x + limbs.y) + (limbs.z + limbs.w);
}

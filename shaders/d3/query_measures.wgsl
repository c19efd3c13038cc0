// The volumes of the tetrahedra of a query and the facets of the one that contains it.
//
// A determinant is an integer of 192 bits, below 2^188. Limb i counts 2^(32 i − 96), so that no
// result is below 2^-96, except 0, or above 2^92. Converting six limbs and adding them up rounds
// eleven times.
//!include d3/query_rows

fn measure_beside(t: u32, k: u32, query: Query) -> f32 {
    let f = facet_of(t, k);
    let value = determinant(row_to(f.x, query), row_to(f.y, query), row_to(f.z, query));
    if sign_of_determinant(value) <= 0 {
        return 0;
    }
    let low = vec4f(value.low) * vec4f(0x1p-96, 0x1p-64, 0x1p-32, 1);
    let high = vec2f(value.high) * vec2f(0x1p32, 0x1p64);
    return (low.x + low.y) + (low.z + low.w) + (high.x + high.y);
}

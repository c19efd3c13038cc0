// The words of a vertex; src/d2/gpu/vertex.rs explains them.
//
// Expects: params.
@group(0) @binding(3) var<storage, read_write> vertices: array<vec2u>;

fn write_vertex(v: u32, point: u32, place: LatticePoint) {
    if params.width > 31 {
        vertices[2 * v] = place.high.xy;
        vertices[2 * v + 1] = place.low.xy | vec2u(select(0x80000000u, 0u, place.exact), 0);
    } else {
        vertices[v] = place.high.xy;
    }
}

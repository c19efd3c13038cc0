// The words of a vertex; src/d3/gpu/vertex.rs explains them.
//
// Expects: params.
@group(0) @binding(3) var<storage, read_write> vertices: array<vec4i>;

fn write_vertex(v: u32, point: u32, place: LatticePoint) {
    if params.width > 31 {
        vertices[2 * v] = vec4i(vec3i(place.high), i32(point));
        vertices[2 * v + 1] = vec4i(vec3i(place.low), i32(!place.exact));
    } else {
        vertices[v] = vec4i(vec3i(place.high), i32(point));
    }
}

// The sort key and the input index of each vertex.
@group(0) @binding(2) var<storage, read> pairs: array<vec2u>;

// Writes the edges in the order of the simplices that list them, and for both of its directions a
// pair of the vertex that it leads to and the one that it comes from. One invocation per simplex.
//!include primitives/workgroup
//!include {dim}/mesh_edges
// The output of edges_mark, and the numbers of the edges before those of each simplex.
@group(0) @binding(0) var<storage, read> listed: array<u32>;
@group(0) @binding(1) var<storage, read> offsets: array<u32>;
@group(0) @binding(2) var<storage, read_write> edges: array<vec2u>;
@group(0) @binding(5) var<storage, read_write> pairs: array<vec2u>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < arrayLength(&listed); t += groups.x * WORKGROUP) {
        var at = offsets[t];
        for (var bits = listed[t]; bits != 0; bits &= bits - 1) {
            let ends = edge(t, firstTrailingBit(bits));
            edges[at] = ends;
            pairs[2 * at] = ends;
            pairs[2 * at + 1] = ends.yx;
            at++;
        }
    }
}

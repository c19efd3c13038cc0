// Writes what splaying changed back into the mesh. The patch is in the buffers of gathered tetrahedra.
// One invocation per entry.
//!include common/layout
//!include d3/gathering
@group(0) @binding(0) var<storage, read> gathering: Gathering;
@group(0) @binding(1) var<storage, read> gathered_slots: array<u32>;
@group(0) @binding(2) var<storage, read> gathered_tetrahedra: array<vec4u>;
@group(0) @binding(3) var<storage, read> gathered_neighbors: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> mesh_tetrahedra: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> mesh_neighbors: array<vec4u>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < gathering.patched; i += groups.x * WORKGROUP) {
        let t = gathered_slots[i];
        let near = gathered_neighbors[i];
        mesh_tetrahedra[t] = gathered_tetrahedra[i];
        mesh_neighbors[t] = select(near, mesh_neighbors[t], near == vec4u(KEEP));
    }
}

// Notes the vertices of the tetrahedra of the mesh that have a wanted vertex. One invocation per slot.
//!include common/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
// The last entry is the number of finite tetrahedra.
@group(0) @binding(1) var<storage, read> sums: array<u32>;
@group(0) @binding(2) var<storage, read> mesh_tetrahedra: array<vec4u>;
@group(0) @binding(3) var<storage, read> wanted: array<u32>;
// A bit per point, too.
@group(0) @binding(4) var<storage, read_write> wider: array<atomic<u32>>;
//!include d3/wanted

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let len = sums[arrayLength(&sums) - 1] + atomicLoad(&control.ghosts);
    for (var t = id.x; t < len; t += groups.x * WORKGROUP) {
        let tet = mesh_tetrahedra[t];
        if has_wanted(tet) {
            for (var k = 0u; k < 4; k++) {
                if tet[k] != control.infinite {
                    atomicOr(&wider[tet[k] >> 5], 1u << (tet[k] & 31));
                }
            }
        }
    }
}

// Lists the tetrahedra again that have a facet that could not be flipped, where the points of a mesh
// have moved: beside an inverted tetrahedron a flip may have had to wait for one that changed neither
// side of its facet. One invocation per slot.
//!include d3/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(3) var<storage, read_write> status: array<OwnedStatus>;
@group(0) @binding(4) var<storage, read_write> actives: array<Active>;
//!include common/bids

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let half = control.iteration & 1;
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        let flags = status[t].made.x;
        let suspect = (flags >> SUSPECT_SHIFT) & CHECK;
        if suspect != 0 {
            status[t].made.x = (flags & ~(CHECK << SUSPECT_SHIFT)) | suspect;
            // Else it is listed.
            if (flags & CHECK) == 0 {
                actives[half_of(control.iteration) + atomicAdd(&control.active_len[half], 1u)] = Active(t, 0);
            }
        }
    }
}

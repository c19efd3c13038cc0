// Lists the simplices with a facet that is not locally Delaunay where their points are now, or of
// which the filter does not decide that. The facets of inverted simplices are to be checked in any
// case. One invocation per simplex or ghost; of two at a facet, the one in the lower slot has it.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(3) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(4) var<storage, read> neighbors: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> status: array<Status>;
@group(0) @binding(6) var<storage, read_write> actives: array<Active>;
//!include common/moved_slots
//!include {dim}/moved_facets

var<workgroup> listed: atomic<u32>;
var<workgroup> violated: atomic<u32>;
var<workgroup> given: u32;
var<workgroup> checked: u32;

fn is_inverted(t: u32) -> bool {
    return (atomicLoad(&status[t].flags) & INVERTED) != 0;
}

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0 {
        checked = control.moved_simplices + control.moved_ghosts;
    }
    // The loop has barriers, and so its bound has to be uniform in the compiler's eyes.
    let count = workgroupUniformLoad(&checked);
    for (var start = group.x * WORKGROUP; start < count; start += groups.x * WORKGROUP) {
        if local == 0 {
            atomicStore(&listed, 0u);
            atomicStore(&violated, 0u);
            given = 0;
        }
        workgroupBarrier();
        var check = 0u;
        var certain = 0u;
        let slot = moved_slot(start + local);
        if start + local < count && !is_inverted(slot) {
            let simplex = unpacked(simplices[slot]);
            for (var k = 0u; k < CORNERS; k++) {
                let across = neighbors[slot][k];
                let u = across >> 2;
                if u < slot || is_inverted(u) {
                    continue;
                }
                let sign = violation(simplex, simplices[u][across & 3]);
                check |= select(0u, 1u << k, sign >= 0);
                certain += select(0u, 1u, sign > 0);
            }
        }
        var at = 0u;
        if check != 0 {
            at = atomicAdd(&listed, 1u);
            atomicAdd(&violated, certain);
        }
        workgroupBarrier();
        if local == 0 && atomicLoad(&listed) != 0 {
            given = atomicAdd(&control.active_len[0], atomicLoad(&listed));
            atomicAdd(&control.violated, atomicLoad(&violated));
        }
        at += workgroupUniformLoad(&given);
        if check != 0 {
            atomicStore(&status[slot].flags, check);
            actives[at] = Active(slot, 0);
        }
    }
}

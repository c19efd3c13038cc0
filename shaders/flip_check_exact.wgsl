// Checks the facets of the active tetrahedra that the filter left open (§4.4). One invocation an entry of their list.
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(6) var<storage, read> open_entries: array<u32>;
//!include shared/check_facets
//!include shared/signs

var<workgroup> exact_here: atomic<u32>;

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.iteration;
    let list = half_of(iteration);
    let bits = control.bid_bits;
    let open = atomicLoad(&control.open);
    for (var j = id.x; j < open; j += groups.x * 256) {
        let i = open_entries[j];
        // No sign is open here.
        _ = check_facets(i, list + i, iteration, bits);
    }
    if local == 0 {
        atomicStore(&exact_here, 0u);
    }
    workgroupBarrier();
    if exact_signs != 0 {
        atomicAdd(&exact_here, exact_signs);
    }
    workgroupBarrier();
    if local == 0 && atomicLoad(&exact_here) != 0 {
        atomicAdd(&control.exact, atomicLoad(&exact_here));
    }
}

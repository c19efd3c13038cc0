// Checks the facets of the active tetrahedra that the filter left open (§4.4). One or four invocations an entry of their list.
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(6) var<storage, read> open_entries: array<u32>;
//!include shared/check_facets
//!include shared/signs

var<workgroup> open_here: u32;
var<workgroup> exact_here: atomic<u32>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.iteration;
    let list = half_of(iteration);
    let bits = control.bid_bits;
    if local == 0 {
        open_here = atomicLoad(&control.undecided);
        atomicStore(&exact_here, 0u);
    }
    let open = workgroupUniformLoad(&open_here);
    let lanes = sharing(open, groups.x);
    let step = groups.x * 256 / lanes;
    for (var start = group.x * 256 / lanes; start < open; start += step) {
        let j = start + local / lanes;
        var i = 0u;
        if j < open {
            i = open_entries[j];
        }
        // No sign is open here.
        _ = check_facets(j < open, i, list + i, iteration, bits, local, lanes);
        workgroupBarrier();
    }
    if exact_signs != 0 {
        atomicAdd(&exact_here, exact_signs);
    }
    workgroupBarrier();
    if local == 0 && atomicLoad(&exact_here) != 0 {
        atomicAdd(&control.exact, atomicLoad(&exact_here));
    }
}

// Checks the facets of the active tetrahedra that the filter did not decide (§4.4). One or four
// invocations per entry of their list.
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(6) var<storage, read> undecided_entries: array<u32>;
//!include d3/check_facets
//!include d3/signs

var<workgroup> undecided_here: u32;
var<workgroup> exact_here: atomic<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.iteration;
    let list = half_of(iteration);
    let bits = control.bid_bits;
    if local == 0 {
        undecided_here = atomicLoad(&control.undecided);
        atomicStore(&exact_here, 0u);
    }
    let undecided = workgroupUniformLoad(&undecided_here);
    let lanes = sharing(undecided, groups.x);
    let step = groups.x * WORKGROUP / lanes;
    for (var start = group.x * WORKGROUP / lanes; start < undecided; start += step) {
        let j = start + local / lanes;
        var i = 0u;
        if j < undecided {
            i = undecided_entries[j];
        }
        // No sign is undecided here.
        _ = check_facets(j < undecided, i, list + i, iteration, bits, local, lanes);
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

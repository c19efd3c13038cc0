// Checks the facets of each active tetrahedron as far as the filter decides (§4.4), and lists the
// undecided entries for flip_check_exact. Where that does not follow, they stay active. One or four
// invocations per entry of the active list.
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
// The entries with undecided signs.
@group(0) @binding(6) var<storage, read_write> undecided_entries: array<u32>;
//!include d3/check_facets
//!include d3/signs_filtered

var<workgroup> entries_here: u32;
var<workgroup> undecided_here: atomic<u32>;
var<workgroup> first_here: u32;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.iteration;
    if local == 0 {
        entries_here = entries_of(iteration);
    }
    let entries = workgroupUniformLoad(&entries_here);
    let list = half_of(iteration);
    let bits = control.bid_bits;
    let lanes = sharing(entries, groups.x);
    let step = groups.x * WORKGROUP / lanes;
    for (var start = group.x * WORKGROUP / lanes; start < entries; start += step) {
        if local == 0 {
            atomicStore(&undecided_here, 0u);
        }
        workgroupBarrier();
        let i = start + local / lanes;
        var place = NONE;
        let decided = check_facets(i < entries, i, list + i, iteration, bits, local, lanes);
        if !decided && local % lanes == 0 {
            place = atomicAdd(&undecided_here, 1u);
        }
        workgroupBarrier();
        if local == 0 && atomicLoad(&undecided_here) != 0 {
            first_here = atomicAdd(&control.undecided, atomicLoad(&undecided_here));
        }
        workgroupBarrier();
        if place != NONE {
            undecided_entries[first_here + place] = i;
        }
    }
    if local == 0 && group.x == 0 && entries != 0 {
        control.iterations += 1;
        control.visits += entries;
    }
}

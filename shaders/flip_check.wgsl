// Checks the facets of each active tetrahedron as far as the filter decides (§4.4), and lists the entries that it leaves to
// flip_check_exact. Where that does not follow, they stay active. One or four invocations an entry of the active list.
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
// The entries that are open.
@group(0) @binding(6) var<storage, read_write> open_entries: array<u32>;
//!include shared/check_facets
//!include shared/signs_filtered

var<workgroup> entries_here: u32;
var<workgroup> open_here: atomic<u32>;
var<workgroup> first_here: u32;

@compute @workgroup_size(256)
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
    let step = groups.x * 256 / lanes;
    for (var start = group.x * 256 / lanes; start < entries; start += step) {
        if local == 0 {
            atomicStore(&open_here, 0u);
        }
        workgroupBarrier();
        let i = start + local / lanes;
        var place = NONE;
        let decided = check_facets(i < entries, i, list + i, iteration, bits, local, lanes);
        if !decided && local % lanes == 0 {
            place = atomicAdd(&open_here, 1u);
        }
        workgroupBarrier();
        if local == 0 && atomicLoad(&open_here) != 0 {
            first_here = atomicAdd(&control.undecided, atomicLoad(&open_here));
        }
        workgroupBarrier();
        if place != NONE {
            open_entries[first_here + place] = i;
        }
    }
    if local == 0 && group.x == 0 && entries != 0 {
        control.iterations += 1;
        control.visits += entries;
    }
}

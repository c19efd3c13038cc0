// The first pass of a flip iteration, continued: checks the facets of the entries that the filter
// did not decide.
//
// Expects: control, simplices, neighbors, status, actives, messages; orient, conflict and
// exact_signs of d3/signs.
//!include d3/check_facets

var<workgroup> open_here: u32;
var<workgroup> exact_here: atomic<u32>;

// Checks the undecided entries, of which workgroup `group` of `groups` takes its share.
fn check_exact_pass(group: u32, groups: u32, local: u32, bids: Bids) {
    let list = half_of(bids.iteration);
    if local == 0 {
        open_here = atomicLoad(&control.undecided);
        atomicStore(&exact_here, 0u);
    }
    let undecided = workgroupUniformLoad(&open_here);
    let chunk = checked_together(undecided, groups);
    for (var start = group * chunk; start < undecided; start += groups * chunk) {
        let j = start + local;
        let has_entry = local < chunk && j < undecided;
        var i = 0u;
        if has_entry {
            i = messages[j].x;
        }
        // No sign is undecided here.
        _ = check_facets(has_entry, i, list + i, bids, local);
        workgroupBarrier();
    }
    if exact_signs != 0 {
        atomicAdd(&exact_here, exact_signs);
        exact_signs = 0;
    }
    workgroupBarrier();
    if local == 0 && atomicLoad(&exact_here) != 0 {
        atomicAdd(&control.exact, atomicLoad(&exact_here));
    }
}

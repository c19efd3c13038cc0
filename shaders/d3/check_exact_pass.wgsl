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
    let lanes = sharing(undecided, groups);
    let step = groups * WORKGROUP / lanes;
    for (var start = group * WORKGROUP / lanes; start < undecided; start += step) {
        let j = start + local / lanes;
        var i = 0u;
        if j < undecided {
            i = messages[j].x;
        }
        // No sign is undecided here.
        _ = check_facets(j < undecided, i, list + i, bids, local, lanes);
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

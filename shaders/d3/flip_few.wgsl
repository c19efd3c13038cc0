// Carries out flip iterations in one workgroup while few tetrahedra are active, without a dispatch
// per pass: no other workgroup touches the mesh, so that the barriers of a workgroup suffice.
//
// It ends when fewer tetrahedra are active than an iteration needs, when more are active than one
// workgroup should do, when slots or the history run out, or after `few_iterations`, because a
// dispatch must not take long.
//!include d3/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(2) var<storage, read_write> simplices: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> status: array<OwnedStatus>;
@group(0) @binding(5) var<storage, read_write> actives: array<Active>;
@group(0) @binding(6) var<storage, read_write> messages: array<vec4u>;
@group(0) @binding(7) var<storage, read_write> history: array<HistoryNode>;
//!include d3/facet_signs_once
//!include d3/check_pass
//!include common/commit_pass
//!include common/link_pass

// Every so many iterations, exact arithmetic decides what the filter has left open: one exact sign takes
// longer than all filters of an iteration. It does so in every iteration once the filter has left so large a
// share of the entries open, here or before.
const EXACT_EVERY: u32 = 4;
const EXACT_SHARE: u32 = 4;

var<workgroup> entries_here: u32;
var<workgroup> iteration_here: u32;
var<workgroup> base_here: u32;
var<workgroup> exact_due: bool;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(local_invocation_index) local: u32) {
    var always = atomicLoad(&control.exact) > control.visits / EXACT_SHARE;
    decides = always;
    var turn = 0u;
    loop {
        turn += 1;
        if local == 0 {
            iteration_here = control.iteration;
            base_here = control.bid_base;
            let entries = entries_of(iteration_here, base_here, max(control.min_active, 1));
            let ends = entries > control.few_limit || turn > control.few_iterations || atomicLoad(&control.overflow) != 0;
            entries_here = select(entries, 0u, ends);
        }
        let entries = workgroupUniformLoad(&entries_here);
        if entries == 0 {
            break;
        }
        let iteration = workgroupUniformLoad(&iteration_here);
        let base = workgroupUniformLoad(&base_here);
        let bids = bids_of(iteration, base, entries);

        check_pass(0, 1, local, bids, entries);
        passed();
        if local == 0 {
            let undecided = atomicLoad(&control.undecided);
            always = always || (undecided != 0 && undecided * EXACT_SHARE >= entries);
            exact_due = always || (undecided != 0 && turn % EXACT_EVERY == 0);
        }
        decides = workgroupUniformLoad(&exact_due);
        commit_pass(0, 1, local, bids, entries);
        passed();
        link_pass(0, 1, local, bids, entries);
        passed();
        if local == 0 {
            control.few_done += 1;
        }
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
}

// Waits until all invocations have ended a pass, and sees what they have written.
fn passed() {
    storageBarrier();
    workgroupBarrier();
}

// Begins a round: decides from the counters of the last one what its kernels do. One invocation.
//!include common/layout
//!include common/chunks
@group(0) @binding(0) var<storage, read_write> control: Control;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x != 0 {
        return;
    }
    let inserted = atomicLoad(&control.inserted);
    let waiting = control.infinite - inserted - control.merged;
    let is_far = atomicLoad(&control.inverted) > control.moved_inverted
        || atomicLoad(&control.violated) > control.moved_violated;
    if control.moved_simplices != 0 && is_far {
        // Too much of the mesh is wrong: no flips. The host inserts the points from scratch.
        atomicStore(&control.active_len[control.iteration & 1], 0u);
    }
    let is_exact = atomicLoad(&control.exact) > control.visits / WAITING_EXACT_SHARE;
    // A simplex with waiting points inserts one. Where points fill space evenly, most simplices have some; near a
    // surface, few have.
    let before = control.log[(control.round + LOGGED - 1) % LOGGED][0];
    let added = inserted - before;
    if control.pick != PICK_ADAPTIVE {
        control.criterion = control.pick;
    } else if before >= GROWTH_FROM && inserted <= control.infinite / GROWTH_SHARE {
        let is_even = before <= added / TWICE_GROWTH * 2 && !is_exact;
        control.criterion = select(PICK_CIRCUMCENTER, PICK_CENTROID, is_even);
    }
    let unchecked = atomicLoad(&control.active_len[control.iteration & 1]);
    let flips = atomicLoad(&control.flips_23) + atomicLoad(&control.flips_32) + atomicLoad(&control.flips_22);
    control.log[control.round % LOGGED] = array(inserted, unchecked, flips, control.iterations, control.few_done);
    control.round += 1;
    atomicStore(&control.next_node, 0u);
    // The last flips of a round wait for the next one, whose iterations do them at no extra cost. Fewer wait where
    // many signs need exact arithmetic: there, more of them become impossible in the meantime.
    let shift = select(WAITING_SHIFT, WAITING_EXACT_SHIFT, is_exact);
    control.min_active = select(min(control.max_min_active, inserted >> shift), NONE, control.insert_all != 0);
    if waiting == 0 {
        control.min_active = 0;
    }
    atomicStore(&control.overflow, 0u);
    // Compacting the list takes about as long as walking through it once more.
    atomicStore(&control.kept, 0u);
    atomicStore(&control.taken[PICK_CHUNKS], 0u);
    atomicStore(&control.taken[SPLIT_CHUNKS], 0u);
    control.entries_before = 0;
    if waiting < control.entries / 4 * 3 {
        control.entries_before = control.entries;
        control.entries = waiting;
        control.waiting_half ^= 1;
    }
}

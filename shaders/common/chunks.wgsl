// Chunks of a long list, of which each workgroup takes the next one when it is done with its last.
//
// All workgroups are then at about the same place of the list at any time. They read simplices that are
// near each other in memory, and the list of the next iteration keeps about this order. With a fixed
// share for each workgroup, the faster ones would run ahead, and the list would lose its order within a
// few iterations.
//
// Each pass of a flip iteration resets the counter of another pass, which nobody uses at that time;
// begin_round resets those of a round's passes.
//
// Expects: control.

// The passes that take chunks, by their number in `control.taken`.
const CHECK_CHUNKS: u32 = 0;
const COMMIT_CHUNKS: u32 = 1;
const LINK_CHUNKS: u32 = 2;
const PICK_CHUNKS: u32 = 3;
const SPLIT_CHUNKS: u32 = 4;

// Lists of so many chunks per workgroup are long.
const MANY_CHUNKS: u32 = 4;

var<workgroup> chunk_here: u32;

// Returns whether a list of so many entries is long.
fn is_long(entries: u32, chunk: u32, groups: u32) -> bool {
    return entries / chunk >= MANY_CHUNKS * groups;
}

// Takes the next chunk of a long list, and returns its start to the first invocation of the workgroup.
// Called early, because the atomic operation takes a while to return.
fn chunk_ahead(pass_number: u32, long: bool, chunk: u32, groups: u32, local: u32) -> u32 {
    if !long || local != 0 {
        return 0;
    }
    return groups * chunk + atomicAdd(&control.taken[pass_number], chunk);
}

// Returns the start of the chunk after the one at `start`; for a long list this is what chunk_ahead has
// returned. It is a barrier: every invocation of the workgroup must call it. What it returns is beyond the chunk at
// `start` even where a device loses additions, so that passes end there, too.
fn next_chunk(start: u32, ahead: u32, long: bool, chunk: u32, groups: u32, local: u32) -> u32 {
    if !long {
        return start + groups * chunk;
    }
    if local == 0 {
        chunk_here = ahead;
    }
    return max(workgroupUniformLoad(&chunk_here), start + min(chunk, ~start));
}

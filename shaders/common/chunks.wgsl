// Chunks of a long list, of which each workgroup takes the next one when it is done with its last.
//
// So all workgroups are at about the same place of the list at any time: they look at simplices that
// are near each other in memory, as they are in space, and what they list for the next iteration is
// in about the same order. If chunks were dealt out beforehand, the faster workgroups would run ahead,
// and after a few iterations the list would be in no order at all.
//
// Each pass of a flip iteration sets the counter of another pass back to 0, from which no workgroup
// takes at that time; begin_round does so for the passes of a round.
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

// Takes the next chunk of a long list, and returns where it starts; only to the first invocation of a
// workgroup. To be asked for early, since the answer takes a while.
fn chunk_ahead(pass_number: u32, long: bool, chunk: u32, groups: u32, local: u32) -> u32 {
    if !long || local != 0 {
        return 0;
    }
    return groups * chunk + atomicAdd(&control.taken[pass_number], chunk);
}

// Returns where the chunk starts that comes after the one at `start`: what chunk_ahead has returned, if
// the list is long. All of the workgroup must call it, which waits for each other then.
fn next_chunk(start: u32, ahead: u32, long: bool, chunk: u32, groups: u32, local: u32) -> u32 {
    if !long {
        return start + groups * chunk;
    }
    if local == 0 {
        chunk_here = ahead;
    }
    return workgroupUniformLoad(&chunk_here);
}

// Scores each waiting point and finds the best score of each simplex (§3.1). One invocation per
// entry of the list of waiting points. If begin_round says so, points that wait no longer are dropped
// from the list: the rest goes into its other half, a workgroup's share at a time, so that it stays
// about in the order of the curve.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(2) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> waiting: array<Waiting>;
// Entry 0: the best score. Entry 1: the point that has it, plus 1.
@group(0) @binding(4) var<storage, read_write> picks: array<array<atomic<u32>, 4>>;
@group(0) @binding(5) var<storage, read_write> scores: array<u32>;
//!include common/waiting
//!include common/chunks
//!include {dim}/pick_score

// The entries of the list as it was; 0 if it stays as it is.
var<workgroup> before_here: u32;
var<workgroup> entries_here: u32;
var<workgroup> kept: atomic<u32>;
var<workgroup> first_kept: u32;

// Scores a point that waits in simplex t.
fn score(t: u32, p: u32) -> u32 {
    if control.criterion == PICK_RANDOM {
        return (((p ^ (atomicLoad(&control.inserted) * 0x9e3779b9u)) * 0x85ebca6bu) >> 1) | 1;
    }
    return score_of(unpacked(simplices[t]), p);
}

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0 {
        before_here = control.entries_before;
        entries_here = control.entries;
    }
    let before = workgroupUniformLoad(&before_here);
    let entries = select(before, workgroupUniformLoad(&entries_here), before == 0);
    let list = waiting_list();
    let source = select(other_waiting_list(), list, before == 0);
    let long = is_long(entries, WORKGROUP, groups.x);
    var start = group.x * WORKGROUP;
    while start < entries {
        let ahead = chunk_ahead(PICK_CHUNKS, long, WORKGROUP, groups.x, local);
        var entry = Waiting(NONE, NONE);
        if start + local < entries {
            entry = waiting[source + start + local];
        }
        var at = start + local;
        if before != 0 {
            if local == 0 {
                atomicStore(&kept, 0u);
            }
            workgroupBarrier();
            if entry.tet != NONE {
                at = atomicAdd(&kept, 1u);
            }
            workgroupBarrier();
            if local == 0 {
                first_kept = atomicAdd(&control.kept, atomicLoad(&kept));
            }
            at += workgroupUniformLoad(&first_kept);
        }
        if entry.tet != NONE {
            if before != 0 {
                waiting[list + at] = entry;
            }
            let score = score(entry.tet, entry.point);
            scores[at] = score;
            // Most points are not the best so far, and in the first rounds thousands compete for
            // the same word.
            if score > atomicLoad(&picks[entry.tet][0]) {
                atomicMax(&picks[entry.tet][0], score);
            }
        }
        start = next_chunk(start, ahead, long, WORKGROUP, groups.x, local);
    }
}

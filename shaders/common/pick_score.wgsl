// Scores each waiting point and finds the best score of each simplex (§3.1). One invocation per
// entry of the list of waiting points.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(2) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(3) var<storage, read> waiting: array<Waiting>;
// Entry 0: the best score. Entry 1: the point that has it, plus 1.
@group(0) @binding(4) var<storage, read_write> picks: array<array<atomic<u32>, 4>>;
@group(0) @binding(5) var<storage, read_write> scores: array<u32>;
//!include common/waiting
//!include {dim}/pick_score

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let entries = control.entries;
    let list = waiting_list();
    for (var i = id.x; i < entries; i += groups.x * WORKGROUP) {
        let entry = waiting[list + i];
        if entry.tet != NONE {
            var score = 0u;
            if control.pick == PICK_RANDOM {
                score = (((entry.point ^ (atomicLoad(&control.inserted) * 0x9e3779b9u)) * 0x85ebca6bu) >> 1) | 1;
            } else {
                score = score_of(unpacked(simplices[entry.tet]), entry.point);
            }
            scores[i] = score;
            // Most points are not the best so far, and in the first rounds thousands compete for
            // the same word.
            if score > atomicLoad(&picks[entry.tet][0]) {
                atomicMax(&picks[entry.tet][0], score);
            }
        }
    }
}

// Finds for each simplex the one of another mesh that has the same vertices. One invocation per simplex.
//!include common/survivors_table
// The vertices of the simplices of the other mesh, CORNERS each, which are in the table.
@group(0) @binding(2) var<storage, read> before: array<u32>;
// −1 where there is none.
@group(0) @binding(3) var<storage, read_write> survivors: array<i32>;

// Returns whether simplex u of the other mesh has a vertex.
fn has(u: u32, v: u32) -> bool {
    for (var k = 0u; k < CORNERS; k++) {
        if before[CORNERS * u + k] == v {
            return true;
        }
    }
    return false;
}

// Returns whether simplex u of the other mesh has all vertices of simplex t. These differ from each other, so u has no
// others; the buffer of an empty mesh has zeros in place of a simplex.
fn is_same(t: u32, u: u32) -> bool {
    for (var k = 0u; k < CORNERS; k++) {
        if !has(u, corners[CORNERS * t + k]) {
            return false;
        }
    }
    return true;
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < arrayLength(&survivors); t += groups.x * WORKGROUP) {
        var place = first_place(t);
        var found = -1;
        for (var steps = 0u; steps < arrayLength(&places); steps++) {
            let entry = atomicLoad(&places[place]);
            if entry == 0 {
                break;
            }
            if is_same(t, entry - 1) {
                found = i32(entry - 1);
                break;
            }
            place = (place + 1) & (arrayLength(&places) - 1);
        }
        survivors[t] = found;
    }
}

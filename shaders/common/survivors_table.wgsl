// A table in which the simplices of a mesh are found by their vertices.
//!include {dim}/simplex
//!include common/mixed
// One more than a simplex, or 0: a power of two of them, at least twice as many as there are simplices.
@group(0) @binding(0) var<storage, read_write> places: array<atomic<u32>>;
// The vertices of the simplices, CORNERS each.
@group(0) @binding(1) var<storage, read> corners: array<u32>;

// Returns where the search for a simplex begins, whatever the order of its vertices.
fn first_place(t: u32) -> u32 {
    var sum = 0u;
    for (var k = 0u; k < CORNERS; k++) {
        sum += mixed(corners[CORNERS * t + k]);
    }
    return mixed(sum) & (arrayLength(&places) - 1);
}

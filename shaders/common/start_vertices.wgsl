// Finds the vertices of the points that Phase 1 starts with, and for stretches of vertices a simplex
// nearby. One invocation per such point.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> merged_into: array<u32>;
// The vertex of each point.
@group(0) @binding(2) var<storage, read> vertex_of: array<u32>;
// The points, each with one of its simplices.
@group(0) @binding(3) var<storage, read> start_points: array<vec2u>;
@group(0) @binding(4) var<storage, read_write> start_vertices: array<u32>;
// For each stretch of vertices the slot of a simplex, plus 1; 0 where there is none.
@group(0) @binding(5) var<storage, read_write> start_near: array<atomic<u32>>;

// Returns the vertex of a point, or of the one that stands for it.
fn vertex_at(place: u32) -> u32 {
    let point = start_points[place].x;
    let other = merged_into[point];
    return vertex_of[select(other, point, other == NONE)];
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < control.start_points; i += groups.x * WORKGROUP) {
        let v = vertex_at(i);
        start_vertices[i] = v;
        // As start_slot has it.
        let simplex = start_points[i].y;
        let slot = SLOTS_PER_POINT * vertex_at(simplex % control.start_points) + simplex / control.start_points;
        atomicMax(&start_near[v / control.start_stride], slot + 1);
    }
}

// Moves each waiting point along the history to the triangle that it lies in after the flips (§4.1). One invocation an
// entry of the list of waiting points.
//!include shared/plane_layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(2) var<storage, read> pairs: array<vec2u>;
@group(0) @binding(3) var<storage, read_write> status: array<Status>;
@group(0) @binding(4) var<storage, read> history: array<EdgeFlip>;
@group(0) @binding(5) var<storage, read_write> waiting: array<Waiting>;
//!include shared/plane_signs

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let entries = control.entries;
    let first_node = control.first_node;
    for (var i = id.x; i < entries; i += groups.x * 256) {
        let entry = waiting[i];
        if entry.tet == NONE {
            continue;
        }
        let start = status[entry.tet].first;
        var next = select(start, NONE, start < first_node);
        var t = entry.tet;
        while next != NONE {
            let node = history[next - first_node];
            // The first of the two triangles lies on the left of the edge.
            let k = select(1u, 0u, orient(vec3u(node.edge, entry.point)) > 0);
            t = node.triangles[k];
            next = node.next[k];
        }
        if t != entry.tet {
            waiting[i].tet = t;
        }
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
}

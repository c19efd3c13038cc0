// Moves each waiting point along the history to the tetrahedron that it lies in after the flips (§4.1). One invocation an
// entry of the list of waiting points.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(2) var<storage, read_write> status: array<Status>;
@group(0) @binding(3) var<storage, read> history: array<FlipNode>;
@group(0) @binding(4) var<storage, read_write> waiting: array<Waiting>;
//!include shared/signs

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
            let n = next - first_node;
            let x = vec3u(history[n].vertices[0], history[n].vertices[1], history[n].vertices[2]);
            let d = history[n].vertices[3];
            let e = history[n].vertices[4];
            let is_23 = history[n].kind == FLIP_23;
            // 3-2: above or below the ring. 2-3: beyond the plane of the edge and x_0; then beyond that of x_1 or x_2.
            let above = orient(select(vec4u(x, entry.point), vec4u(x.x, entry.point, d, e), is_23)) > 0;
            var k = select(1u, 0u, above);
            if is_23 {
                let beyond = orient(vec4u(select(x.z, x.y, above), entry.point, d, e)) > 0;
                k = select(select(1u, 2u, beyond), select(0u, 1u, beyond), above);
            }
            t = history[n].tets[k];
            next = history[n].next[k];
        }
        waiting[i].tet = t;
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
}

// Carries out the proposed flips that won both of their triangles. One invocation per entry of the
// active list.
//
// A flip owns its triangles, so it overwrites them in place; the outer edges of the new ones keep
// their old neighbours until flip_link, and each old triangle gets a message that says where its
// outer edges went. A flip that finds no room in the history is put off: it stays in the active
// list. Numbers in the history are taken for a whole workgroup at a time.
//!include d2/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read_write> simplices: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> status: array<Status>;
@group(0) @binding(4) var<storage, read_write> actives: array<Active>;
@group(0) @binding(5) var<storage, read_write> messages: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> history: array<EdgeFlip>;
//!include common/bids
//!include common/history

var<workgroup> entries_here: u32;
// Flips of this workgroup whose triangles may hold waiting points, and the number of the first in
// the history.
var<workgroup> held_here: atomic<u32>;
var<workgroup> first_here: u32;

// Carries out the flip of edge k of triangle t. `node` is its number in the history, NONE where no
// waiting point can lie in its triangles.
fn carry_out(t: u32, k: u32, node: u32, mark: u32) {
    let near_t = neighbors[t].xyz;
    let u = near_t[k] >> 2;
    let near_u = neighbors[u].xyz;
    // t is (d, a, b) and u is (e, b, a), counted from the corners opposite the edge.
    let tri_t = simplices[t].xyz;
    let tri_u = simplices[u].xyz;
    let ka = (k + 1) % 3;
    let kb = (k + 2) % 3;
    let f = near_t[k] & 3;
    let fb = (f + 1) % 3;
    let fa = (f + 2) % 3;
    let d = tri_t[k];
    let a = tri_t[ka];
    let b = tri_t[kb];
    let e = tri_u[f];
    if node != NONE {
        let first = control.first_node;
        link_node(t, node, first);
        link_node(u, node, first);
        history[node - first] = EdgeFlip(vec2u(e, d), vec2u(t, u), vec2u(NONE));
    }
    let flags = select(control.round << HELD_SHIFT, 0u, node == NONE) | 6;
    let last = select(node << 2, 0u, node == NONE);
    renew(t, flags, mark, last);
    renew(u, flags, mark, last + select(1u, 0u, node == NONE));
    // (a, e, d) and (b, d, e), joined by their edges 0.
    simplices[t] = vec4u(a, e, d, 0);
    simplices[u] = vec4u(b, d, e, 0);
    neighbors[t] = vec4u(4 * u, near_t[kb], near_u[fb], 0);
    neighbors[u] = vec4u(4 * t, near_u[fa], near_t[ka], 0);
    messages[t] = vec4u(replaced(replaced(vec3u(NONE), kb, 4 * t + 1), ka, 4 * u + 2), 0);
    messages[u] = vec4u(replaced(replaced(vec3u(NONE), fb, 4 * t + 2), fa, 4 * u + 1), 0);
}

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.iteration;
    if local == 0 {
        entries_here = entries_of(iteration);
    }
    let entries = workgroupUniformLoad(&entries_here);
    let list = half_of(iteration);
    let bits = control.bid_bits;
    let round = control.round;
    let room = control.first_node + control.history;
    for (var start = group.x * WORKGROUP; start < entries; start += groups.x * WORKGROUP) {
        if local == 0 {
            atomicStore(&held_here, 0u);
        }
        workgroupBarrier();
        let i = start + local;
        var t = NONE;
        var k = 0u;
        var held = false;
        var node = NONE;
        if i < entries {
            let entry = actives[list + i];
            let edge = (entry.outcome >> FACET_SHIFT) & 3;
            if ((entry.outcome >> KIND_SHIFT) & 3) != 0 {
                let bid = bid_of(i, iteration, bits);
                let u = neighbors[entry.tet][edge] >> 2;
                if atomicLoad(&status[entry.tet].vote) == bid && atomicLoad(&status[u].vote) == bid {
                    t = entry.tet;
                    k = edge;
                    held = atomicLoad(&status[t].flags) >> HELD_SHIFT == round
                        || atomicLoad(&status[u].flags) >> HELD_SHIFT == round;
                }
            }
            if held {
                node = atomicAdd(&held_here, 1u);
            }
        }
        workgroupBarrier();
        if local == 0 {
            // The counter is not raised far beyond the end, so that it never overflows.
            let wanted = atomicLoad(&held_here);
            first_here = room;
            if wanted != 0 && atomicLoad(&control.next_node) < room {
                first_here = atomicAdd(&control.next_node, wanted);
            }
        }
        let first_number = workgroupUniformLoad(&first_here);
        if held {
            node += first_number;
        }
        if t != NONE {
            if held && node >= room {
                atomicOr(&control.overflow, HISTORY_FULL);
            } else {
                carry_out(t, k, node, changed_mark(iteration, bits));
                actives[list + i].outcome = DONE | FLIP_22;
            }
        }
    }
    if local == 0 && group.x == 0 {
        control.link_iteration = iteration;
        if entries != 0 {
            atomicStore(&control.active_len[(iteration + 1) & 1], 0u);
        }
    }
}

// Checks the edges of each active triangle until one is not locally Delaunay, and bids for the two
// triangles that its flip would change (§5.6). One invocation per entry of the active list. Every
// such edge can be flipped.
//!include d2/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(3) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(4) var<storage, read> neighbors: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> status: array<Status>;
@group(0) @binding(6) var<storage, read_write> actives: array<Active>;
//!include d2/signs
//!include common/bids

var<workgroup> exact_here: atomic<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.iteration;
    let entries = entries_of(iteration);
    let list = half_of(iteration);
    let bits = control.bid_bits;
    for (var i = id.x; i < entries; i += groups.x * WORKGROUP) {
        let t = actives[list + i].tet;
        let tri = simplices[t].xyz;
        let near = neighbors[t].xyz;
        var check = atomicLoad(&status[t].flags) & CHECK;
        var flip = 0u;
        var u = NONE;
        for (var k = 0u; k < 3 && flip == 0; k++) {
            if ((check >> k) & 1) == 0 {
                continue;
            }
            u = near[k] >> 2;
            let edge = near[k] & 3;
            // Where both sides are to check an edge, the lower one does.
            let theirs = u < t && ((atomicLoad(&status[u].flags) >> edge) & 1) != 0;
            var violated = false;
            if !theirs {
                violated = inside(tri, simplices[u][edge]);
            }
            if violated {
                flip = (FLIP_22 << KIND_SHIFT) | (k << FACET_SHIFT);
            } else {
                check &= ~(1u << k);
            }
        }
        actives[list + i].outcome = flip | check;
        if flip != 0 {
            let bid = bid_of(i, iteration, bits);
            atomicMax(&status[t].vote, bid);
            atomicMax(&status[u].vote, bid);
        }
    }
    if local == 0 {
        atomicStore(&exact_here, 0u);
    }
    workgroupBarrier();
    if exact_signs != 0 {
        atomicAdd(&exact_here, exact_signs);
    }
    workgroupBarrier();
    if local == 0 && atomicLoad(&exact_here) != 0 {
        atomicAdd(&control.exact, atomicLoad(&exact_here));
    }
    if id.x == 0 && entries != 0 {
        control.iterations += 1;
        control.visits += entries;
    }
}

// Checks the facets of each active tetrahedron until one can be flipped, and bids for the tetrahedra that this flip would
// change (§3.1, §4.2). One invocation an entry of the active list.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(2) var<storage, read> tets: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> status: array<Status>;
@group(0) @binding(5) var<storage, read_write> actives: array<Active>;
//!include shared/signs
//!include shared/bids

var<workgroup> exact_here: atomic<u32>;

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.iteration;
    let entries = entries_of(iteration);
    let list = half_of(iteration);
    let bits = control.bid_bits;
    for (var i = id.x; i < entries; i += groups.x * 256) {
        let t = actives[list + i].tet;
        let tet = tets[t];
        let near = neighbors[t];
        let flags = atomicLoad(&status[t].flags);
        var check = flags & CHECK;
        var suspect = (flags >> SUSPECT_SHIFT) & CHECK & ~check;
        var flip = 0u;
        var u = NONE;
        var w = NONE;
        for (var k = 0u; k < 4 && flip == 0; k++) {
            if ((check >> k) & 1) == 0 {
                continue;
            }
            u = near[k] >> 2;
            let face = near[k] & 3;
            // Where both sides are to check a facet, the lower one does.
            let theirs = u < t && ((atomicLoad(&status[u].flags) >> face) & 1) != 0;
            var violated = false;
            let e = tets[u][face];
            if !theirs {
                violated = inside(tet, e);
            }
            if violated {
                let c = facet(k);
                let x = vec3u(tet[c.x], tet[c.y], tet[c.z]);
                var negative = 0u;
                var edge = 0u;
                for (var j = 0u; j < 3 && negative < 2; j++) {
                    if orient(vec4u(x[j], x[(j + 1) % 3], tet[k], e)) < 0 {
                        negative += 1;
                        edge = j;
                    }
                }
                if negative == 0 {
                    flip = FLIP_23;
                } else if negative == 1 {
                    let opposite = (edge + 2) % 3;
                    w = near[c[opposite]] >> 2;
                    let there = place_of(tets[u], x[opposite]);
                    if neighbors[u][there] >> 2 == w {
                        flip = FLIP_32;
                    }
                }
                if flip != 0 {
                    flip = (flip << KIND_SHIFT) | (k << FACET_SHIFT) | (edge << EDGE_SHIFT);
                } else {
                    suspect |= 1u << k;
                }
            }
            if flip == 0 {
                check &= ~(1u << k);
            }
        }
        actives[list + i].outcome = flip | (suspect << SUSPECT_SHIFT) | check;
        if flip != 0 {
            let bid = bid_of(i, iteration, bits);
            atomicMax(&status[t].vote, bid);
            atomicMax(&status[u].vote, bid);
            if ((flip >> KIND_SHIFT) & 3) == FLIP_32 {
                atomicMax(&status[w].vote, bid);
            }
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

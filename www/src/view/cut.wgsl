// The facets that bound the tetrahedra which a filter keeps below the cutting plane: what
// `boundaryOf` finds on the CPU, as a list for one indirect draw.

struct Cut {
    // Heights are integers here, in the order of the numbers that they stand for: they compare
    // alike on all devices.
    level: i32,
    tetrahedra: u32,
    // As many facets have room.
    most: u32,
    // What marks facets of the outside: OUTSIDE, or 0 where they look like any other.
    outside: u32,
}

struct Draw {
    vertices: atomic<u32>,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
}

@group(0) @binding(0) var<uniform> cut: Cut;
// Four a tetrahedron: the one across the facet opposite each vertex, -1 outside the hull.
@group(0) @binding(1) var<storage, read> neighbors: array<i32>;
// Of the centroids.
@group(0) @binding(2) var<storage, read> heights: array<i32>;
// A byte a tetrahedron: KEPT by the filter, and on its RIM.
@group(0) @binding(3) var<storage, read> filtered: array<u32>;
// The highest centroid among each tetrahedron's neighbours.
@group(0) @binding(4) var<storage, read_write> reach: array<i32>;
// 4 · tetrahedron + the number of the vertex opposite, and the mark of the outside.
@group(0) @binding(5) var<storage, read_write> facets: array<u32>;
@group(0) @binding(6) var<storage, read_write> draw: Draw;

const WIDTH = 256u;
const KEPT = 1u;
const RIM = 2u;
const LOWEST = -0x7fffffffi - 1i;

var<workgroup> found: atomic<u32>;
var<workgroup> start: u32;

fn number_of(group: vec3u, groups: vec3u, local: u32) -> u32 {
    return (group.y * groups.x + group.x) * WIDTH + local;
}

fn filter_of(tet: u32) -> u32 {
    return filtered[tet / 4u] >> (8u * (tet % 4u));
}

@compute @workgroup_size(WIDTH)
fn measure(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let tet = number_of(group, groups, local);
    if tet >= cut.tetrahedra {
        return;
    }
    var highest = LOWEST;
    for (var k = 0u; k < 4u; k++) {
        let across = neighbors[4u * tet + k];
        if across >= 0 {
            highest = max(highest, heights[across]);
        }
    }
    reach[tet] = highest;
}

@compute @workgroup_size(WIDTH)
fn list(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let tet = number_of(group, groups, local);
    // Bit k: the facet opposite vertex k is drawn; bit 4 + k: it belongs to the outside.
    var mine = 0u;
    if tet < cut.tetrahedra && heights[tet] <= cut.level {
        let own = filter_of(tet);
        if (own & KEPT) != 0u && ((own & RIM) != 0u || reach[tet] > cut.level) {
            for (var k = 0u; k < 4u; k++) {
                let across = neighbors[4u * tet + k];
                if across < 0 || (filter_of(u32(across)) & KEPT) == 0u {
                    mine |= 17u << k;
                } else if heights[across] > cut.level {
                    mine |= 1u << k;
                }
            }
        }
    }

    // The facets of a workgroup get places together.
    let count = countOneBits(mine & 15u);
    var place = 0u;
    if count > 0u {
        place = atomicAdd(&found, count);
    }
    workgroupBarrier();
    if local == 0u {
        let all = atomicLoad(&found);
        if all > 0u {
            let before = atomicAdd(&draw.vertices, 3u * all);
            // Nobody finds fewer vertices than there are places taken: no place is given twice.
            if before + 3u * all > 3u * cut.most {
                atomicMin(&draw.vertices, 3u * cut.most);
            }
            start = before / 3u;
        }
    }
    workgroupBarrier();
    place += start;
    for (var k = 0u; k < 4u; k++) {
        if (mine & (1u << k)) != 0u {
            if place < cut.most {
                facets[place] = (4u * tet + k) | select(0u, cut.outside, (mine & (16u << k)) != 0u);
            }
            place++;
        }
    }
}

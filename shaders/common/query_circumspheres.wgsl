// Computes the circumcentres of the simplices, relative to their first vertices, and the
// circumradii. One invocation per simplex.
//
// Each coordinate is the quotient of two integers on the lattice of the mesh's points, which only
// their conversion and the division round, however flat the simplex is. What rounding to the lattice
// leaves open is left to the host.
//
// Rounding. By 2^-23 when an integer is converted, by 2.5·2^-23 when they are divided, and by
// 2^-23 before that, where {dim}/query_center admits that points were rounded: below 2^-20 of the
// radius in each coordinate. The radius has at most seven roundings more.
//!include common/query_params
@group(0) @binding(2) var<storage, read> vertices: array<VertexWords>;
//!include {dim}/query_simplices
// The bits of the results, CORNERS words per simplex: the centre's coordinates and the radius.
@group(0) @binding(4) var<storage, read_write> results: array<u32>;
//!include {dim}/query_center

// The radius of a sphere that is left to the host, which is of no other.
const OPEN_RADIUS: u32 = 0x7fc00000;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < params.count; t += groups.x * WORKGROUP) {
        let at = CORNERS * t;
        let center = center_of(t);
        if center.is_open {
            results[at + CORNERS - 1] = OPEN_RADIUS;
            atomicAdd(&params.open, 1u);
            continue;
        }
        let largest = max(max(center.x.exponent, center.y.exponent), center.z.exponent);
        let numerator = vec3f(aligned(center.x, largest), aligned(center.y, largest), aligned(center.z, largest));
        // Its largest coordinate is at least 1/2, and none exceeds 2.
        let offset = numerator / center.denominator.value;
        let by = largest - center.denominator.exponent - params.exponent;
        results[at] = scaled_bits(offset.x, by);
        results[at + 1] = scaled_bits(offset.y, by);
        if CORNERS == 4 {
            results[at + 2] = scaled_bits(offset.z, by);
        }
        results[at + CORNERS - 1] = scaled_bits(length(offset), by);
    }
}

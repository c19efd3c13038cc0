// The parameters of queries of a mesh on the device.
//!include primitives/workgroup

// The parameters of the kernels, and what they count. The members up to `dimension` are those of
// InputParams.
struct QueryParams {
    count: u32,
    exponent: i32,
    doubles: u32,
    varies: u32,
    origin_low: vec3u,
    // The number of simplices to start from.
    starts: u32,
    origin_high: vec3u,
    width: u32,
    // The cells of the curve: floor(x·2^k) − origin, with a k of its own for each axis.
    cell_exponents: vec3i,
    dimension: u32,
    cell_origin_low: vec3u,
    max_steps: u32,
    cell_origin_high: vec3u,
    // The host's counts follow: the first query that is not finite, NONE if all are.
    not_finite: atomic<u32>,
    // The limits of what is near, as `ordered` returns them.
    nearest_low: vec3u,
    // Queries that the filter does not decide.
    undecided: atomic<u32>,
    nearest_high: vec3u,
    // Queries that are left to the host.
    open: atomic<u32>,
    farthest_low: vec3u,
    unused: u32,
    farthest_high: vec3u,
    padding: u32,
}

@group(0) @binding(0) var<storage, read_write> params: QueryParams;

// The answer for a query that is left to the host.
const OPEN: u32 = 0x80000001;

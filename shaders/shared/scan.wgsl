// How a scan is shared out: each of SCAN_GROUPS workgroups takes a contiguous part, in steps of SCAN_STEP values.

const SCAN_GROUPS: u32 = 1024;
// Four values an invocation.
const SCAN_STEP: u32 = 1024;

// Mirrors gpu::stages::scan::ScanParams.
struct ScanParams {
    // The number of values, at most 2^30: no binding holds more.
    count: u32,
}

// The values of a workgroup: from x up to, and without, y.
fn scan_part(count: u32, group: u32) -> vec2u {
    let steps = (count + SCAN_STEP - 1) / SCAN_STEP;
    let part = (steps + SCAN_GROUPS - 1) / SCAN_GROUPS * SCAN_STEP;
    let start = min(group * part, count);
    return vec2u(start, min(start + part, count));
}

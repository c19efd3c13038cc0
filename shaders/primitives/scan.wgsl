// How a scan is shared out: each workgroup takes a contiguous part, in steps of SCAN_STEP values.
// There are at most SCAN_GROUPS of them, and no more than have values.
//!include primitives/workgroup

const SCAN_GROUPS: u32 = 1024;
// Four values per invocation.
const SCAN_STEP: u32 = 1024;

struct ScanParams {
    // The number of values, at most 2^30: no binding holds more.
    count: u32,
}

// The values of each part but the last.
fn scan_part_size(count: u32) -> u32 {
    let steps = (count + SCAN_STEP - 1) / SCAN_STEP;
    return (steps + SCAN_GROUPS - 1) / SCAN_GROUPS * SCAN_STEP;
}

// The values of a workgroup: from x up to, and without, y.
fn scan_part(count: u32, group: u32) -> vec2u {
    let part = scan_part_size(count);
    let start = min(group * part, count);
    return vec2u(start, min(start + part, count));
}

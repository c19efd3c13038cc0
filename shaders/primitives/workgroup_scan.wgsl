// Prefix sums over a workgroup.
//!include primitives/workgroup

var<workgroup> scan_sums: array<array<u32, WORKGROUP>, 2>;

struct Scanned {
    // The sum of the values of the invocations before this one.
    before: u32,
    // The sum of all values.
    total: u32,
}

// Every invocation of the workgroup must call this. Workgroup memory that was written before is
// seen after.
fn workgroup_scan(value: u32, local: u32) -> Scanned {
    scan_sums[0][local] = value;
    workgroupBarrier();
    var half = 0u;
    for (var reach = 1u; reach < WORKGROUP; reach *= 2) {
        let other = scan_sums[half][(local - reach) & (WORKGROUP - 1)];
        scan_sums[1 - half][local] = scan_sums[half][local] + select(0, other, local >= reach);
        half = 1 - half;
        workgroupBarrier();
    }
    let result = Scanned(scan_sums[half][local] - value, scan_sums[half][WORKGROUP - 1]);
    // The next call writes the half that this one reads last.
    workgroupBarrier();
    return result;
}

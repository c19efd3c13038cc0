// First of three kernels of a radix sort's pass: how often each digit occurs in each tile.
//!include primitives/radix

@group(0) @binding(0) var<storage, read> params: SortParams;
// Key and value.
@group(0) @binding(1) var<storage, read> pairs: array<vec2u>;
// Entry digit·tiles + tile.
@group(0) @binding(2) var<storage, read_write> counts: array<u32>;

var<workgroup> histogram: array<atomic<u32>, RADIX_DIGITS>;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32
) {
    let tiles = radix_tiles(params.count);
    for (var tile = group.x; tile < tiles; tile += groups.x) {
        atomicStore(&histogram[local], 0);
        workgroupBarrier();
        let end = min(RADIX_TILE, params.count - tile * RADIX_TILE);
        for (var i = local; i < end; i += WORKGROUP) {
            atomicAdd(&histogram[radix_digit(pairs[tile * RADIX_TILE + i].x, params.shift)], 1);
        }
        workgroupBarrier();
        counts[local * tiles + tile] = atomicLoad(&histogram[local]);
    }
}

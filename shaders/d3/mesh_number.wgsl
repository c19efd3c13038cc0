// Numbers the tetrahedra of the mesh: the finite ones in the order of their slots, the infinite
// ones behind them. One invocation per slot.
//!include d3/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> simplices: array<vec4u>;
// The last entry is the number of finite tetrahedra.
@group(0) @binding(2) var<storage, read> sums: array<u32>;
// The number of finite tetrahedra before each slot; then 4·number + the place of infinity, 3 where
// there is none.
@group(0) @binding(3) var<storage, read_write> numbers: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let finite = sums[arrayLength(&sums) - 1];
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        let tet = simplices[t];
        var number = numbers[t];
        var place = 3u;
        if any(tet == vec4u(control.infinite)) && any(tet != vec4u(0)) {
            number = finite + atomicAdd(&control.ghosts, 1u);
            place = place_of(tet, control.infinite);
        }
        numbers[t] = 4 * number + place;
    }
}

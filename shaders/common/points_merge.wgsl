// Finds points at the same place of the lattice, in a hash table with open addressing. The table
// gets the lowest number of each set of them.
//!include common/input

@group(0) @binding(0) var<storage, read> params: InputParams;
@group(0) @binding(1) var<storage, read> input: array<u32>;
// EMPTY, or a point's number plus 1; at least half of the entries stay empty.
@group(0) @binding(2) var<storage, read_write> table: array<atomic<u32>>;
// Where in the table each point's place is.
@group(0) @binding(3) var<storage, read_write> slots: array<u32>;

// The contents of new buffers.
const EMPTY: u32 = 0;

// A bijection that spreads every bit over all others (the finaliser of MurmurHash3).
fn mix_bits(bits: u32) -> u32 {
    let a = (bits ^ (bits >> 16)) * 0x85ebca6b;
    let b = (a ^ (a >> 13)) * 0xc2b2ae35;
    return b ^ (b >> 16);
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var point = id.x; point < params.count; point += groups.x * WORKGROUP) {
        let place = lattice_point(point);
        let xy = mix_bits(mix_bits(mix_bits(mix_bits(place.high.x) ^ place.low.x) ^ place.high.y) ^ place.low.y);
        let hash = mix_bits(mix_bits(xy ^ place.high.z) ^ place.low.z);
        var slot = hash & params.table_mask;
        var found = false;
        // Weak exchanges may fail although the entry is empty, and the same entry is then tried
        // again: the bound on the probes is not met, but no device can hang on it.
        for (var probe = 0u; probe <= 2 * params.table_mask && !found; probe++) {
            let entry = atomicCompareExchangeWeak(&table[slot], EMPTY, point + 1);
            if entry.exchanged {
                found = true;
            } else if entry.old_value != EMPTY {
                let other = lattice_point(entry.old_value - 1);
                if all(other.high == place.high) && all(other.low == place.low) {
                    atomicMin(&table[slot], point + 1);
                    found = true;
                } else {
                    slot = (slot + 1) & params.table_mask;
                }
            }
        }
        slots[point] = slot;
    }
}

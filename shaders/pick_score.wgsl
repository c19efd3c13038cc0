// Scores each waiting point and finds the best score of each tetrahedron (§3.1); begins the insertion round. One
// invocation an entry of the list of waiting points.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(2) var<storage, read> tets: array<vec4u>;
@group(0) @binding(3) var<storage, read> waiting: array<Waiting>;
// Entry 0: the best score. Entry 1: the point that has it, plus 1.
@group(0) @binding(4) var<storage, read_write> picks: array<array<atomic<u32>, 4>>;
@group(0) @binding(5) var<storage, read_write> scores: array<u32>;
//!include shared/exact_{width}

const PICK_CENTROID: u32 = 1;
const PICK_RANDOM: u32 = 2;

fn from_to(v: u32, w: u32) -> vec3f {
    return vec3f(load_high(w) - load_high(v));
}

fn triple(a: vec3f, b: vec3f, c: vec3f) -> f32 {
    return dot(a, cross(b, c));
}

// A power of two that brings the largest of these below 2.
fn scale_of(a: vec3f, b: vec3f, c: vec3f) -> f32 {
    let m = max(max(abs(a), abs(b)), abs(c));
    let largest = max(max(max(m.x, m.y), m.z), 1);
    return bitcast<f32>(0x7f000000 - (bitcast<u32>(largest) & 0x7f800000));
}

fn score_of(tet: vec4u, p: u32) -> u32 {
    let infinite = control.infinite;
    if any(tet == vec4u(infinite)) {
        // The hull grows most by the point that is farthest from the facet.
        let k = place_of(tet, infinite);
        let a = tet[(k + 1) % 4];
        let u = from_to(a, tet[(k + 2) % 4]);
        let v = from_to(a, tet[(k + 3) % 4]);
        let scale = scale_of(u, v, vec3f(0));
        return bitcast<u32>(abs(triple(u * scale, v * scale, from_to(a, p) * scale))) + 1;
    }
    let scale = scale_of(from_to(tet.x, tet.y), from_to(tet.x, tet.z), from_to(tet.x, tet.w));
    let a = from_to(p, tet.x) * scale;
    let b = from_to(p, tet.y) * scale;
    let c = from_to(p, tet.z) * scale;
    let d = from_to(p, tet.w) * scale;
    if control.pick == PICK_CENTROID {
        let off = a + b + c + d;
        return 0x7f800000 - bitcast<u32>(dot(off, off));
    }
    // The in-sphere determinant: for one tetrahedron it grows as the distance from the circumcentre falls.
    let inside = dot(a, a) * triple(b, c, d) - dot(b, b) * triple(c, d, a) + dot(c, c) * triple(d, a, b)
        - dot(d, d) * triple(a, b, c);
    return bitcast<u32>(abs(inside)) + 1;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let entries = control.entries;
    for (var i = id.x; i < entries; i += groups.x * 256) {
        let entry = waiting[i];
        if entry.tet != NONE {
            var score = 0u;
            if control.pick == PICK_RANDOM {
                score = (((entry.point ^ (atomicLoad(&control.inserted) * 0x9e3779b9u)) * 0x85ebca6bu) >> 1) | 1;
            } else {
                score = score_of(tets[entry.tet], entry.point);
            }
            scores[i] = score;
            // Most points are not the best so far, and in the first rounds thousands ask for the same word.
            if score > atomicLoad(&picks[entry.tet][0]) {
                atomicMax(&picks[entry.tet][0], score);
            }
        }
    }
    if id.x == 0 {
        control.round += 1;
        control.first_node = atomicLoad(&control.next_node);
    }
}

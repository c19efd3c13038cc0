// Scores each waiting point and finds the best score of each triangle (§3.1); begins the insertion round. One invocation
// an entry of the list of waiting points.
//!include shared/plane_layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(2) var<storage, read> triangles: array<vec4u>;
@group(0) @binding(3) var<storage, read> waiting: array<Waiting>;
// Entry 0: the best score. Entry 1: the point that has it, plus 1.
@group(0) @binding(4) var<storage, read_write> picks: array<array<atomic<u32>, 4>>;
@group(0) @binding(5) var<storage, read_write> scores: array<u32>;
//!include shared/plane_exact_{width}

const PICK_CENTROID: u32 = 1;
const PICK_RANDOM: u32 = 2;

fn from_to(v: u32, w: u32) -> vec2f {
    return vec2f(load_high(w) - load_high(v));
}

fn cross_of(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}

// A power of two that brings the largest of these below 2.
fn scale_of(a: vec2f, b: vec2f) -> f32 {
    let m = max(abs(a), abs(b));
    let largest = max(max(m.x, m.y), 1);
    return bitcast<f32>(0x7f000000 - (bitcast<u32>(largest) & 0x7f800000));
}

// By distance; where that is 0 because the point lies on the line of the edge or of the flat triangle, by how much it lies in
// the middle between two neighbouring vertices, below all scores by distance. So collinear points halve what is between them,
// and it does not take a round for each. The smallest distances are about 2^-63, and betweenness is at most about 1.
fn score_or_betweenness(distance: f32, betweenness: f32) -> u32 {
    return bitcast<u32>(abs(select(distance, betweenness * 0x1p-70, distance == 0))) + 1;
}

fn score_of(tri: vec3u, p: u32) -> u32 {
    let infinite = control.infinite;
    if any(tri == vec3u(infinite)) {
        // The hull grows most by the point that is farthest from the edge.
        let k = corner_of(tri, infinite);
        let a = tri[(k + 1) % 3];
        let b = tri[(k + 2) % 3];
        let scale = scale_of(from_to(a, b), vec2f(0));
        let u = from_to(a, b) * scale;
        let v = from_to(a, p) * scale;
        return score_or_betweenness(cross_of(u, v), dot(v, u - v));
    }
    let scale = scale_of(from_to(tri.x, tri.y), from_to(tri.x, tri.z));
    let a = from_to(p, tri.x) * scale;
    let b = from_to(p, tri.y) * scale;
    let c = from_to(p, tri.z) * scale;
    if control.pick == PICK_CENTROID {
        let off = a + b + c;
        return 0x7f800000 - bitcast<u32>(dot(off, off));
    }
    // The in-circle determinant: for one triangle it grows as the distance from the circumcentre falls.
    let inside = dot(a, a) * cross_of(b, c) + dot(b, b) * cross_of(c, a) + dot(c, c) * cross_of(a, b);
    // On the line of a flat triangle the product of the ways to the outer vertices is the lowest, then comes that of the
    // neighbours, and the third is positive.
    let products = vec3f(dot(a, b), dot(b, c), dot(c, a));
    let median = max(min(products.x, products.y), min(max(products.x, products.y), products.z));
    return score_or_betweenness(inside, -median);
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
                score = score_of(triangles[entry.tet].xyz, entry.point);
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

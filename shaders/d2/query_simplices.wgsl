// The triangles of a mesh on the device.
@group(0) @binding(3) var<storage, read> simplices: array<u32>;
const CORNERS: u32 = 3;

// Returns a vertex of a triangle.
fn corner(t: u32, k: u32) -> u32 {
    return simplices[3 * t + k];
}

// Returns the vertices in ascending order.
fn sorted(t: u32) -> vec3u {
    let a = simplices[3 * t];
    let b = simplices[3 * t + 1];
    let c = simplices[3 * t + 2];
    let low = min(a, b);
    let high = max(a, b);
    return vec3u(min(low, c), max(low, min(high, c)), max(high, c));
}

// Returns whether the sorted vertices of t come before those of u.
fn comes_before(t: u32, u: u32) -> bool {
    let a = sorted(t);
    let b = sorted(u);
    let is_less = a < b;
    let is_equal = a == b;
    return is_less.x || (is_equal.x && (is_less.y || (is_equal.y && is_less.z)));
}

// The tetrahedra of a mesh on the device.
@group(0) @binding(3) var<storage, read> simplices: array<vec4u>;
const CORNERS: u32 = 4;

// Returns a vertex of a tetrahedron.
fn corner(t: u32, k: u32) -> u32 {
    return simplices[t][k];
}

// Returns the vertices in ascending order.
fn sorted(t: u32) -> vec4u {
    let s = simplices[t];
    let low = min(s.xy, s.zw);
    let high = max(s.xy, s.zw);
    let middle = vec2u(max(low.x, low.y), min(high.x, high.y));
    return vec4u(min(low.x, low.y), min(middle.x, middle.y), max(middle.x, middle.y), max(high.x, high.y));
}

// Returns whether the sorted vertices of t come before those of u.
fn comes_before(t: u32, u: u32) -> bool {
    let a = sorted(t);
    let b = sorted(u);
    let is_less = a < b;
    let is_equal = a == b;
    return is_less.x || (is_equal.x && (is_less.y || (is_equal.y && (is_less.z || (is_equal.z && is_less.w)))));
}

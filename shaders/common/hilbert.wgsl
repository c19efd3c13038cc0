// Steps of Hilbert curves (Skilling, *Programming the Hilbert curve*, 2004).

// Inverts the bits of the first coordinate below the bit q where q is set in the second, else
// exchanges those bits of the two.
fn turned(x: vec2u, q: u32) -> vec2u {
    let p = q - 1;
    let t = (x.x ^ x.y) & p;
    let invert = (x.y & q) != 0;
    return x ^ select(vec2u(t), vec2u(p, 0), invert);
}

// Returns the exclusive or of z >> k for k from 1 to 16: a bit is set where an odd number of the
// bits above it are.
fn parity_above(z: u32) -> u32 {
    var t = z >> 1;
    t ^= t >> 1;
    t ^= t >> 2;
    t ^= t >> 4;
    t ^= t >> 8;
    return t;
}

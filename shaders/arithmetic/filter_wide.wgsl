// What the low words add to the error bounds; see arithmetic/filter. One unit is 2^-8.

// K, from the largest absolute difference of each axis.
fn widening(largest: vec3f) -> f32 {
    return clamp(max(max(largest.x, largest.y), largest.z) / 16, 0x1p-6, 0x1p9);
}

fn low_word_error(k: f32) -> f32 {
    return 1.5 * 0x1p-8 / k;
}

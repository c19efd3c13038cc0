// There are no low words.

fn widening(largest: vec3f) -> f32 {
    return 0;
}

fn low_word_error(k: f32) -> f32 {
    return 0;
}

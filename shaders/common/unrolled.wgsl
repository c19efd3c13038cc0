// Keeps compilers from unrolling loops.
//
// Expects: vertices.

// Returns `count`, which compilers cannot know in advance. A loop over a known count is unrolled, and
// copies of exact arithmetic that hardly ever runs take seconds to compile.
fn not_unrolled(count: u32) -> u32 {
    return min(count, arrayLength(&vertices) + count - 1);
}

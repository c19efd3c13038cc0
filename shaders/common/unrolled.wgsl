// Loops that stay loops.
//
// Expects: vertices.

// Returns `count` in a form that compilers do not see through. Otherwise they unroll loops of so
// many steps, and spend seconds on exact arithmetic that hardly ever runs.
fn not_unrolled(count: u32) -> u32 {
    return min(count, arrayLength(&vertices) + count - 1);
}

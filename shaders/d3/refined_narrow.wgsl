// There are no low words: nothing is left for a second filter.

fn orient3d_refined(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> i32 {
    return 0;
}

fn insphere_refined(a: Vertex, b: Vertex, c: Vertex, d: Vertex, e: Vertex) -> i32 {
    return 0;
}

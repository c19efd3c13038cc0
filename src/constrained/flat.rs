//! Constraints of collinear points, which have no triangles.

/// Returns the edges that segments between vertices cover, of those between neighbours on the line: the lower vertex
/// first, in ascending order. `line` has the vertices in the order of the line, and they are below `points`.
pub(super) fn edges(line: &[u32], points: usize, segments: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut places = vec![0; points];
    (0..).zip(line).for_each(|(place, &v)| places[v as usize] = place);
    // Entry i counts the segments that begin at place i, less those that end there.
    let mut begins = vec![0i64; line.len()];
    for ends in segments {
        let [a, b] = ends.map(|v| places[v as usize]);
        begins[a.min(b)] += 1;
        begins[a.max(b)] -= 1;
    }
    let mut covering = 0;
    let mut edges = Vec::new();
    for (neighbors, begins) in line.windows(2).zip(begins) {
        covering += begins;
        if covering > 0 {
            edges.push([neighbors[0].min(neighbors[1]), neighbors[0].max(neighbors[1])]);
        }
    }
    edges.sort_unstable();
    edges
}

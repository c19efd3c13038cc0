// Joins simplices that an iteration made to those around them.
//
// Expects: neighbors, status, messages.

// Joins facet `face` of simplex t to what is across it. An outer neighbour that did not change gets the new
// neighbour; one that did, which has the vote `mark`, has left a message, which is followed. So each facet is
// written once.
fn join(t: u32, face: u32, mark: u32) {
    let across = neighbors[t][face];
    let u = across >> 2;
    let theirs = across & 3;
    if atomicLoad(&status[u].vote) == mark {
        neighbors[t][face] = messages[u][theirs];
    } else {
        neighbors[u][theirs] = 4 * t + face;
    }
}

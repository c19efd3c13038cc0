// The list of waiting points, which has two halves: it is compacted from one into the other.
//
// Expects: control.

// Returns where the half of the list starts that is in use.
fn waiting_list() -> u32 {
    return control.waiting_half * control.infinite;
}

// Returns where the other half starts.
fn other_waiting_list() -> u32 {
    return (1 - control.waiting_half) * control.infinite;
}

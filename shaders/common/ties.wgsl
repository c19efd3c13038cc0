// What breaks ties in both dimensions: the order of the vertices' indices.
//
// Expects: Vertex, with an index.

// Exchanges two vertices if they are not in the order of their indices.
fn put_in_order(a: ptr<function, Vertex>, b: ptr<function, Vertex>, parity: ptr<function, i32>) {
    if (*b).index < (*a).index {
        let c = *a;
        *a = *b;
        *b = c;
        *parity = -*parity;
    }
}

// Four vertices, and the sign of the permutation that sorted them.
struct InOrder {
    a: Vertex,
    b: Vertex,
    c: Vertex,
    d: Vertex,
    parity: i32,
}

fn in_order(a_: Vertex, b_: Vertex, c_: Vertex, d_: Vertex) -> InOrder {
    var a = a_;
    var b = b_;
    var c = c_;
    var d = d_;
    var parity = 1;
    put_in_order(&a, &b, &parity);
    put_in_order(&c, &d, &parity);
    put_in_order(&a, &c, &parity);
    put_in_order(&b, &d, &parity);
    put_in_order(&b, &c, &parity);
    return InOrder(a, b, c, d, parity);
}

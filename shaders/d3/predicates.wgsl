// Orientation and in-sphere: exact.
//
// Conventions as in src/predicates: orient3d(a, b, c, d) is the sign of det(b − a, c − a, d − a);
// insphere(a, b, c, d, e) is positive when e is inside the sphere through the positively oriented
// a, b, c, d, and changes sign with every exchange of two arguments.
//!include d3/exact_{width}
//!include common/unrolled

// det(a, b, c).
fn determinant(a: Row, b: Row, c: Row) -> Determinant {
    return plus(minus(expand(a, minor(b, c)), expand(b, minor(a, c))), expand(c, minor(a, b)));
}

// Returns the sign of det(b − a, c − a, d − a), 0 when the points are coplanar.
fn orient3d_exact(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> i32 {
    return sign_of_determinant(determinant(difference(b, a), difference(c, a), difference(d, a)));
}

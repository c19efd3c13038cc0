// The other bindings of the check in 2D.
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
//!include d2/check_pass

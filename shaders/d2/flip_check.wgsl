// What checking is bound to beside the simplices, in 2D.
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
//!include d2/check_pass

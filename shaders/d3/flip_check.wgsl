// The other bindings of the check in 3D.
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
// Its first words name the entries with undecided signs.
@group(0) @binding(2) var<storage, read_write> messages: array<vec4u>;
//!include d3/check_pass
//!include d3/facet_signs

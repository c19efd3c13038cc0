// Signs on vertices that may be at infinity: the filters first, then the exact arithmetic. Never 0
// where `decides` is set.
//
// Expects: vertices: array<VertexWords>; control.
//!include d3/predicates
//!include d3/filter
//!include d3/refined_{width}

// The number of predicate evaluations of this invocation that the filters did not decide.
var<private> exact_signs: u32 = 0;
// Whether what the first filter leaves open is decided; otherwise its sign is 0.
var<private> decides: bool = true;

// Returns the orientation of four finite vertices. The number of infinity stands for the interior
// point.
fn orient_finite(v: vec4u) -> i32 {
    var sign = orient3d_filter(load_high(v.x), load_high(v.y), load_high(v.z), load_high(v.w));
    if sign == 0 && decides {
        let a = load_vertex(v.x);
        let b = load_vertex(v.y);
        let c = load_vertex(v.z);
        let d = load_vertex(v.w);
        sign = orient3d_refined(a, b, c, d);
        if sign == 0 {
            exact_signs += 1;
            sign = orient3d_exact(a, b, c, d);
            if sign == 0 {
                sign = insphere_filtered(v, control.infinite);
            }
            if sign == 0 {
                sign = perturbed_sign(a, b, c, d, load_vertex(control.infinite), true);
            }
        }
    }
    return sign;
}

fn insphere_filtered(tet: vec4u, e: u32) -> i32 {
    return insphere_filter(load_high(tet.x), load_high(tet.y), load_high(tet.z), load_high(tet.w), load_high(e));
}

fn insphere_finite(tet: vec4u, e: u32) -> i32 {
    var sign = insphere_filtered(tet, e);
    if sign == 0 && decides {
        let a = load_vertex(tet.x);
        let b = load_vertex(tet.y);
        let c = load_vertex(tet.z);
        let d = load_vertex(tet.w);
        let f = load_vertex(e);
        sign = insphere_refined(a, b, c, d, f);
        if sign == 0 {
            exact_signs += 1;
            sign = perturbed_sign(a, b, c, d, f, false);
        }
    }
    return sign;
}
//!include d3/signs_at_infinity

// Signs on vertices that may be at infinity: the filters first, then the exact arithmetic. Never 0
// where `decides` is set.
//
// Expects: vertices: array<VertexWords>; control.
//!include d3/perturbed
//!include d3/filter
//!include d3/refined_{width}

// The number of predicate evaluations of this invocation that the filters did not decide.
var<private> exact_signs: u32 = 0;
// Whether what the first filter leaves open is decided; otherwise its sign is 0.
var<private> decides: bool = true;

// Returns the round in which a vertex was inserted.
fn round_of(v: u32) -> u32 {
    return atomicLoad(&control.free[v]) >> ROUND_SHIFT;
}

// Returns the orientation of four finite vertices if `of_four`, where e is the interior point;
// otherwise whether e is inside the circumsphere of four that are positively oriented. Both in one
// function, so that the exact arithmetic is compiled once.
fn finite_sign(v: vec4u, e: u32, of_four: bool) -> i32 {
    var sign = filtered_sign(v, e, of_four);
    if sign == 0 && decides {
        let a = load_vertex(v.x);
        let b = load_vertex(v.y);
        let c = load_vertex(v.z);
        let d = load_vertex(v.w);
        let f = load_vertex(e);
        if of_four {
            sign = orient3d_refined(a, b, c, d);
        } else {
            sign = insphere_refined(a, b, c, d, f);
        }
        if sign == 0 {
            exact_signs += 1;
            if of_four {
                sign = orient3d_exact(a, b, c, d);
                if sign == 0 {
                    sign = filtered_sign(v, e, false);
                }
            }
            if sign == 0 {
                sign = perturbed_sign(a, b, c, d, f, of_four);
            }
        }
    }
    return sign;
}
//!include d3/signs_at_infinity

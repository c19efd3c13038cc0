//! The rules for WGSL that the build checks: for each, a shader that breaks it, and one like it that does not.

use naga::valid::{Capabilities, ValidationFlags, Validator};

#[path = "../../build/lint.rs"]
#[allow(dead_code)]
mod rules;

/// Returns what the lint says of a shader, whose entry point has these statements.
fn lint_main(declarations: &str, statements: &str) -> Result<(), String> {
    let wgsl = format!(
        "@group(0) @binding(0) var<storage, read_write> data: array<vec4u>;
        {declarations}
        @compute @workgroup_size(64)
        fn main(@builtin(local_invocation_index) local: u32) {{ {statements} }}"
    );
    let module = naga::front::wgsl::parse_str(&wgsl).expect("the shader is WGSL");
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
    rules::lint(&module, &info.expect("the shader is valid")).map_err(|violation| violation.what)
}

#[track_caller]
fn assert_rejected(declarations: &str, statements: &str, what: &str) {
    let said = lint_main(declarations, statements).expect_err("the shader breaks a rule");
    assert!(said.contains(what), "{said}");
}

#[track_caller]
fn assert_passed(declarations: &str, statements: &str) {
    assert_eq!(lint_main(declarations, statements), Ok(()));
}

#[test]
fn loops_are_nested_at_most_two_deep() {
    let nested = |inner: &str| {
        format!(
            "for (var i = 0u; i < data[0].x; i++) {{
                if i > 3 {{ while data[i].y > i {{ {inner} }} }}
            }}"
        )
    };
    assert_rejected("", &nested("loop { if data[2].x > 1 { break; } }"), "`main` has loops nested more than two deep");
    assert_passed("", &nested("data[i].y -= 1;"));
    // A loop of a function counts there.
    let function = "fn count() { for (var k = 0u; k < 4; k++) { data[k].x += 1; } }";
    assert_passed(function, &nested("count();"));
    let function = format!("fn count(i: u32) {{ {} }}", nested("for (var k = 0u; k < 4; k++) { data[k].x += 1; }"));
    assert_rejected(&function, "count(local);", "`count` has loops");
}

#[test]
fn there_is_no_switch() {
    assert_rejected("", "switch local { case 0: { data[0].x = 1; } default: {} }", "a `switch`");
    assert_passed("", "if local == 0 { data[0].x = 1; }");
}

#[test]
fn no_index_chooses_the_component_of_a_vector_that_is_written() {
    assert_rejected("", "var a = data[0]; a[local % 4] = 1; data[1] = a;", "a component of a vector");
    assert_rejected("struct S { v: vec4u } var<private> s: S;", "s.v[local % 4] = 1; data[1] = s.v;", "a component");
    assert_rejected("var<workgroup> w: array<vec2u, 64>;", "w[local][local % 2] = 1;", "a component of a vector");
    let function = "fn put(a: ptr<function, vec4u>, k: u32) { (*a)[k] = 1; }";
    assert_rejected(function, "var a = data[0]; put(&a, local % 4); data[1] = a;", "`put` writes a component");
    // Constant indices, elements of arrays, and buffers.
    assert_passed("", "var a = data[0]; a[2] = 1; data[1] = a;");
    assert_passed("", "var a: array<vec4u, 4>; a[local % 4] = data[0]; data[1] = a[2];");
    assert_passed("", "data[1][local % 4] = 1;");
}

#[test]
fn private_memory_is_small() {
    assert_rejected("", "var a: array<vec4u, 257>; data[1] = a[local];", "4112 bytes");
    assert_passed("", "var a: array<vec4u, 256>; data[1] = a[local];");
    // What functions have, and what is private to an invocation, counts together.
    let declarations = "var<private> b: array<vec4u, 128>;
        fn last(k: u32) -> vec4u { var a: array<vec4u, 128>; a[k] = b[k]; return a[127]; }";
    assert_passed(declarations, "data[1] = last(local);");
    assert_rejected(declarations, "var c = 1u; c += local; data[c] = last(local);", "4100 bytes");
}

#[test]
fn workgroup_memory_is_written_before_it_is_read() {
    let sums = "var<workgroup> sums: array<u32, 64>;";
    assert_rejected(sums, "data[0].x = sums[local];", "`main` reads `sums` before it is written");
    assert_rejected(sums, "let sum = sums[local]; sums[local] = sum + 1;", "reads `sums` before it is written");
    assert_passed(sums, "sums[local] = 1; workgroupBarrier(); data[0].x = sums[63 - local];");
    assert_rejected("var<workgroup> first: u32;", "data[0].x = workgroupUniformLoad(&first);", "reads `first`");
    assert_passed(
        "var<workgroup> first: u32;",
        "if local == 0 { first = 1; } data[0].x = workgroupUniformLoad(&first);",
    );
    // One branch sees nothing of what the other writes.
    assert_rejected(sums, "if local == 0 { sums[0] = 1; } else { data[0].x = sums[local]; }", "reads `sums`");
    // Functions stand in the place of their calls.
    let functions = "var<workgroup> sums: array<u32, 64>;
        fn begin(local: u32) { sums[local] = 1; }
        fn end(local: u32) { data[0].x = sums[local]; }";
    assert_rejected(functions, "end(local); begin(local);", "`end` reads `sums`");
    assert_passed(functions, "begin(local); end(local);");
}

#[test]
fn a_barrier_comes_before_atomic_operations_on_workgroup_memory() {
    let count = "var<workgroup> count: atomic<u32>;";
    let begin = "if local == 0 { atomicStore(&count, 0); }";
    let barrier = "workgroupBarrier();";
    assert_rejected(count, "atomicAdd(&count, 1);", "reads `count` before it is written");
    assert_rejected(count, &format!("{begin} atomicAdd(&count, 1);"), "before a barrier follows");
    assert_rejected(count, &format!("{begin} data[0].x = atomicLoad(&count);"), "before a barrier follows");
    assert_passed(count, &format!("{begin} {barrier} atomicAdd(&count, 1);"));
    // Set back, it waits for a barrier again, also where a loop begins anew.
    assert_rejected(count, &format!("{begin} {barrier} {begin} atomicAdd(&count, 1);"), "before a barrier follows");
    let looped = |end: &str| {
        format!("{begin} {barrier} for (var i = 0u; i < 4; i++) {{ atomicAdd(&count, 1); {barrier} {begin} {end} }}")
    };
    assert_rejected(count, &looped(""), "before a barrier follows");
    assert_passed(count, &looped(barrier));
    let counts = "var<workgroup> counts: array<atomic<u32>, 64>;";
    assert_rejected(counts, "atomicStore(&counts[local], 0); atomicMax(&counts[63 - local], 1);", "before a barrier");
    assert_passed(counts, "atomicStore(&counts[local], 0); workgroupBarrier(); atomicMax(&counts[63 - local], 1);");
}

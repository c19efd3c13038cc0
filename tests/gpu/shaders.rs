//! Every shader that can be assembled is valid WGSL, within the limits that every device has.

use gdel::internals::{
    d3::gpu::vertex,
    gpu::{
        layout::{self, Active, Counters, FlipNode, Params, Status, Waiting},
        points::{InputCounts, InputParams},
        primitives::{
            scan::{self, ScanParams},
            sort::{self, SortParams},
        },
        shader,
    },
    input::lattice::Width,
};
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn validate(name: &str, wgsl: &str) -> (naga::Module, naga::valid::ModuleInfo) {
    let module = naga::front::wgsl::parse_str(wgsl).unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(wgsl)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(wgsl)));
    (module, info)
}

/// The shared files that stand for themselves, with what they expect.
#[test]
fn shared_files_are_valid() {
    for width in [Width::Narrow, Width::Wide] {
        let wgsl = shader::assemble_text(
            "@group(0) @binding(0) var<storage, read> vertices: array<vec4i>;
             //!include shared/predicates\n//!include shared/filter",
            width,
        );
        validate("shared", &wgsl);
    }
}

#[test]
fn kernels_are_valid_and_within_the_limits() {
    let limits = wgpu::Limits::default();
    for (name, width) in shader::kernels().flat_map(|name| [(name, Width::Narrow), (name, Width::Wide)]) {
        let (module, _) = validate(name, &shader::assemble(name, width));
        let [entry] = &module.entry_points[..] else { panic!("{name} has not one entry point") };
        assert_eq!(entry.name, "main", "{name}");
        assert!(entry.workgroup_size.iter().product::<u32>() <= limits.max_compute_invocations_per_workgroup, "{name}");
        let globals = || module.global_variables.iter().map(|(_, variable)| variable);
        let storage = globals().filter(|v| matches!(v.space, naga::AddressSpace::Storage { .. })).count();
        assert!(storage <= limits.max_storage_buffers_per_shader_stage as usize, "{name}: {storage} storage buffers");
        let workgroup = globals()
            .filter(|v| v.space == naga::AddressSpace::WorkGroup)
            .map(|v| module.types[v.ty].inner.size(module.to_ctx()))
            .sum::<u32>();
        assert!(workgroup <= limits.max_compute_workgroup_storage_size, "{name}: {workgroup} bytes");
    }
}

/// A WGSL structure and the Rust structure that mirrors it have the same fields at the same offsets.
macro_rules! assert_layout {
    ($module:expr, $name:ident { $($field:ident),* }) => {{
        let (_, ty) = $module
            .types
            .iter()
            .find(|(_, ty)| ty.name.as_deref() == Some(stringify!($name)))
            .expect(concat!("no structure ", stringify!($name)));
        let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("not a structure") };
        let members: Vec<_> = members.iter().map(|m| (m.name.clone().unwrap(), m.offset as usize)).collect();
        let expected = vec![$((stringify!($field).to_owned(), std::mem::offset_of!($name, $field))),*];
        assert_eq!(members, expected, stringify!($name));
        assert_eq!(*span as usize, size_of::<$name>(), stringify!($name));
    }};
}

/// The value of a constant of WGSL.
fn constant(module: &naga::Module, name: &str) -> u32 {
    let (_, constant) = module
        .constants
        .iter()
        .find(|(_, constant)| constant.name.as_deref() == Some(name))
        .unwrap_or_else(|| panic!("no constant {name}"));
    match module.global_expressions[constant.init] {
        naga::Expression::Literal(naga::Literal::U32(value)) => value,
        ref other => panic!("{name} is {other:?}"),
    }
}

#[test]
fn host_and_shaders_agree() {
    let (module, _) = validate("scan", &shader::assemble("scan_reduce", Width::Narrow));
    assert_layout!(module, ScanParams { count });
    assert_eq!(constant(&module, "SCAN_GROUPS") as usize, scan::GROUPS);
    assert_eq!(constant(&module, "SCAN_STEP") as usize, scan::STEP);
    let (module, _) = validate("sort", &shader::assemble("sort_count", Width::Narrow));
    assert_layout!(module, SortParams { count, shift });
    assert_eq!(constant(&module, "RADIX_TILE") as usize, sort::TILE);
    let (module, _) = validate("sort", &shader::assemble("sort_scan", Width::Narrow));
    assert_eq!(constant(&module, "RADIX_FEW"), sort::FEW);
    let (module, _) = validate("points", &shader::assemble("points_keys", Width::Narrow));
    assert_layout!(
        module,
        InputParams {
            count,
            exponent,
            doubles,
            varies,
            origin_low,
            table_mask,
            origin_high,
            width,
            wanted,
            dimension,
            unused
        }
    );
    assert_layout!(module, InputCounts { merged, duplicates, rounded, unused, stands_for, found });
    let expected = "@group(0) @binding(0) var<storage, read> vertices: array<vec4i>;\n//!include shared/predicates";
    let (module, _) = validate("predicates", &shader::assemble_text(expected, Width::Narrow));
    assert_eq!(constant(&module, "INFINITE"), vertex::INFINITE);
}

#[test]
fn phase1_layouts_agree() {
    let wgsl = "//!include shared/layout
        @group(0) @binding(0) var<storage, read_write> control: Control;
        @group(0) @binding(1) var<storage, read_write> status: array<Status>;
        @group(0) @binding(2) var<storage, read_write> actives: array<Active>;
        @group(0) @binding(3) var<storage, read_write> history: array<FlipNode>;
        @group(0) @binding(4) var<storage, read_write> waiting: array<Waiting>;";
    let (module, _) = validate("layout", &shader::assemble_text(wgsl, Width::Narrow));
    assert_layout!(module, Status { flags, vote, last, first });
    assert_layout!(module, Active { tet, outcome });
    assert_layout!(module, FlipNode { vertices, kind, tets, next });
    assert_layout!(module, Waiting { point, tet });
    // Parameters, then counters.
    let (_, ty) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some("Control")).expect("a structure");
    let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("not a structure") };
    assert_eq!(*span as usize, size_of::<Params>() + size_of::<Counters>());
    let offset = |name: &str| {
        members.iter().find(|m| m.name.as_deref() == Some(name)).unwrap_or_else(|| panic!("no {name}")).offset as usize
    };
    macro_rules! assert_offsets {
        ($name:ident, $start:expr, $($field:ident),*) => {
            $(assert_eq!(offset(stringify!($field)), $start + std::mem::offset_of!($name, $field), stringify!($field));)*
        };
    }
    assert_offsets!(
        Params,
        0,
        infinite,
        blocks,
        history,
        bid_bits,
        min_active,
        pick,
        entries,
        entries_before,
        blocks_before,
        compact_from
    );
    assert_offsets!(
        Counters,
        size_of::<Params>(),
        iteration,
        link_iteration,
        active_len,
        round,
        next_node,
        first_node,
        inserted,
        flips_23,
        flips_32,
        exact,
        overflow,
        iterations,
        visits,
        failed,
        merged,
        uncertain,
        ghosts,
        undecided,
        not_locally_delaunay,
        flips_22,
        hull
    );
    let constants = [
        ("NONE", layout::NONE),
        ("BLOCK", layout::BLOCK),
        ("CHECK", layout::CHECK),
        ("SUSPECT_SHIFT", layout::SUSPECT_SHIFT),
        ("HELD_SHIFT", layout::HELD_SHIFT),
        ("KIND_SHIFT", layout::KIND_SHIFT),
        ("FACET_SHIFT", layout::FACET_SHIFT),
        ("EDGE_SHIFT", layout::EDGE_SHIFT),
        ("FLIP_23", layout::FLIP_23),
        ("FLIP_32", layout::FLIP_32),
        ("DONE", layout::DONE),
        ("SLOT_SHIFT", layout::SLOT_SHIFT),
        ("SLOTS_FULL", layout::SLOTS_FULL),
        ("HISTORY_FULL", layout::HISTORY_FULL),
    ];
    for (name, value) in constants {
        assert_eq!(constant(&module, name), value, "{name}");
    }
}

#[test]
fn plane_layouts_agree() {
    let wgsl = "//!include shared/plane_layout
        @group(0) @binding(0) var<storage, read_write> history: array<EdgeFlip>;
        @group(0) @binding(1) var<storage, read_write> questions: array<UncertainTest>;";
    let (module, _) = validate("layout", &shader::assemble_text(wgsl, Width::Narrow));
    use gdel::internals::d2::gpu::layout::{EdgeFlip, UncertainTest};
    assert_layout!(module, EdgeFlip { edge, triangles, next });
    assert_layout!(module, UncertainTest { triangle, beyond });
    let constants = [
        ("PLANE_BLOCK", gdel::internals::d2::gpu::layout::PLANE_BLOCK),
        ("FLIP_22", gdel::internals::d2::gpu::layout::FLIP_22),
        ("COUNTER_CLOCKWISE", gdel::internals::d2::gpu::layout::COUNTER_CLOCKWISE),
        ("FLAT", gdel::internals::d2::gpu::layout::FLAT),
    ];
    for (name, value) in constants {
        assert_eq!(constant(&module, name), value, "{name}");
    }
}

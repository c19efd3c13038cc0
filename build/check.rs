//! Validation of the shaders, also by the rules of [`lint`](crate::lint), and what the host has to know of them.

use std::collections::BTreeMap;

use naga::{
    AddressSpace, Expression, Handle, Literal, Module, StorageAccess, Type, TypeInner,
    valid::{Capabilities, ValidationFlags, Validator},
};

use crate::{
    lint::{Violation, lint},
    parts,
    sources::File,
};

/// What every WebGPU device supports.
pub const MAX_STORAGE_BUFFERS: usize = 8;
const MAX_INVOCATIONS: u32 = 256;
const MAX_WORKGROUP_BYTES: u32 = 16_384;
/// The constant that the host takes for the size of all workgroups.
const WORKGROUP: &str = "WORKGROUP";

/// What the host has to know of a shader.
#[derive(Default)]
pub struct Reflection {
    /// The storage buffers, with their bindings and whether they are only read.
    pub variables: Vec<(String, u32, bool)>,
    /// The constants of type `u32`.
    pub constants: BTreeMap<String, u32>,
    /// The structures in storage buffers.
    pub structures: BTreeMap<String, Structure>,
}

/// The layout of a structure.
#[derive(PartialEq)]
pub struct Structure {
    /// Bytes, of an element of an array.
    pub size: u32,
    /// The members, with the bytes before each.
    pub members: Vec<(String, u32)>,
}

/// Returns the WGSL of the shader that these files make up for arrays in parts, validated, if it has such
/// arrays.
///
/// # Errors
///
/// Says what is wrong.
pub fn in_parts(parts: &[&File]) -> Result<Option<String>, String> {
    let wgsl: String = parts.iter().map(|file| file.code()).collect();
    let path = kernel(parts).path();
    let parse = |wgsl: &str| {
        naga::front::wgsl::parse_str(wgsl)
            .map_err(|e| format!("{path}, in parts: {}", e.emit_to_string_with_path(wgsl, "assembled")))
    };
    let Some(text) = parts::in_parts(&wgsl, &parse(&wgsl)?).map_err(|what| format!("{path}: {what}"))? else {
        return Ok(None);
    };
    let module = parse(&text)?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|e| format!("{path}, in parts: {}", e.emit_to_string_with_path(&text, "assembled")))?;
    lint(&module, &info).map_err(|Violation { what, .. }| format!("{path}, in parts: {what}"))?;
    Ok(Some(text))
}

/// Validates the shader that these files make up, for devices with these capabilities beside those of WebGPU.
///
/// # Errors
///
/// Says what is wrong, and in which line of which file.
pub fn check(parts: &[&File], capabilities: Capabilities) -> Result<Reflection, String> {
    let wgsl: String = parts.iter().map(|file| file.code()).collect();
    let places: Vec<_> = parts.iter().flat_map(|file| file.line_numbers().map(|line| (file.path(), line))).collect();
    let describe = |location: Option<naga::SourceLocation>, emitted: String| {
        let at = location.and_then(|location| places.get(location.line_number as usize - 1));
        let at = at.map_or_else(|| kernel(parts).path(), |(path, line)| format!("{path}:{line}"));
        format!("{at}: {}", emitted.trim_start_matches("error: "))
    };
    let module = naga::front::wgsl::parse_str(&wgsl)
        .map_err(|e| describe(e.location(&wgsl), e.emit_to_string_with_path(&wgsl, "assembled")))?;
    let info = Validator::new(ValidationFlags::all(), capabilities)
        .validate(&module)
        .map_err(|e| describe(e.location(&wgsl), e.emit_to_string_with_path(&wgsl, "assembled")))?;
    lint(&module, &info).map_err(|Violation { span, what }| {
        let location = span.is_defined().then(|| span.location(&wgsl));
        describe(location, format!("{what} (in the kernel `{}`)", kernel(parts).name))
    })?;
    let reject = |what: String| Err(format!("{}: {what}", kernel(parts).path()));

    let [entry] = &module.entry_points[..] else { return reject("it has not one entry point".to_owned()) };
    if entry.name != "main" {
        return reject(format!("its entry point is `{}`, not `main`", entry.name));
    }
    let workgroup = module.constants.iter().find(|(_, constant)| constant.name.as_deref() == Some(WORKGROUP));
    let invocations = workgroup.and_then(|(_, constant)| value(&module, constant.init));
    if invocations.is_none_or(|n| n > MAX_INVOCATIONS || entry.workgroup_size != [n, 1, 1]) {
        return reject(format!("its workgroups have {:?} invocations, not `{WORKGROUP}`", entry.workgroup_size));
    }
    let bytes = module
        .global_variables
        .iter()
        .filter(|(_, variable)| variable.space == AddressSpace::WorkGroup)
        .map(|(_, variable)| module.types[variable.ty].inner.size(module.to_ctx()))
        .sum::<u32>();
    if bytes > MAX_WORKGROUP_BYTES {
        return reject(format!("{bytes} bytes of workgroup memory are too many"));
    }

    let mut reflection = Reflection::default();
    for (handle, variable) in module.global_variables.iter() {
        let name = variable.name.clone().unwrap_or_default();
        let Some(binding) = variable.binding else { continue };
        let AddressSpace::Storage { access } = variable.space else {
            return reject(format!("`{name}` is not a storage buffer"));
        };
        if binding.group != 0 {
            return reject(format!("`{name}` is not in group 0"));
        }
        // The layouts of pipelines have what their shader uses, and no more.
        if info.get_entry_point(0)[handle].is_empty() {
            return reject(format!("`{name}` is not used"));
        }
        reflection.variables.push((name, binding.binding, !access.contains(StorageAccess::STORE)));
        add_structures(&module, variable.ty, &mut reflection.structures);
    }
    reflection.variables.sort_by_key(|&(_, binding, _)| binding);
    if reflection.variables.len() > MAX_STORAGE_BUFFERS {
        return reject(format!("{} storage buffers are too many", reflection.variables.len()));
    }
    for (_, constant) in module.constants.iter() {
        if let (Some(name), Some(value)) = (&constant.name, value(&module, constant.init)) {
            reflection.constants.insert(name.clone(), value);
        }
    }
    Ok(reflection)
}

fn kernel<'a>(parts: &[&'a File]) -> &'a File {
    parts.last().expect("a shader has files")
}

fn value(module: &Module, expression: Handle<Expression>) -> Option<u32> {
    match module.global_expressions[expression] {
        Expression::Literal(Literal::U32(value)) => Some(value),
        Expression::Constant(constant) => value(module, module.constants[constant].init),
        _ => None,
    }
}

/// Adds the structures in a type.
fn add_structures(module: &Module, ty: Handle<Type>, structures: &mut BTreeMap<String, Structure>) {
    let Type { name, inner } = &module.types[ty];
    match inner {
        TypeInner::Array { base, .. } => add_structures(module, *base, structures),
        TypeInner::Struct { members, span } => {
            let named = members.iter().map(|member| (member.name.clone().unwrap_or_default(), member.offset));
            let structure = Structure { size: *span, members: named.collect() };
            structures.insert(name.clone().unwrap_or_default(), structure);
            members.iter().for_each(|member| add_structures(module, member.ty, structures));
        }
        _ => {}
    }
}

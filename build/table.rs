//! The generated module.

use std::{
    collections::{BTreeMap, btree_map::Entry},
    env,
    fmt::Write,
    fs,
    hash::{DefaultHasher, Hash, Hasher},
    path::{Path, PathBuf},
};

use naga::valid::Capabilities;

use crate::{
    check::{self, Reflection, Structure, check},
    parts,
    sources::{File, Sources},
};

/// The values of `{dim}`, which are also folders.
const DIMENSIONS: [&str; 2] = ["d2", "d3"];
/// The values of `{width}`.
const WIDTHS: [&str; 2] = ["narrow", "wide"];
/// The structure of `control` is two on the host: the second begins with the first of these
/// members, and ends before the second one, an array as long as there is room.
const CONTROL: (&str, &str, &str) = ("Control", "iteration", "free");

/// Kernels that modules of WebAssembly do without: those for questions that only native programs ask.
const NATIVE: [&str; 3] = ["query_", "edges_", "survivors_"];
/// Kernels of 3D that there are only for whole arrays: those that look at the mesh of the caller, and
/// that of iterations in one workgroup, of which a run with so many points has few.
const WHOLE: [&str; 4] = ["flip_few", "query_", "edges_", "survivors_"];

/// The file with the products of limbs, and that which takes its place on devices with 64-bit integers.
const MULTIPLY: [&str; 2] = ["arithmetic/multiply", "arithmetic/multiply_int64"];

/// A shader in all its forms.
struct Shader<'a> {
    name: String,
    /// The files for each width.
    parts: [Vec<&'a File>; 2],
    variables: Vec<(String, u32, bool)>,
}

/// What the shaders declare for the host, with the folder of the file that declares it.
#[derive(Default)]
struct Declarations {
    constants: BTreeMap<(String, String), u32>,
    structures: BTreeMap<String, Structure>,
}

/// Writes the generated module.
///
/// # Errors
///
/// Says what is wrong with a shader.
pub fn write() -> Result<(), String> {
    let sources = Sources::read(Path::new("shaders")).map_err(|e| format!("shaders: {e}"))?;
    let mut declarations = Declarations::default();
    // Of the dimensions, and of none.
    let mut tables: [Vec<Shader<'_>>; 3] = Default::default();
    for file in sources.files().filter(|file| file.is_kernel()) {
        let (folder, name) = file.name.split_once('/').ok_or_else(|| format!("{}: it is in no folder", file.path()))?;
        let shader = |dimension: &str| -> Result<_, String> {
            let [narrow, wide] =
                WIDTHS.map(|width| sources.assemble(file, &[("{dim}", dimension), ("{width}", width)]));
            Ok([narrow?, wide?])
        };
        match DIMENSIONS.iter().position(|&dimension| dimension == folder) {
            Some(i) => tables[i].push(declarations.add(file.name.clone(), shader(folder)?)?),
            None => {
                let forms = DIMENSIONS.map(shader);
                let [first, second] = forms;
                let (first, second) = (first?, second?);
                if names(&first) == names(&second) {
                    tables[2].push(declarations.add(file.name.clone(), first)?);
                } else {
                    for (i, parts) in [first, second].into_iter().enumerate() {
                        tables[i].push(declarations.add(format!("{}/{name}", DIMENSIONS[i]), parts)?);
                    }
                }
            }
        }
    }
    // A module of WebAssembly is downloaded. Natively the names stay, for the messages of drivers.
    let is_downloaded = env::var("CARGO_CFG_TARGET_FAMILY").as_deref() == Ok("wasm");
    if is_downloaded {
        let is_native = |name: &str| NATIVE.iter().any(|native| name.split('/').any(|part| part.starts_with(native)));
        tables.iter_mut().for_each(|table| table.retain(|shader| !is_native(&shader.name)));
    }
    let in_parts = if is_downloaded { BTreeMap::new() } else { in_parts(&tables)? };
    if !is_downloaded {
        check_int64(&sources, &tables)?;
    }
    let sources = if is_downloaded { &shortened(&sources, &tables)? } else { &sources };
    let module = module(sources, &tables, &declarations, &in_parts).expect("strings can be written to");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it")).join("shaders.rs");
    fs::write(&out, module).map_err(|e| format!("{}: {e}", out.display()))
}

/// Returns the WGSL of the kernels of 3D with arrays in parts, for each width, by name.
fn in_parts(tables: &[Vec<Shader<'_>>; 3]) -> Result<BTreeMap<String, [String; 2]>, String> {
    let mut texts = BTreeMap::new();
    let has_parts = |shader: &&Shader<'_>| {
        let name = shader.name.rsplit('/').next().unwrap_or_default();
        !WHOLE.iter().any(|whole| name.starts_with(whole))
    };
    for shader in tables[1..].iter().flatten().filter(has_parts) {
        let [narrow, wide] = shader.parts.each_ref().map(|parts| check::in_parts(parts));
        if let (Some(narrow), Some(wide)) = (narrow?, wide?) {
            texts.insert(shader.name.clone(), [narrow, wide]);
        }
    }
    Ok(texts)
}

/// Validates the shaders for devices with 64-bit integers.
fn check_int64(sources: &Sources, tables: &[Vec<Shader<'_>>; 3]) -> Result<(), String> {
    let [portable, int64] = MULTIPLY.map(|name| sources.get(name).expect("there is such a file"));
    for parts in tables.iter().flatten().flat_map(|shader| &shader.parts) {
        if parts.iter().any(|file| file.name == portable.name) {
            let mut parts = parts.clone();
            parts.iter_mut().filter(|file| file.name == portable.name).for_each(|file| *file = int64);
            check(&parts, Capabilities::SHADER_INT64)?;
        }
    }
    Ok(())
}

/// Returns the sources with short names, with which the shaders are validated once more.
fn shortened(sources: &Sources, tables: &[Vec<Shader<'_>>; 3]) -> Result<Sources, String> {
    let short = sources.shortened();
    for parts in tables.iter().flatten().flat_map(|shader| &shader.parts) {
        let parts: Vec<&File> =
            parts.iter().map(|file| short.get(&file.name).expect("it has the same files")).collect();
        check(&parts, Capabilities::empty())?;
    }
    Ok(short)
}

fn names<'a>(parts: &'a [Vec<&File>; 2]) -> Vec<&'a str> {
    parts.iter().flatten().map(|file| &*file.name).collect()
}

impl Declarations {
    /// Validates a shader.
    fn add<'a>(&mut self, name: String, parts: [Vec<&'a File>; 2]) -> Result<Shader<'a>, String> {
        let [narrow, wide] = &parts;
        let reflection = check(narrow, Capabilities::empty())?;
        let variables = reflection.variables.clone();
        self.declare(narrow, reflection)?;
        if narrow.iter().map(|file| &file.name).ne(wide.iter().map(|file| &file.name)) {
            let reflection = check(wide, Capabilities::empty())?;
            if reflection.variables != variables {
                return Err(format!("shaders/{name}: it uses other buffers for wide coordinates than for narrow ones"));
            }
            self.declare(wide, reflection)?;
        }
        Ok(Shader { name, parts, variables })
    }

    fn declare(&mut self, parts: &[&File], reflection: Reflection) -> Result<(), String> {
        for (name, value) in reflection.constants {
            let file = parts.iter().find(|file| file.declares("const", &name)).expect("a file declares it");
            let folder = file.name.split('/').next().expect("it is in a folder").to_owned();
            match self.constants.entry((folder, name)) {
                Entry::Occupied(entry) if *entry.get() != value => {
                    return Err(format!("{}: `{}` has another value in another file", file.path(), entry.key().1));
                }
                Entry::Occupied(_) => {}
                Entry::Vacant(entry) => _ = entry.insert(value),
            }
        }
        for (name, structure) in reflection.structures {
            match self.structures.entry(name) {
                Entry::Occupied(entry) if *entry.get() != structure => {
                    return Err(format!("{}: `{}` has two layouts", kernel(parts), entry.key()));
                }
                Entry::Occupied(_) => {}
                Entry::Vacant(entry) => _ = entry.insert(structure),
            }
        }
        Ok(())
    }
}

fn kernel(parts: &[&File]) -> String {
    parts.last().expect("a shader has files").path()
}

/// Returns the text of the generated module.
fn module(
    sources: &Sources,
    tables: &[Vec<Shader<'_>>; 3],
    declarations: &Declarations,
    in_parts: &BTreeMap<String, [String; 2]>,
) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for file in sources.files() {
        writeln!(text, "#[allow(dead_code)]\nconst {}: &str = {:?};", constant(file), file.code())?;
    }
    let [d2, d3, common] = tables;
    let all = [("D2", "triangles", Some(d2)), ("D3", "tetrahedra", Some(d3)), ("COMMON", "any simplices", None)];
    for (name, simplices, own) in all {
        writeln!(text, "/// The kernels for {simplices}.\npub static {name}: Shaders = Shaders(&[")?;
        for Shader { name, parts, variables } in own.into_iter().flatten().chain(common) {
            let [narrow, wide] = parts.each_ref().map(|parts| {
                let constants: Vec<_> = parts.iter().map(|file| constant(file)).collect();
                constants.join(", ")
            });
            write!(text, "Shader {{ name: {name:?}, narrow: &[{narrow}], wide: &[{wide}], variables: &{variables:?}")?;
            let texts = in_parts.get(name).filter(|_| own.is_none_or(|own| std::ptr::eq(own, d3)));
            writeln!(text, ", in_parts: {texts:?} }},")?;
        }
        writeln!(text, "]);")?;
    }
    let (buffers, unit) = (check::MAX_STORAGE_BUFFERS, parts::UNIT);
    let (arrays, stride) = (parts::ARRAYS, parts::STRIDE);
    let parts = if in_parts.is_empty() { 1 } else { parts::PARTS };
    writeln!(text, "/// The arrays that can be in parts.\nconst ARRAYS_IN_PARTS: &[&str] = &{arrays:?};")?;
    writeln!(text, "/// The most parts of an array.\npub(crate) const PARTS: u32 = {parts};")?;
    writeln!(
        text,
        "/// From the binding of a part to that of the next one.\npub(crate) const PART_STRIDE: u32 = {stride};"
    )?;
    writeln!(text, "/// The bytes that sizes of parts are multiples of.\npub(crate) const PART_UNIT: u64 = {unit};")?;
    writeln!(text, "/// The storage buffers of a kernel, at most.\npub(crate) const MAX_BUFFERS: u32 = {buffers};")?;
    write_constants(&mut text, declarations)?;
    write_layouts(&mut text, declarations)?;
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    let digest = hasher.finish();
    writeln!(
        text,
        "/// Tells these shaders from those of other versions.\n#[allow(dead_code)]\npub(crate) const DIGEST: u64 = {digest};"
    )?;
    Ok(text)
}

/// Returns the name of the constant that holds a file's text.
fn constant(file: &File) -> String {
    file.name.replace('/', "_").to_uppercase()
}

fn write_constants(text: &mut String, declarations: &Declarations) -> std::fmt::Result {
    writeln!(text, "/// The constants of the shaders, by folder.\n#[allow(dead_code)]\npub(crate) mod constants {{")?;
    let mut before = None;
    for ((folder, name), value) in &declarations.constants {
        if before != Some(folder) {
            let end = if before.is_some() { "}\n" } else { "" };
            writeln!(text, "{end}pub(crate) mod {folder} {{")?;
            before = Some(folder);
        }
        writeln!(text, "pub(crate) const {name}: u32 = {value};")?;
    }
    writeln!(text, "}}\n}}")
}

/// Writes a macro that takes the name of a structure of the host and asserts that it has the layout
/// that the shaders' one of this name has.
fn write_layouts(text: &mut String, declarations: &Declarations) -> std::fmt::Result {
    writeln!(text, "macro_rules! assert_layout {{")?;
    for (name, structure) in &declarations.structures {
        let Structure { size, members } = structure;
        if name == CONTROL.0 {
            let at = |name| members.iter().position(|(member, _)| member == name).expect("it has this member");
            let (start, end) = (at(CONTROL.1), at(CONTROL.2));
            let (params, counters) = (&members[..start], &members[start..end]);
            let (before, behind) = (members[start].1, members[end].1);
            write_layout(text, "Params", before, params, 0)?;
            write_layout(text, "Counters", behind - before, counters, before)?;
        } else {
            write_layout(text, name, *size, members, 0)?;
        }
    }
    writeln!(text, "}}\npub(crate) use assert_layout;")
}

fn write_layout(text: &mut String, name: &str, size: u32, members: &[(String, u32)], start: u32) -> std::fmt::Result {
    writeln!(text, "({name}) => {{ const _: () = {{")?;
    writeln!(text, "assert!(size_of::<{name}>() == {size}, \"{name} has another size in the shaders\");")?;
    for (member, offset) in members {
        let offset = offset - start;
        writeln!(
            text,
            "assert!(std::mem::offset_of!({name}, {member}) == {offset}, \"{name}::{member} lies elsewhere in the shaders\");"
        )?;
    }
    writeln!(text, "}}; }};")
}

//! Shaders for arrays that are larger than one binding: in parts, each with a binding of its own.
//!
//! An array `a` becomes `a`, `a_1`, `a_2`, …, and every access to an element a call of a function
//! that chooses the part. WGSL has no references to elements that could be passed on, so there is a
//! function for each form of access: what is done, and the path from the element on.

use std::collections::BTreeMap;

use naga::{AddressSpace, Handle, Module, Scalar, ScalarKind, Type, TypeInner, VectorSize};

/// The arrays that have an element per slot, or more than 16 bytes per point.
pub const ARRAYS: [&str; 20] = [
    "actives",
    "gathered_neighbors",
    "gathered_slots",
    "gathered_tetrahedra",
    "history",
    "input",
    "marks",
    "mesh_neighbors",
    "mesh_tetrahedra",
    "messages",
    "neighbors",
    "numbers",
    "offsets",
    "picks",
    "region_numbers",
    "simplices",
    "status",
    "uncertain",
    "values",
    "vertices",
];

/// The parts of each array, at most: as many slots as a facet can be numbered in. Lines for part `k`
/// begin with `/*k*/`, and are left out where there are fewer.
pub const PARTS: u32 = 8;

/// Part `k` of an array with binding `b` has binding `b + k * STRIDE`.
pub const STRIDE: u32 = 16;

/// The bytes that sizes of parts are multiples of: a whole number of elements of every size.
pub const UNIT: u32 = 48;

/// Returns the WGSL in which arrays are in parts; `None` if no array of this shader is. The size of
/// a part is the constant `PART`, in units of 48 bytes.
///
/// # Errors
///
/// Says which access is of a form that this does not know.
pub fn in_parts(wgsl: &str, module: &Module) -> Result<Option<String>, String> {
    let mut arrays = BTreeMap::new();
    for (_, variable) in module.global_variables.iter() {
        let name = variable.name.as_deref().unwrap_or_default();
        if let AddressSpace::Storage { .. } = variable.space
            && ARRAYS.contains(&name)
            && let TypeInner::Array { base, stride, .. } = module.types[variable.ty].inner
        {
            if !UNIT.is_multiple_of(stride) {
                return Err(format!("`{name}` has elements of {stride} bytes"));
            }
            arrays.insert(name.to_owned(), (base, UNIT / stride));
        }
    }
    if arrays.is_empty() {
        return Ok(None);
    }
    let mut rewriter = Rewriter { module, arrays, functions: BTreeMap::new() };
    let mut text = String::from("override PART:u32;\n");
    for line in wgsl.lines() {
        match rewriter.declaration(line) {
            Some(parts) => text.push_str(&parts),
            None => text.push_str(&(rewriter.rewrite(line)? + "\n")),
        }
    }
    rewriter.functions.values().for_each(|function| text.push_str(function));
    Ok(Some(text))
}

/// What is done with an element, or a part of it.
#[derive(PartialEq)]
enum Access<'a> {
    Load,
    Store,
    /// The function of this name is called.
    Atomic(&'a str),
}

/// An element of an array, or a part of it.
struct Place<'a> {
    array: &'a str,
    /// Its type.
    ty: Handle<Type>,
    /// The path to it from the array, with parameters for the indices after the first.
    path: String,
    /// The same, for the name of a function.
    label: String,
    /// The indices.
    indices: Vec<String>,
}

struct Rewriter<'a> {
    module: &'a Module,
    /// The arrays by name, with the type of an element, and how many of these a unit holds.
    arrays: BTreeMap<String, (Handle<Type>, u32)>,
    /// The functions by name.
    functions: BTreeMap<String, String>,
}

impl Rewriter<'_> {
    /// Returns the declarations of the parts, if the line declares one of the arrays.
    fn declaration(&self, line: &str) -> Option<String> {
        let rest = line.strip_prefix("@group(0)@binding(")?;
        let (binding, rest) = rest.split_once(')')?;
        let (space, rest) = rest.split_once('>')?;
        let (name, ty) = rest.split_once(':')?;
        self.arrays.contains_key(name).then(|| {
            let binding: u32 = binding.parse().expect("bindings are numbers");
            let declared =
                |k| format!("@group(0)@binding({}){space}>{}:{ty}\n", binding + k * STRIDE, part_name(name, k));
            (0..PARTS).map(|k| of_part(k, &declared(k))).collect()
        })
    }

    /// Returns the code with calls for all accesses.
    fn rewrite(&mut self, code: &str) -> Result<String, String> {
        let mut text = String::new();
        let mut rest = code;
        while let Some(c) = rest.chars().next() {
            let len = rest.find(|c| !is_of_word(c)).unwrap_or(rest.len()).max(c.len_utf8());
            let (word, after) = rest.split_at(len);
            let called = after.strip_prefix("(&").filter(|_| word.starts_with("atomic"));
            // The name of a member is none of a variable.
            let is_member = text.ends_with('.');
            if let Some(place) = called.filter(|place| self.array_of(place).is_some()) {
                rest = self.access(place, Some(word), &mut text)?;
            } else if !is_member && self.array_of(rest).is_some() {
                if ["(&", "=&", ",&"].iter().any(|reference| text.ends_with(reference)) {
                    return Err(format!("a reference to an element is kept: {code}"));
                }
                rest = self.access(rest, None, &mut text)?;
            } else {
                text.push_str(word);
                rest = after;
            }
        }
        Ok(text)
    }

    /// Returns the array of which `code` begins with an element.
    fn array_of<'b>(&self, code: &'b str) -> Option<&'b str> {
        let len = code.find(|c| !is_of_word(c))?;
        let (name, rest) = code.split_at(len);
        (rest.starts_with('[') && self.arrays.contains_key(name)).then_some(name)
    }

    /// Returns the place that `code` begins with, and what follows.
    fn place<'b>(&mut self, code: &'b str) -> Result<(Place<'b>, &'b str), String> {
        let array = self.array_of(code).expect("it begins with an element");
        let (index, mut rest) = brackets(&code[array.len()..]);
        let indices = vec![self.rewrite(index)?];
        let mut place = Place { array, ty: self.arrays[array].0, path: String::new(), label: String::new(), indices };
        loop {
            if rest.starts_with('[') {
                let (index, after) = brackets(rest);
                place.ty = self.element(place.ty).ok_or_else(|| format!("there is no such element: {code}"))?;
                place.path.push_str(&format!("[i{}]", place.indices.len()));
                place.label.push_str("_at");
                place.indices.push(self.rewrite(index)?);
                rest = after;
            } else if let Some(after) = rest.strip_prefix('.') {
                let len = after.find(|c| !is_of_word(c)).unwrap_or(after.len());
                let (member, after) = after.split_at(len);
                // Several components at once are taken from what is loaded.
                let Some(ty) = self.member(place.ty, member) else { return Ok((place, rest)) };
                place.ty = ty;
                place.path.push_str(&format!(".{member}"));
                place.label.push_str(&format!("_{member}"));
                rest = after;
            } else {
                return Ok((place, rest));
            }
        }
    }

    /// Appends the call for the access that `code` begins with, for the atomic function that is called
    /// with it if there is one. Returns what follows.
    fn access<'b>(&mut self, code: &'b str, atomic: Option<&str>, text: &mut String) -> Result<&'b str, String> {
        const OPERATORS: [&str; 10] = ["+", "-", "*", "/", "%", "&", "|", "^", "<<", ">>"];
        let (place, rest) = self.place(code)?;
        let (access, value, rest) = if let Some(function) = atomic {
            let inside = format!("({rest}");
            let (more, _) = brackets(&inside);
            let value = more.strip_prefix(',').map(|value| self.rewrite(value)).transpose()?;
            (Access::Atomic(function), value, &rest[more.len() + 1..])
        } else if rest.starts_with('=') && !rest.starts_with("==") {
            let statement = rest[1..].split_once(';');
            let (value, after) = statement.ok_or_else(|| format!("a statement of several lines: {code}"))?;
            (Access::Store, Some(self.rewrite(value)?), after)
        } else if OPERATORS.iter().any(|o| rest.strip_prefix(o).is_some_and(|after| after.starts_with('='))) {
            return Err(format!("an assignment with an operator: {code}"));
        } else {
            (Access::Load, None, rest)
        };
        let function = self.function(&access, &place);
        let arguments: Vec<String> = place.indices.into_iter().chain(value).collect();
        let end = if access == Access::Store { ";" } else { "" };
        text.push_str(&format!("{function}({}){end}", arguments.join(",")));
        Ok(rest)
    }

    /// Returns the name of the function for an access, and adds it if it is new.
    fn function(&mut self, access: &Access<'_>, place: &Place<'_>) -> String {
        let Place { array, ty, path, label, indices } = place;
        let (verb, takes_value, returns) = match access {
            Access::Load => ("load", false, true),
            Access::Store => ("store", true, false),
            Access::Atomic(function) => (*function, *function != "atomicLoad", *function != "atomicStore"),
        };
        let ty = self.type_name(*ty);
        let function = format!("{verb}_{array}{label}");
        let mut parameters: Vec<String> = (0..indices.len()).map(|i| format!("i{i}:u32")).collect();
        if takes_value {
            parameters.push(format!("value:{ty}"));
        }
        let result = if returns { format!("->{ty}") } else { String::new() };
        let per_unit = self.arrays[*array].1;
        let in_part = |k: u32| {
            let place = format!("{}[i0-{}u*PART]{path}", part_name(array, k), k * per_unit);
            let done = match access {
                Access::Load => format!("return {place};"),
                Access::Store => format!("{place}=value;return;"),
                Access::Atomic(_) => {
                    let value = if takes_value { ",value" } else { "" };
                    let call = format!("{verb}(&{place}{value});");
                    if returns { format!("return {call}") } else { format!("{call}return;") }
                }
            };
            // From the last one on, so that those that are left out are not missed.
            if k == 0 { done } else { of_part(k, &format!("if i0>={}u*PART{{{done}}}\n", k * per_unit)) }
        };
        let body: String = (0..PARTS).rev().map(in_part).collect();
        let text = format!("fn {function}({}){result}{{\n{body}\n}}\n", parameters.join(","));
        self.functions.entry(function.clone()).or_insert(text);
        function
    }

    /// Returns the type of an element.
    fn element(&self, ty: Handle<Type>) -> Option<Handle<Type>> {
        match self.module.types[ty].inner {
            TypeInner::Array { base, .. } => Some(base),
            TypeInner::Vector { scalar, .. } => self.scalar(scalar),
            _ => None,
        }
    }

    /// Returns the type of a member, or of a component of a vector.
    fn member(&self, ty: Handle<Type>, name: &str) -> Option<Handle<Type>> {
        match &self.module.types[ty].inner {
            TypeInner::Struct { members, .. } => {
                members.iter().find(|member| member.name.as_deref() == Some(name)).map(|member| member.ty)
            }
            &TypeInner::Vector { scalar, .. } if name.len() == 1 => self.scalar(scalar),
            _ => None,
        }
    }

    fn scalar(&self, scalar: Scalar) -> Option<Handle<Type>> {
        self.module.types.iter().find(|(_, ty)| ty.inner == TypeInner::Scalar(scalar)).map(|(handle, _)| handle)
    }

    /// Returns the name of the type of a value.
    fn type_name(&self, ty: Handle<Type>) -> String {
        let Type { name, inner } = &self.module.types[ty];
        let short = |scalar: &Scalar| match scalar.kind {
            ScalarKind::Sint => "i",
            ScalarKind::Float => "f",
            _ => "u",
        };
        match inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => format!("{}32", short(scalar)),
            TypeInner::Vector { size, scalar } => {
                let size = match size {
                    VectorSize::Bi => 2,
                    VectorSize::Tri => 3,
                    VectorSize::Quad => 4,
                };
                format!("vec{size}{}", short(scalar))
            }
            TypeInner::Array { base, size: naga::ArraySize::Constant(len), .. } => {
                format!("array<{},{len}>", self.type_name(*base))
            }
            _ => name.clone().unwrap_or_default(),
        }
    }
}

/// Returns the name of part `k` of an array.
fn part_name(array: &str, k: u32) -> String {
    if k == 0 { array.to_owned() } else { format!("{array}_{k}") }
}

/// Returns a line that there is only if there are more than `k` parts.
fn of_part(k: u32, line: &str) -> String {
    if k == 0 { line.to_owned() } else { format!("/*{k}*/{line}") }
}

fn is_of_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Returns what stands between the bracket that `code` begins with and its match, and what follows.
///
/// # Panics
///
/// Panics if there is no match: a statement of several lines.
fn brackets(code: &str) -> (&str, &str) {
    let mut depth = 0;
    for (i, c) in code.char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return (&code[1..i], &code[i + 1..]);
        }
    }
    panic!("a bracket without a match: {code}");
}

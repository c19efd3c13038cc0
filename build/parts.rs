//! Shaders for arrays that are larger than one binding: in parts, each with a binding of its own.
//!
//! An array `a` becomes `a`, `a_1`, `a_2`, …, and every access to an element a call of a function
//! that chooses the part. WGSL has no references to elements that could be passed on, so there is a
//! function for each form of access: what is done, and the path from the element on.

use std::{collections::BTreeMap, fmt::Write};

use naga::{AddressSpace, Handle, Module, Scalar, ScalarKind, Type, TypeInner, VectorSize};

/// The arrays that have an element of 16 bytes per slot, or more.
pub const ARRAYS: [&str; 12] = [
    "actives",
    "gathered_neighbors",
    "gathered_tetrahedra",
    "history",
    "mesh_neighbors",
    "mesh_tetrahedra",
    "messages",
    "neighbors",
    "picks",
    "simplices",
    "status",
    "uncertain",
];

/// The parts of each array. With all of them a kernel has no more than 32 storage buffers, which
/// devices for more points than one part holds have, and software devices, too.
pub const PARTS: u32 = 4;

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
            if UNIT % stride != 0 {
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
            None => writeln!(text, "{}", rewriter.rewrite(line)?).expect("strings can be written to"),
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
            let part = |k: u32| {
                let number = if k == 0 { String::new() } else { format!("_{k}") };
                format!("@group(0)@binding({}){space}>{name}{number}:{ty}\n", binding + k * STRIDE)
            };
            (0..PARTS).map(part).collect()
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

    /// Appends the call for the access that `code` begins with, for the atomic function that is called
    /// with it if there is one. Returns what follows.
    fn access<'b>(&mut self, code: &'b str, atomic: Option<&str>, text: &mut String) -> Result<&'b str, String> {
        let name = self.array_of(code).expect("it begins with an element");
        let (mut ty, per_unit) = self.arrays[name];
        let (index, mut rest) = brackets(&code[name.len()..]);
        let mut arguments = vec![self.rewrite(index)?];
        let (mut path, mut label) = (String::new(), String::new());
        loop {
            if rest.starts_with('[') {
                let (index, after) = brackets(rest);
                ty = self.element(ty).ok_or_else(|| format!("`{name}` has no such element: {code}"))?;
                write!(path, "[i{}]", arguments.len()).expect("strings can be written to");
                label.push_str("_at");
                arguments.push(self.rewrite(index)?);
                rest = after;
            } else if let Some(after) = rest.strip_prefix('.') {
                let len = after.find(|c| !is_of_word(c)).unwrap_or(after.len());
                let (member, after) = after.split_at(len);
                // Several components at once are taken from what is loaded.
                let Some(of_member) = self.member(ty, member) else { break };
                ty = of_member;
                write!(path, ".{member}").expect("strings can be written to");
                write!(label, "_{member}").expect("strings can be written to");
                rest = after;
            } else {
                break;
            }
        }
        let access = match atomic {
            Some(function) => Access::Atomic(function),
            None if rest.starts_with('=') && !rest.starts_with("==") => Access::Store,
            None => Access::Load,
        };
        let assigns = |operator: &&str| rest.strip_prefix(*operator).is_some_and(|after| after.starts_with('='));
        if access == Access::Load && ["+", "-", "*", "/", "%", "&", "|", "^", "<<", ">>"].iter().any(|o| assigns(o)) {
            return Err(format!("an assignment with an operator: {code}"));
        }
        if access == Access::Store {
            let (value, after) =
                rest[1..].split_once(';').ok_or_else(|| format!("a statement of several lines: {code}"))?;
            arguments.push(self.rewrite(value)?);
            rest = after;
        } else if let Access::Atomic(_) = access {
            let inside = format!("({rest}");
            let (more, _) = brackets(&inside);
            rest = &rest[more.len() + 1..];
            let more = more.strip_prefix(',').map(|more| self.rewrite(more)).transpose()?;
            arguments.extend(more);
        }
        let end = if access == Access::Store { ";" } else { "" };
        let function = self.function(&access, name, per_unit, ty, &path, &label, arguments.len());
        write!(text, "{function}({}){end}", arguments.join(",")).expect("strings can be written to");
        Ok(rest)
    }

    /// Returns the name of the function for an access with so many arguments, and adds it if it is
    /// new.
    #[expect(clippy::too_many_arguments, reason = "they are what an access consists of")]
    fn function(
        &mut self,
        access: &Access<'_>,
        name: &str,
        per_unit: u32,
        ty: Handle<Type>,
        path: &str,
        label: &str,
        arguments: usize,
    ) -> String {
        let (verb, with_value) = match access {
            Access::Load => ("load", false),
            Access::Store => ("store", true),
            Access::Atomic(function) => (*function, *function != "atomicLoad"),
        };
        let ty = self.type_name(ty);
        let function = format!("{verb}_{name}{label}");
        let indices = arguments - usize::from(with_value);
        let mut parameters: Vec<String> = (0..indices).map(|i| format!("i{i}:u32")).collect();
        if with_value {
            parameters.push(format!("value:{ty}"));
        }
        let result = match access {
            Access::Load => format!("->{ty}"),
            Access::Atomic(function) if *function != "atomicStore" => format!("->{ty}"),
            _ => String::new(),
        };
        let body: String = (0..PARTS)
            .map(|k| {
                let number = if k == 0 { String::new() } else { format!("_{k}") };
                let place = format!("{name}{number}[i0-{}u*PART]{path}", k * per_unit);
                let done = match access {
                    Access::Load => format!("return {place};"),
                    Access::Store => format!("{place}=value;return;"),
                    Access::Atomic("atomicStore") => format!("atomicStore(&{place},value);return;"),
                    Access::Atomic("atomicLoad") => format!("return atomicLoad(&{place});"),
                    Access::Atomic(function) => format!("return {function}(&{place},value);"),
                };
                let is_last = k + 1 == PARTS;
                if is_last { done } else { format!("if i0<{}u*PART{{{done}}}\n", (k + 1) * per_unit) }
            })
            .collect();
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

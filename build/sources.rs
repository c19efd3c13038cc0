//! The files of `shaders/`, and what they include.
//!
//! A line `//!include NAME` stands for the file `shaders/NAME.wgsl`, once in each assembled shader
//! however often it is included. Placeholders in a name, such as `{width}`, stand for one of
//! several files with the same functions. The order of declarations means nothing in WGSL, so a
//! shader is its files one after the other.

use std::{cmp::Reverse, collections::BTreeMap, fs, io, path::Path};

/// The entry point, the constant that [`check`](crate::check::check) asks for, and a keyword that a
/// colon follows.
const KEPT: [&str; 3] = ["main", "WORKGROUP", "default"];
/// Scalar types that are like short names.
const SCALARS: [&str; 6] = ["f16", "f32", "i32", "i64", "u32", "u64"];

/// The files of `shaders/`, by name: `common/split`.
pub struct Sources(BTreeMap<String, File>);

/// A file without what only readers need.
pub struct File {
    /// Its path in `shaders/`, without the extension.
    pub name: String,
    /// The lines that have code, each with its number.
    lines: Vec<(usize, String)>,
    /// The names that it includes, each with the number of the line.
    includes: Vec<(usize, String)>,
}

impl Sources {
    /// Reads all files of a folder.
    pub fn read(folder: &Path) -> io::Result<Self> {
        let mut files = BTreeMap::new();
        let mut folders = vec![folder.to_owned()];
        while let Some(path) = folders.pop() {
            for entry in fs::read_dir(path)? {
                let path = entry?.path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "wgsl") {
                    let name = path.with_extension("");
                    let name = name.strip_prefix(folder).expect("it lies in the folder");
                    // With slashes on every system.
                    let name = name.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/");
                    files.insert(name.clone(), File::new(name, &fs::read_to_string(&path)?));
                }
            }
        }
        Ok(Sources(files))
    }

    /// Returns all files, by name.
    pub fn files(&self) -> impl Iterator<Item = &File> {
        self.0.values()
    }

    /// Returns the file of this name.
    pub fn get(&self, name: &str) -> Option<&File> {
        self.0.get(name)
    }

    /// Returns the files that `file` consists of: what it includes, each with these values for
    /// placeholders, and itself.
    ///
    /// # Errors
    ///
    /// Names the line that includes a file that does not exist.
    pub fn assemble<'a>(&'a self, file: &'a File, values: &[(&str, &str)]) -> Result<Vec<&'a File>, String> {
        let mut parts = Vec::new();
        self.append(file, values, &mut parts)?;
        Ok(parts)
    }

    /// Returns the files as one line each, with short names for what they declare: the same in all
    /// files, and the shortest for what is named most often.
    ///
    /// Names of one or two characters stay, which swizzles have, too. Where a declaration shadows
    /// something built in, that is renamed as well, so validate the result.
    pub fn shortened(&self) -> Self {
        let mut uses = BTreeMap::<&str, (usize, bool)>::new();
        for (_, line) in self.files().flat_map(|file| &file.lines) {
            let tokens: Vec<&str> = tokens(line).filter(|token| *token != " ").collect();
            for (i, &token) in tokens.iter().enumerate().filter(|(_, token)| is_name(token)) {
                let is_declared = tokens.get(i + 1) == Some(&":")
                    || i > 0 && ["alias", "const", "fn", "let", "struct", "var"].contains(&tokens[i - 1]);
                let (count, declared) = uses.entry(token).or_default();
                *count += 1;
                *declared |= is_declared && token.len() > 2 && !KEPT.contains(&token);
            }
        }
        let mut names: Vec<&str> = uses.iter().filter(|(_, (_, declared))| *declared).map(|(&name, _)| name).collect();
        names.sort_by_key(|name| Reverse(uses[name].0));
        let is_free =
            |name: &String| !SCALARS.contains(&&**name) && uses.get(&**name).is_none_or(|(_, declared)| *declared);
        let short: BTreeMap<&str, String> = names.into_iter().zip(short_names().filter(is_free)).collect();
        let shortened =
            |line: &str| -> String { tokens(line).map(|token| short.get(token).map_or(token, |name| name)).collect() };
        let files = self.files().map(|file| {
            let lines: Vec<String> = file.lines.iter().map(|(_, line)| shortened(line)).collect();
            let lines = vec![(1, compact(&lines.join(" ")))];
            (file.name.clone(), File { name: file.name.clone(), lines, includes: file.includes.clone() })
        });
        Sources(files.collect())
    }

    fn append<'a>(&'a self, file: &'a File, values: &[(&str, &str)], parts: &mut Vec<&'a File>) -> Result<(), String> {
        for (line, name) in &file.includes {
            let name = values.iter().fold(name.clone(), |name, (from, to)| name.replace(from, to));
            let included = self.get(&name).ok_or_else(|| format!("{}:{line}: there is no file {name}", file.path()))?;
            if !parts.iter().any(|part| part.name == name) {
                self.append(included, values, parts)?;
            }
        }
        parts.push(file);
        Ok(())
    }
}

impl File {
    /// Creates a file of this name with these contents.
    ///
    /// # Panics
    ///
    /// Panics if there is a block comment: only line comments are taken out.
    pub fn new(name: String, wgsl: &str) -> Self {
        assert!(!wgsl.contains("/*"), "{name}: block comments are not taken out");
        let (mut lines, mut includes) = (Vec::new(), Vec::new());
        for (number, line) in (1..).zip(wgsl.lines()) {
            match line.strip_prefix("//!include ") {
                Some(name) => includes.push((number, name.trim().to_owned())),
                None => {
                    let code = compact(line.split("//").next().unwrap_or_default());
                    if !code.is_empty() {
                        lines.push((number, code));
                    }
                }
            }
        }
        File { name, lines, includes }
    }

    /// Returns the path of the file.
    pub fn path(&self) -> String {
        format!("shaders/{}.wgsl", self.name)
    }

    /// Returns the code without comments and most spaces.
    pub fn code(&self) -> String {
        self.lines.iter().map(|(_, code)| format!("{code}\n")).collect()
    }

    /// Returns the numbers in the file of the lines of [`File::code`].
    pub fn line_numbers(&self) -> impl Iterator<Item = usize> {
        self.lines.iter().map(|&(number, _)| number)
    }

    /// Returns whether the file has an entry point, which makes it a kernel.
    pub fn is_kernel(&self) -> bool {
        self.lines.iter().any(|(_, code)| code.starts_with("@compute"))
    }

    /// Returns whether the file declares this constant or structure.
    pub fn declares(&self, kind: &str, name: &str) -> bool {
        let start = format!("{kind} {name}");
        self.lines
            .iter()
            .any(|(_, code)| code.strip_prefix(&start).is_some_and(|rest| rest.starts_with([':', '{', '='])))
    }
}

/// Returns a line without spaces at its ends, beside punctuation that can be part of no longer
/// token, and between words and operators.
fn compact(line: &str) -> String {
    let mut code = String::new();
    for word in line.split_whitespace() {
        let is_free = |c: char| "(){}[],;:".contains(c);
        let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let are_of_one_kind = code.ends_with(is_of_word) == word.starts_with(is_of_word);
        if are_of_one_kind && !(code.is_empty() || code.ends_with(is_free) || word.starts_with(is_free)) {
            code.push(' ');
        }
        code.push_str(word);
    }
    code
}

/// Returns the tokens of a line: words and numbers, and every other character by itself.
fn tokens(line: &str) -> impl Iterator<Item = &str> {
    // Attributes are none of the names.
    let is_part_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '@';
    let mut rest = line;
    std::iter::from_fn(move || {
        let len = rest.find(|c| !is_part_of_word(c)).unwrap_or(rest.len());
        let first = rest.chars().next()?;
        let (token, others) = rest.split_at(len.max(first.len_utf8()));
        rest = others;
        Some(token)
    })
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

/// Returns letters, then letters with one digit, then with two: no keyword is among them.
fn short_names() -> impl Iterator<Item = String> {
    let digits = std::iter::once(String::new()).chain((0..100u32).map(|i| i.to_string()));
    digits.flat_map(|digits| ('a'..='z').chain('A'..='Z').map(move |letter| format!("{letter}{digits}")))
}

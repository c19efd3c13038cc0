//! The files of `shaders/`, and what they include.
//!
//! A line `//!include NAME` stands for the file `shaders/NAME.wgsl`, once in each assembled shader
//! however often it is included. Placeholders in a name, such as `{width}`, stand for one of
//! several files with the same functions. The order of declarations means nothing in WGSL, so a
//! shader is its files one after the other.

use std::{collections::BTreeMap, fs, io, path::Path};

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

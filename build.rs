//! Gathers `shaders/` for `src/gpu/shader.rs`: the files' names and texts, without what only readers need, since the texts
//! are a part of every download of the npm package.

use std::{
    env, fs, io,
    path::{Path, PathBuf},
};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=shaders");
    let mut files = Vec::new();
    find(Path::new("shaders"), &mut files)?;
    files.sort();
    let mut list = String::from("&[\n");
    for path in files {
        // The same on every system: `plane/split`.
        let name: Vec<_> =
            path.with_extension("").iter().skip(1).map(|part| part.to_string_lossy().into_owned()).collect();
        list += &format!("({:?}, {:?}),\n", name.join("/"), code(&fs::read_to_string(&path)?));
    }
    list += "]\n";
    fs::write(PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it")).join("shaders.rs"), list)
}

fn find(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            find(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "wgsl") {
            files.push(path);
        }
    }
    Ok(())
}

/// The lines without comments, indentation and line ends; those that include other files are kept. WGSL has no strings, in
/// which two slashes could be something else, and no file here has block comments.
fn code(wgsl: &str) -> String {
    assert!(!wgsl.contains("/*"), "block comments are not taken out");
    let mut code = String::new();
    for line in wgsl.lines() {
        let line = match line.starts_with("//!include ") {
            true => line,
            false => line.split("//").next().unwrap_or_default(),
        };
        if !line.trim().is_empty() {
            code += line.trim();
            code.push('\n');
        }
    }
    code
}

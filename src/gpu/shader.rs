//! Assembly of WGSL: `shaders/` with its includes resolved.
//!
//! A line `//!include NAME` stands for the file `shaders/NAME.wgsl`, once in each assembled shader however often it is
//! asked for. `{width}` in a name is `narrow` or `wide`: the two forms of the exact arithmetic have the same functions.

use crate::input::lattice::Width;

/// The files of `shaders/`, by name, as `build.rs` gathers them: without comments.
const SOURCES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The kernels: the files that can be assembled into a shader of their own, which are those outside `shared/`.
pub fn kernels() -> impl Iterator<Item = &'static str> {
    SOURCES.iter().map(|&(name, _)| name).filter(|name| !name.starts_with("shared/"))
}

/// The WGSL of the kernel `name`, complete.
///
/// # Panics
///
/// When there is no file of this name, or one that it includes is missing: a mistake in this crate, which the test
/// that assembles all kernels finds.
pub fn assemble(name: &str, width: Width) -> String {
    let mut assembly = Assembly { width, included: Vec::new(), text: String::new() };
    assembly.append(name);
    assembly.text
}

/// The WGSL of a kernel that is not one of this crate's files, such as a test's: `text` with its includes resolved.
///
/// # Panics
///
/// When an included file is missing.
pub fn assemble_text(text: &str, width: Width) -> String {
    let mut assembly = Assembly { width, included: Vec::new(), text: String::new() };
    assembly.append_text(text);
    assembly.text
}

struct Assembly {
    width: Width,
    included: Vec<&'static str>,
    text: String,
}

impl Assembly {
    fn append(&mut self, name: &str) {
        let form = match self.width {
            Width::Narrow => "narrow",
            Width::Wide => "wide",
        };
        let wanted = name.replace("{width}", form);
        let Some(&(name, text)) = SOURCES.iter().find(|(name, _)| *name == wanted) else {
            panic!("no shader source is named {wanted:?}");
        };
        if !self.included.contains(&name) {
            self.included.push(name);
            self.append_text(text);
        }
    }

    fn append_text(&mut self, text: &str) {
        for line in text.lines() {
            match line.strip_prefix("//!include ") {
                Some(name) => self.append(name.trim()),
                None => {
                    self.text.push_str(line);
                    self.text.push('\n');
                }
            }
        }
    }
}

//! The shaders, as the build assembles them from `shaders/`.
//!
//! A file with an entry point is a kernel. A line `//!include NAME` in it stands for the file
//! `shaders/NAME.wgsl`. `{width}` in a name is `narrow` or `wide`: the two forms of the exact
//! arithmetic have the same functions. `{dim}` is `d2` or `d3`: the files there have the functions
//! in which a kernel of both dimensions differs.
//!
//! The build validates each kernel in each form. It derives from the WGSL what the host would
//! otherwise have to repeat: the bindings of the buffers, the constants, and the layouts of the
//! structures, which `assert_layout!` compares with those of the host.

use crate::input::lattice::Width;

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The kernels for one dimension, or for any.
#[derive(Debug)]
pub struct Shaders(&'static [Shader]);

/// The WGSL of a kernel.
#[derive(Debug)]
pub struct Shader {
    name: &'static str,
    narrow: &'static [&'static str],
    wide: &'static [&'static str],
    variables: &'static [Variable],
    /// The WGSL for each width with arrays in parts, if it has such arrays.
    in_parts: Option<[&'static str; 2]>,
}

/// The name of a storage buffer, its binding in group 0, and whether it is only read.
pub type Variable = (&'static str, u32, bool);

/// Returns the WGSL of a kernel for a device with 64-bit integers, which make products in exact arithmetic
/// from two words at once.
pub fn with_int64(wgsl: &str) -> String {
    wgsl.replace(ARITHMETIC_MULTIPLY, ARITHMETIC_MULTIPLY_INT64)
}

impl Shaders {
    /// Returns the kernel of this name, which is that of its file.
    ///
    /// # Panics
    ///
    /// Panics if there is none: a mistake in this crate.
    pub fn get(&self, name: &str) -> &'static Shader {
        self.find(name).unwrap_or_else(|| panic!("no kernel is named {name}"))
    }

    /// Returns the kernel of this name, if these have one.
    pub fn find(&self, name: &str) -> Option<&'static Shader> {
        self.iter().find(|shader| shader.name.rsplit('/').next() == Some(name))
    }

    /// Returns all kernels.
    pub fn iter(&self) -> impl Iterator<Item = &'static Shader> {
        self.0.iter()
    }
}

impl Shader {
    /// Returns the name, with the folder of the dimension or of the file.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the storage buffers.
    pub fn variables(&self) -> &'static [Variable] {
        self.variables
    }

    /// Returns whether this variable is an array that is in parts in [`Shader::wgsl_in_parts`].
    pub(crate) fn has_in_parts(&self, variable: &str) -> bool {
        self.in_parts.is_some() && ARRAYS_IN_PARTS.contains(&variable)
    }

    /// Returns the WGSL with large arrays in so many parts, if it has such arrays.
    pub(crate) fn wgsl_in_parts(&self, width: Width, parts: u32) -> Option<String> {
        let [narrow, wide] = self.in_parts?;
        let of_all = match width {
            Width::Narrow => narrow,
            Width::Wide => wide,
        };
        let is_of_part = |line: &&str| (parts..PARTS).all(|k| !line.starts_with(&format!("/*{k}*/")));
        Some(of_all.split_inclusive('\n').filter(is_of_part).collect())
    }

    /// Assembles the WGSL.
    pub fn wgsl(&self, width: Width) -> String {
        match width {
            Width::Narrow => self.narrow.concat(),
            Width::Wide => self.wide.concat(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every kernel with products has them in the form for 64-bit integers, with arrays in parts, too.
    #[test]
    fn products_are_replaced_in_every_form() {
        let mut replaced = [0, 0];
        for shader in [&D2, &D3, &COMMON].into_iter().flat_map(Shaders::iter) {
            for width in [Width::Narrow, Width::Wide] {
                let texts = [Some(shader.wgsl(width)), shader.wgsl_in_parts(width, PARTS)];
                for (wgsl, replaced) in texts.into_iter().zip(&mut replaced) {
                    let has_products = |wgsl: &String| wgsl.contains("multiply_add");
                    if let Some(wgsl) = wgsl.filter(has_products) {
                        assert!(with_int64(&wgsl).contains("u64("), "{}", shader.name());
                        *replaced += 1;
                    }
                }
            }
        }
        assert!(replaced[0] > 10 && replaced[1] > 2, "{replaced:?}");
    }
}

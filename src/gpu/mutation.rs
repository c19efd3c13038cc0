//! Wrong devices, for tests: one on which a shader is another than it should be.

use std::{fmt, sync::Arc};

/// A shader, and what becomes of its WGSL.
#[derive(Clone)]
pub struct Mutation {
    /// The name of the shader.
    pub kernel: &'static str,
    /// Returns the WGSL in place of that of the shader.
    pub edit: Arc<dyn Fn(String) -> String + Send + Sync>,
}

impl fmt::Debug for Mutation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Mutation").field("kernel", &self.kernel).finish_non_exhaustive()
    }
}

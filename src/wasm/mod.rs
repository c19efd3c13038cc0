//! The surface for JavaScript, and nothing else: typed arrays in, typed arrays out, errors as `Error` objects with a
//! `code`. The TypeScript in `web/` is its only caller.
//!
//! There are three modules, so that a page loads no more than it uses: `engine`, `plane` and `tools`.

#[cfg(feature = "wasm-engine")]
mod engine;
mod objects;
#[cfg(feature = "wasm-plane")]
mod plane;
#[cfg(feature = "wasm-tools")]
mod plane_tools;
mod points;
#[cfg(any(feature = "wasm-engine", feature = "wasm-plane"))]
mod run;
#[cfg(feature = "wasm-tools")]
mod tools;

use wasm_bindgen::prelude::wasm_bindgen;

/// A panic ends the instance: unwinding does not work here. So its message goes to the console and, as an exception, to
/// the caller, who then makes a new instance.
#[wasm_bindgen(start)]
fn start() {
    std::panic::set_hook(Box::new(|panic| {
        // The decoder of LAZ panics on broken data, which is the file's fault and nothing for the console.
        #[cfg(feature = "io")]
        if crate::io::panics_are_caught() {
            let broken = objects::error("BAD_FILE", "the compressed data is broken");
            wasm_bindgen::throw_val(broken.into());
        }
        console_error_panic_hook::hook(panic);
        wasm_bindgen::throw_str(&panic.to_string());
    }));
}

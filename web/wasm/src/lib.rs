//! The WebAssembly bindings of the npm package: typed arrays in, typed arrays out, errors as
//! `Error` objects with a `code`. The TypeScript in `web/src` is their only caller.
//!
//! The features `d3`, `d2`, `edit`, `tools`, `derived`, `surface` and `transport` are the modules of the package.
#![cfg(target_arch = "wasm32")]

#[cfg(any(feature = "d2", feature = "d3", feature = "edit"))]
mod arrays;
#[cfg(feature = "transport")]
mod balls;
#[cfg(any(feature = "derived", feature = "transport"))]
mod clips;
#[cfg(feature = "d2")]
mod d2;
#[cfg(feature = "d3")]
mod d3;
#[cfg(feature = "derived")]
mod derived;
#[cfg(feature = "edit")]
mod edit;
#[cfg(any(feature = "d2", feature = "d3"))]
mod host;
#[cfg(any(feature = "tools", feature = "derived", feature = "surface", feature = "edit", feature = "transport"))]
mod mesh;
mod objects;
mod points;
#[cfg(any(feature = "d2", feature = "d3"))]
mod resident;
#[cfg(any(feature = "d2", feature = "d3", feature = "edit", feature = "transport"))]
mod run;
#[cfg(feature = "surface")]
mod surface;
#[cfg(any(feature = "derived", feature = "surface", feature = "transport"))]
mod task;
#[cfg(feature = "edit")]
mod tiles;
#[cfg(feature = "tools")]
mod tools;
#[cfg(feature = "transport")]
mod transport;
#[cfg(any(feature = "d2", feature = "d3"))]
mod triangulator;

use wasm_bindgen::prelude::wasm_bindgen;

/// Reports panics. A panic ends the instance, since unwinding does not work here: its message goes
/// to the console and, as an exception, to the caller, who then creates a new instance.
#[wasm_bindgen(start)]
fn start() {
    std::panic::set_hook(Box::new(|panic| {
        // The decoder of LAZ panics on broken data: the file is at fault, so the console stays
        // empty.
        #[cfg(feature = "tools")]
        if gdel_io::panics_are_caught() {
            let broken = objects::error("BAD_FILE", "the compressed data is broken");
            wasm_bindgen::throw_val(broken.into());
        }
        console_error_panic_hook::hook(panic);
        wasm_bindgen::throw_str(&panic.to_string());
    }));
}

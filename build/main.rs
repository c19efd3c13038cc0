//! Assembles and validates the shaders, and writes what `src/gpu/shader.rs` includes: their texts,
//! the names and bindings of their buffers, their constants, and the layouts of their structures.

#[cfg(feature = "gpu")]
mod check;
#[cfg(feature = "gpu")]
mod lint;
#[cfg(feature = "gpu")]
mod parts;
#[cfg(feature = "gpu")]
mod sources;
#[cfg(feature = "gpu")]
mod table;

fn main() {
    println!("cargo::rerun-if-changed=build");
    #[cfg(feature = "gpu")]
    {
        println!("cargo::rerun-if-changed=shaders");
        if let Err(error) = table::write() {
            eprintln!("error: {error}");
            std::process::exit(1);
        }
    }
}

//! Keeps graphics drivers from writing on standard error.

use std::{env, os::unix::process::CommandExt, process::Command};

/// Replaces the program by itself with another environment where a driver would complain of this one.
///
/// On Linux, a layer of Mesa asks libwayland for a display as soon as somebody looks for a GPU, and where
/// `XDG_RUNTIME_DIR` is not set, as on most servers, libwayland writes an error about that. It does not need
/// that folder where `WAYLAND_DISPLAY` is a path; nobody listens at this one. Setting a variable of the running
/// process is unsafe in Rust, since other threads may read it.
pub(super) fn restart() {
    let is_path = |name| env::var_os(name).is_some_and(|value| value.as_encoded_bytes().starts_with(b"/"));
    if is_path("XDG_RUNTIME_DIR") || is_path("WAYLAND_DISPLAY") || env::var_os("WAYLAND_SOCKET").is_some() {
        return;
    }
    let mut arguments = env::args_os();
    if let (Ok(program), Some(name)) = (env::current_exe(), arguments.next()) {
        // Returns only if that failed: then the line on standard error is all that is lost.
        let _ = Command::new(program).arg0(name).args(arguments).env("WAYLAND_DISPLAY", "/dev/null").exec();
    }
}

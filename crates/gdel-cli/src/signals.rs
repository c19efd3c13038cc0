//! Ctrl-C and requests to terminate: they leave no temporary files behind.

use gdel_io::files::remove_temporary_files;

/// Removes temporary files before SIGINT or SIGTERM ends the program in their usual way.
#[cfg(unix)]
pub(super) fn watch() {
    use signal_hook::{
        consts::{SIGINT, SIGTERM},
        iterator::Signals,
        low_level::emulate_default_handler,
    };
    // Without a handler or a thread, a signal ends the program as usual, which is no reason to fail
    // now.
    if let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) {
        let _ = std::thread::Builder::new().name("signals".into()).spawn(move || {
            for signal in signals.forever() {
                remove_temporary_files();
                let _ = emulate_default_handler(signal);
            }
        });
    }
}

/// Removes temporary files before Ctrl-C ends the program.
#[cfg(windows)]
pub(super) fn watch() {
    /// STATUS_CONTROL_C_EXIT, as without a handler.
    const INTERRUPTED: i32 = 0xC000_013A_u32 as i32;
    // Without a handler, Ctrl-C ends the program as usual, which is no reason to fail now.
    let _ = ctrlc::set_handler(|| {
        remove_temporary_files();
        std::process::exit(INTERRUPTED);
    });
}

#[cfg(not(any(unix, windows)))]
pub(super) fn watch() {}

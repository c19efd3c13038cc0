//! What later processes are to know of a device, in files of the user's cache directory.
//!
//! It only saves time: where it cannot be read or written, nothing is known.

use crate::{
    gpu::{AdapterSummary, shader::DIGEST},
    platform::{sharing::Threads, threads::count},
};
use etcetera::BaseStrategy;
use std::{
    fs,
    hash::{DefaultHasher, Hash, Hasher},
    path::{Path, PathBuf},
};

/// Returns the name under which is saved what is known of a device, unless it is software.
pub(crate) fn name(adapter: &AdapterSummary, dimension: usize) -> Option<String> {
    let AdapterSummary { name, backend, driver, software, .. } = adapter;
    let (version, threads) = (env!("CARGO_PKG_VERSION"), count(Threads::All));
    (!software)
        .then(|| format!("gdel {version} {DIGEST:x}, {dimension}D, {name}, {backend}, {driver}, {threads} threads"))
}

/// Returns what was saved under a name; nothing if there is none.
pub(crate) fn load(name: &str) -> Vec<u32> {
    folder().map(|folder| load_from(&folder, name)).unwrap_or_default()
}

/// Saves words under a name.
pub(crate) fn save(name: &str, words: &[u32]) {
    if let Some(folder) = folder() {
        // Then it is measured again.
        _ = save_to(&folder, name, words);
    }
}

fn folder() -> Option<PathBuf> {
    Some(etcetera::base_strategy::choose_native_strategy().ok()?.cache_dir().join("gdel"))
}

fn file(folder: &Path, name: &str) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    name.hash(&mut hasher);
    folder.join(format!("device-{:016x}.txt", hasher.finish()))
}

fn load_from(folder: &Path, name: &str) -> Vec<u32> {
    let text = fs::read_to_string(file(folder, name)).unwrap_or_default();
    let words = text.strip_prefix(name).unwrap_or_default().split_ascii_whitespace();
    words.map(str::parse).collect::<Result<_, _>>().unwrap_or_default()
}

fn save_to(folder: &Path, name: &str, words: &[u32]) -> std::io::Result<()> {
    let file = file(folder, name);
    let words: Vec<String> = words.iter().map(u32::to_string).collect();
    // Another process may read or write the file at the same time.
    let partial = file.with_extension(std::process::id().to_string());
    fs::create_dir_all(folder)?;
    fs::write(&partial, format!("{name}\n{}\n", words.join(" ")))?;
    fs::rename(&partial, file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_saved_is_loaded_under_its_name() {
        let folder = std::env::temp_dir().join(format!("gdel-records-{}", std::process::id()));
        assert_eq!(load_from(&folder, "a device"), []);
        save_to(&folder, "a device", &[1, u32::MAX, 3]).expect("the folder can be written to");
        save_to(&folder, "another", &[4]).expect("the folder can be written to");
        assert_eq!(load_from(&folder, "a device"), [1, u32::MAX, 3]);
        fs::write(file(&folder, "a device"), "a device\n1 two 3\n").expect("the file can be written to");
        assert_eq!(load_from(&folder, "a device"), [], "a broken file");
        fs::write(file(&folder, "a device"), "some device\n1 2 3\n").expect("the file can be written to");
        assert_eq!(load_from(&folder, "a device"), [], "that of a name with the same hash");
        assert_eq!(fs::read_dir(&folder).expect("it is there").count(), 2, "nothing else is left");
        fs::remove_dir_all(&folder).expect("it is there");
    }
}

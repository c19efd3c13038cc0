//! Outputs by path: all of their files or none.

use crate::samples::{POINTS, mesh};
use gdel_io::files::{FileError, Output};
use std::fs;

/// The second of three files cannot get its name: the first must not keep its new content.
#[test]
fn tetgen_files_are_replaced_together_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let output = Output::new(&path("m.ele")).unwrap();
    fs::write(path("m.node"), "old").unwrap();
    fs::create_dir(path("m.ele")).unwrap();
    let error = output.write((&POINTS).into(), &mesh()).unwrap_err();
    assert!(matches!(&error, FileError::Write { path: of, .. } if *of == path("m.ele")), "{error}");
    assert_eq!(fs::read_to_string(path("m.node")).unwrap(), "old");
    assert!(!path("m.neigh").exists());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    fs::remove_dir(path("m.ele")).unwrap();
    output.write((&POINTS).into(), &mesh()).unwrap();
    assert!(fs::read_to_string(path("m.node")).unwrap().starts_with("5 3 0 0\n"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
}

#[test]
fn every_file_of_an_output_is_checked() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("m.neigh")).unwrap();
    let error = Output::new(&path("m.ele")).unwrap().check(&[], true).unwrap_err();
    assert!(matches!(&error, FileError::Write { path: of, .. } if *of == path("m.neigh")), "{error}");
}

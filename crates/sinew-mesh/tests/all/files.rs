//! Reading by path.

use std::fs;

use crate::common::{TWICE_22, with};
use sinew_mesh::{MeshFileError, read_msh_file};

#[test]
fn a_file_is_read_and_errors_name_it() {
    let dir = tempfile::tempdir().expect("a directory for the test");
    let path = dir.path().join("liver.msh");
    fs::write(&path, TWICE_22).expect("it can be written");
    assert_eq!(read_msh_file(&path).expect("valid").points.len(), 4);

    let text = with(TWICE_22, "2 4 2 1 6 1 2 3 4", "2 4 2 1 6 1 2 3 45");
    fs::write(&path, &text).expect("it can be written");
    let message = read_msh_file(&path)
        .expect_err("node 45 is missing")
        .to_string();
    assert_eq!(
        message,
        format!(
            "{}:20 (byte {}): $Elements, element 2: node tag 45 is not in $Nodes (tags 1..4); expected an existing \
             node tag",
            path.display(),
            text.find("2 4 2 1 6").expect("it is there")
        )
    );
}

#[test]
fn paths_that_are_no_files_are_refused() {
    let dir = tempfile::tempdir().expect("a directory for the test");
    let missing = dir.path().join("missing.msh");
    let error = read_msh_file(&missing).expect_err("it is missing");
    assert!(matches!(error, MeshFileError::Io { .. }), "{error}");
    assert!(
        error
            .to_string()
            .starts_with(&format!("{}: cannot be read: ", missing.display())),
        "{error}"
    );

    let error = read_msh_file(dir.path())
        .expect_err("it is a directory")
        .to_string();
    assert_eq!(
        error,
        format!("{}: is a directory; expected a file", dir.path().display())
    );

    let empty = dir.path().join("empty.msh");
    fs::write(&empty, "").expect("it can be written");
    let error = read_msh_file(&empty).expect_err("it is empty").to_string();
    assert_eq!(
        error,
        format!(
            "{}:1 (byte 0): the file is empty; expected a gmsh .msh file, starting with $MeshFormat or, in version 1, $NOD",
            empty.display()
        )
    );
}

#[cfg(unix)]
#[test]
fn a_device_or_a_loop_of_links_does_not_hang() {
    let error = read_msh_file("/dev/zero")
        .expect_err("it never ends")
        .to_string();
    assert_eq!(
        error,
        "/dev/zero: is a pipe, device or socket; expected a file"
    );

    let dir = tempfile::tempdir().expect("a directory for the test");
    let link = dir.path().join("loop.msh");
    std::os::unix::fs::symlink(&link, &link).expect("links can be made");
    assert!(matches!(
        read_msh_file(&link),
        Err(MeshFileError::Io { .. })
    ));
}

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::*;

fn write(path: &Path, inputs: &[PathBuf]) -> Result<(), String> {
    let destination = Destination::new(path, inputs).map_err(|error| error.to_string())?;
    let delivery = destination.write(b"new");
    delivery.map(|_| ()).map_err(|error| error.to_string())
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

#[test]
fn new_names_and_writable_files_are_written_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    write(&path, &[]).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"new");
    fs::write(&path, "old").unwrap();
    let mut output = Destination::new(&path, &[]).unwrap().open().unwrap();
    output.write_all(b"newer").unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(output.finish().unwrap(), Delivery::Whole);
    assert_eq!(fs::read(&path).unwrap(), b"newer");
    assert_eq!(names(folder.path()), ["a.csv"]);
}

#[test]
fn inputs_are_refused_by_every_spelling_and_stay() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let input = path("scene.toml");
    fs::write(&input, "scene").unwrap();
    fs::create_dir(path("sub")).unwrap();
    fs::hard_link(&input, path("hard.toml")).unwrap();
    let mut spellings = vec![
        input.clone(),
        path("sub/../scene.toml"),
        path("./scene.toml"),
    ];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("scene.toml", path("link.toml")).unwrap();
        spellings.extend([path("link.toml"), path("hard.toml")]);
    }
    for spelling in spellings {
        let said = write(&spelling, std::slice::from_ref(&input)).unwrap_err();
        assert!(said.contains("this run reads it"), "{said}");
        assert!(said.contains(spelling.to_str().unwrap()), "{said}");
        assert_eq!(fs::read(&input).unwrap(), b"scene");
    }
}

#[test]
fn folders_read_only_files_and_missing_folders_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let read_only = folder.path().join("kept.csv");
    fs::write(&read_only, "old").unwrap();
    let mut permissions = fs::metadata(&read_only).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&read_only, permissions).unwrap();
    for (path, expected) in [
        (read_only.clone(), "it is read-only; make it writable"),
        (
            folder.path().to_owned(),
            "it is a folder; name a file in it",
        ),
        (folder.path().join("no/a.csv"), "there is no folder"),
        (folder.path().join("new/"), "expected the name of a file"),
        (folder.path().join("new/."), "expected the name of a file"),
        (folder.path().join("new/.."), "expected the name of a file"),
        (PathBuf::new(), "expected the name of a file"),
        (PathBuf::from(".."), "it is a folder"),
    ] {
        let said = Destination::new(&path, &[]).unwrap_err().to_string();
        assert!(said.contains(expected), "{said}");
        assert!(said.contains(path.to_str().unwrap()), "{said}");
    }
    assert_eq!(fs::read(&read_only).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["kept.csv"]);
}

#[test]
fn what_became_something_else_during_the_run_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    let output = Destination::new(&path, &[]).unwrap().open().unwrap();
    fs::create_dir(&path).unwrap();
    assert!(output.finish().unwrap_err().is_refusal());
    assert_eq!(names(folder.path()), ["a.csv"]);

    let input = folder.path().join("scene.toml");
    fs::write(&input, "scene").unwrap();
    let path = folder.path().join("b.csv");
    let output = Destination::new(&path, std::slice::from_ref(&input));
    let output = output.unwrap().open().unwrap();
    fs::hard_link(&input, &path).unwrap();
    let said = output.finish().unwrap_err().to_string();
    assert!(said.contains("this run reads it"), "{said}");
    assert_eq!(fs::read(&input).unwrap(), b"scene");
}

#[test]
fn a_folder_is_checked_with_the_files_in_it_and_made_when_it_is_needed() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let new = OutputFolder::new(path("deep/out"), &[]);
    new.check(&["a.svg".into()]).unwrap();
    assert!(names(folder.path()).is_empty(), "a check makes nothing");
    new.write("a.svg", b"new").unwrap();
    assert_eq!(fs::read(path("deep/out/a.svg")).unwrap(), b"new");

    fs::write(path("file"), "old").unwrap();
    for below in ["file", "file/out"] {
        let said = OutputFolder::new(path(below), &[]).check(&[]).unwrap_err();
        assert!(said.to_string().contains("it is not a folder"), "{said}");
    }
    let input = path("deep/out/a.svg");
    let same = OutputFolder::new(path("deep/out"), std::slice::from_ref(&input));
    let said = same.check(&["a.svg".into()]).unwrap_err().to_string();
    assert!(said.contains("this run reads it"), "{said}");
    assert!(same.write("a.svg", b"").is_err());
    assert_eq!(fs::read(input).unwrap(), b"new");
}

#[test]
fn a_folder_that_is_still_to_be_made_is_checked_as_far_as_it_can_be() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let long = "n".repeat(300);
    for (below, name) in [("out", &*long), (&*long, "a.svg"), ("no/n/out", &*long)] {
        let said = OutputFolder::new(path(below), &[]).check(&[name.into()]);
        let said = said.unwrap_err().to_string();
        assert!(said.contains(&long), "{said}");
    }
    // The folder that is made on the way is left again.
    fs::create_dir(path("there")).unwrap();
    let input = path("there/a.svg");
    fs::write(&input, "read").unwrap();
    for below in ["there/new/..", "there/n/../new/../."] {
        let same = OutputFolder::new(path(below), std::slice::from_ref(&input));
        let said = same.check(&["a.svg".into()]).unwrap_err().to_string();
        assert!(said.contains("this run reads it"), "{said}");
        same.check(&["b.svg".into()]).unwrap();
    }
    assert_eq!(names(&path("there")), ["a.svg"], "a check makes nothing");
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{FileTypeExt, symlink};
    use std::os::unix::net::UnixListener;
    use std::process::Command;

    use super::*;

    #[test]
    fn a_link_stays_and_its_target_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("data")).unwrap();
        fs::write(path("data/there.csv"), "old").unwrap();
        symlink("data/there.csv", path("there")).unwrap();
        symlink("data/not-yet.csv", path("dangling")).unwrap();
        symlink("dangling", path("twice")).unwrap();
        for (link, target) in [
            ("there", "data/there.csv"),
            ("dangling", "data/not-yet.csv"),
            ("twice", "data/not-yet.csv"),
        ] {
            write(&path(link), &[]).unwrap();
            assert_eq!(fs::read(path(target)).unwrap(), b"new", "{link}");
            assert!(path(link).is_symlink(), "{link}");
        }
        assert_eq!(names(&path("data")), ["not-yet.csv", "there.csv"]);
        symlink("ring", path("ring")).unwrap();
        assert!(write(&path("ring"), &[]).is_err());
        symlink("/no/such/folder/a", path("nowhere")).unwrap();
        let said = write(&path("nowhere"), &[]).unwrap_err();
        assert!(
            said.contains("there is no folder /no/such/folder"),
            "{said}"
        );
    }

    #[test]
    fn a_link_to_a_folder_that_is_not_there_is_refused_before_the_run() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for (link, target) in [("a", "new/"), ("b", "new/."), ("c", "a")] {
            symlink(target, path(link)).unwrap();
            let said = Destination::new(path(link), &[]).unwrap_err().to_string();
            assert!(said.contains("a link to"), "{said}");
            assert!(said.contains(path(link).to_str().unwrap()), "{said}");
        }
    }

    #[test]
    fn two_outputs_of_a_folder_that_lead_to_one_file_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("data")).unwrap();
        fs::write(path("data/there"), "old").unwrap();
        symlink("data/there", path("results.json")).unwrap();
        symlink("data/../data/there", path("report.html")).unwrap();
        symlink("data/new", path("a.svg")).unwrap();
        symlink(path("data/new"), path("b.svg")).unwrap();
        symlink("c.svg", path("d.svg")).unwrap();
        symlink("/dev/null", path("e.svg")).unwrap();
        symlink("/dev/null", path("f.svg")).unwrap();
        let out = OutputFolder::new(folder.path(), &[]);
        for [one, other] in [
            ["results.json", "report.html"],
            ["a.svg", "b.svg"],
            ["c.svg", "d.svg"],
        ] {
            let said = out.check(&[one.into(), other.into()]).unwrap_err();
            let said = said.to_string();
            for name in [one, other] {
                assert!(said.contains(path(name).to_str().unwrap()), "{said}");
            }
        }
        out.check(&["e.svg".into(), "f.svg".into()]).unwrap();
        out.check(&["results.json".into(), "a.svg".into()]).unwrap();
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn an_open_file_without_a_name_is_written_on_and_its_former_name_left_alone() {
        use std::io::{Read, Seek};
        use std::os::fd::AsRawFd;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gone.csv");
        let mut open = fs::File::options();
        let open = open.read(true).append(true).create_new(true);
        let mut gone = open.open(&path).unwrap();
        fs::remove_file(&path).unwrap();
        let input = folder.path().join("gone.csv (deleted)");
        fs::write(&input, "scene").unwrap();
        let process = std::process::id();
        let descriptor = format!("/proc/{process}/fd/{}", gone.as_raw_fd());
        symlink(&descriptor, folder.path().join("link")).unwrap();
        for path in [Path::new(&descriptor), &folder.path().join("link")] {
            write(path, std::slice::from_ref(&input)).unwrap();
        }
        assert_eq!(fs::read(&input).unwrap(), b"scene");
        let mut written = String::new();
        gone.rewind().unwrap();
        gone.read_to_string(&mut written).unwrap();
        assert_eq!(written, "newnew");
        // It may be what the run reads.
        let said = write(Path::new(&descriptor), &[descriptor.clone().into()]);
        let said = said.unwrap_err();
        assert!(said.contains("this run reads it"), "{said}");
    }

    #[test]
    fn a_named_pipe_that_the_run_reads_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = Command::new("mkfifo").arg(&pipe).status();
        if !made.is_ok_and(|status| status.success()) {
            return;
        }
        let same = Destination::new(&pipe, std::slice::from_ref(&pipe));
        let said = same.unwrap_err().to_string();
        assert!(said.contains("this run reads it"), "{said}");
    }

    #[test]
    fn devices_take_streams_and_stay_devices() {
        let null = Path::new("/dev/null");
        write(null, &[]).unwrap();
        assert!(fs::metadata(null).unwrap().file_type().is_char_device());
        let full = Path::new("/dev/full");
        if full.exists() {
            let error = Destination::new(full, &[]).unwrap().write(b"new");
            let error = error.unwrap_err();
            assert!(!error.is_refusal());
            assert!(error.to_string().contains("writing /dev/full failed"));
            assert!(fs::metadata(full).unwrap().file_type().is_char_device());
        }
    }

    #[test]
    fn a_named_pipe_is_written_to_its_reader_and_a_socket_refused() {
        let folder = tempfile::tempdir().unwrap();
        let socket = folder.path().join("socket");
        let _listener = UnixListener::bind(&socket).unwrap();
        let said = write(&socket, &[]).unwrap_err();
        assert!(said.contains("it is a socket"), "{said}");

        let pipe = folder.path().join("pipe");
        let made = Command::new("mkfifo").arg(&pipe).status();
        if !made.is_ok_and(|status| status.success()) {
            return;
        }
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::read(pipe).unwrap()
        });
        write(&pipe, &[]).unwrap();
        assert_eq!(reader.join().unwrap(), b"new");
        assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
        assert_eq!(names(folder.path()), ["pipe", "socket"]);
    }

    #[test]
    fn a_pipe_whose_reader_left_is_no_failure() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = Command::new("mkfifo").arg(&pipe).status();
        if !made.is_ok_and(|status| status.success()) {
            return;
        }
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || drop(fs::File::open(pipe).unwrap())
        });
        let mut output = Destination::new(&pipe, &[]).unwrap().open().unwrap();
        reader.join().unwrap();
        output.write_all(&[0; 1 << 17]).unwrap();
        assert!(output.reader_left());
        assert_eq!(output.finish().unwrap(), Delivery::ReaderLeft);
    }
}

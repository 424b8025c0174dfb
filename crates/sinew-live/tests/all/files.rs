//! Files of a scene that change while a page is open.

use std::fs;
use std::path::{Path, PathBuf};

use sinew_live::Settings;
use sinew_scene::Scene;

use crate::common::{CUBE, Page, settings, time, u32_at};

/// A mesh of this repository, whose whole surface is a group.
fn mesh(name: &str) -> PathBuf {
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes");
    meshes.join(name)
}

#[test]
fn another_mesh_in_the_place_of_the_first_is_refused_by_name_and_the_session_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let (own, scene) = (folder.path().join("own.msh"), folder.path().join("s.toml"));
    fs::copy(mesh("cube-4.msh"), &own).unwrap();
    let text = CUBE
        .replace("cube = { cells = 3, edge = 0.1 }", "file = \"own.msh\"")
        .replace("\"bottom\"", "\"surface\"");
    fs::write(&scene, text).unwrap();
    let page = Page::of(Settings {
        scene: Scene::load(scene).unwrap(),
        ..settings(CUBE)
    });
    let mut client = page.connect();
    client.picture(|_| true);
    fs::copy(mesh("cube-8.msh"), &own).unwrap();
    for order in [r#""do":"panes","count":2"#, r#""do":"trusted","on":true"#] {
        client.say(&format!(r#"{{"id":1,{order}}}"#));
        let reason = client.event("refused")["reason"].to_string();
        assert!(reason.contains("own.msh has changed"), "{order}: {reason}");
    }
    let t = time(&client.picture(|_| true));
    let later = client.picture(|picture| time(picture) > t + 0.1);
    assert_eq!(u32_at(&later, 16), 1, "one pane");
    fs::copy(mesh("cube-4.msh"), &own).unwrap();
    client.say(r#"{"id":2,"do":"panes","count":2}"#);
    client.picture(|picture| u32_at(picture, 16) == 2);
}

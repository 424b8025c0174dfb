//! Commands that arrive while time is paused.

use crate::common::{CUBE, Page, applied, settings, time};

const CUTTING: &str = "\n[cutting]\n";
const CUT: &str = r#""do":"cut","from":[[0.03333333333333333,-0.05,0.12],[0.03333333333333333,0.15,0.12]],"to":[[0.03333333333333333,-0.05,0.03],[0.03333333333333333,0.15,0.03]]"#;

#[test]
fn cuts_that_wait_for_a_step_have_a_bound() {
    let page = Page::of(settings(&format!("{CUBE}{CUTTING}")));
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"pause","on":true}"#);
    client.picture(|picture| applied(picture) >= 1);
    for id in 2..258 {
        client.say(&format!(r#"{{"id":{id},{CUT}}}"#));
        // One at a time, so that the inbox has room.
        client.event("settings");
    }
    client.say(&format!(r#"{{"id":258,{CUT}}}"#));
    let reason = client.event("refused")["reason"].to_string();
    assert!(reason.contains("let time go on"), "{reason}");
}

#[test]
fn a_cut_that_a_reset_of_another_page_overtakes_is_told_as_done() {
    let page = Page::of(settings(&format!("{CUBE}{CUTTING}")));
    let mut first = page.connect();
    first.say(r#"{"id":1,"do":"pause","on":true}"#);
    first.picture(|picture| applied(picture) >= 1);
    let mut second = page.connect();
    second.event("settings");
    second.say(&format!(r#"{{"id":7,{CUT}}}"#));
    // It waits for a step.
    second.event("settings");
    first.say(r#"{"id":2,"do":"reset"}"#);
    let picture = second.picture(|picture| applied(picture) >= 7);
    assert_eq!(time(&picture), 0.0);
}

//! Loads, and methods that must know them in advance.

use crate::common::{CUBE, Page, applied, settings, time};

const LOADS: &str = r#"
[[load]]
name = "x"
group = "top"
traction = [1.0, 0.0, 0.0]
[[load]]
name = "y"
group = "top"
traction = [0.0, 1.0, 0.0]
[[load]]
name = "z"
group = "top"
traction = [0.0, 0.0, 1.0]
"#;

#[test]
fn a_factor_that_the_method_does_not_take_is_refused_and_stays_as_it_was() {
    let text = format!("{CUBE}{LOADS}");
    let page = Page::of(settings(&text));
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"integrator","pane":0,"name":"modal"}"#);
    client.say(r#"{"id":2,"do":"pause","on":true}"#);
    client.say(r#"{"id":3,"do":"load","load":"x","factor":2.5}"#);
    let reason = client.event("refused")["reason"].to_string();
    assert!(
        reason.contains("loads that are known before the run"),
        "{reason}"
    );
    assert_eq!(client.event("settings")["factors"][0], 1.0);
    client.say(r#"{"id":4,"do":"pause","on":false}"#);
    let t = time(&client.picture(|picture| applied(picture) >= 4));
    client.picture(|picture| time(picture) > t + 0.1);
}

#[test]
fn a_method_takes_the_factors_that_wait_for_the_next_step_as_well() {
    let page = Page::of(settings(&format!("{CUBE}{LOADS}")));
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"pause","on":true}"#);
    client.say(r#"{"id":2,"do":"load","load":"x","factor":2.5}"#);
    client.say(r#"{"id":3,"do":"integrator","pane":0,"name":"modal"}"#);
    let reason = client.event("refused")["reason"].to_string();
    assert!(
        reason.contains("loads that are known before the run"),
        "{reason}"
    );
}

//! Names in messages.

pub(super) fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}

pub(super) fn quoted(names: &[impl AsRef<str>]) -> String {
    let names: Vec<String> = names
        .iter()
        .map(|name| format!("`{}`", name.as_ref()))
        .collect();
    names.join(", ")
}

pub(super) fn quoted_or_none(names: &[String]) -> String {
    if names.is_empty() {
        "none".into()
    } else {
        quoted(names)
    }
}

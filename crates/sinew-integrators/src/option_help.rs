//! Options in words.

/// An option in words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OptionHelp {
    /// Its key.
    pub key: &'static str,
    /// Effect of the option, values that fit and the default.
    pub help: &'static str,
    /// A default that results name with the integrator, because it changes what the run means.
    pub shown_default: Option<f64>,
}

/// Form of an option in the label of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OptionLabel {
    /// `key=value`.
    #[default]
    KeyAndValue,
    /// The value alone, before all other options: the kind of a method.
    Value,
    /// `symbol=value`, where the field has a symbol for it.
    Symbol(&'static str),
    /// The values of these keys of a table, in this order, as far as the table has them; the first
    /// must be there.
    Phrase(&'static [&'static str]),
}

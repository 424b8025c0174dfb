//! Values of Python as those of scenes and options.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use pythonize::{depythonize, pythonize};
use sinew_core::{OptionValue, Options};

use crate::errors::value_error;

/// A value without arrays and paths, as `sinew_sim._values.plain` gives it, converted to TOML.
pub(crate) fn to_toml(value: &Bound<'_, PyAny>) -> PyResult<toml::Value> {
    Ok(depythonize(value)?)
}

/// Values by keys, such as `{"region.1.youngs_modulus": 8000.0}`, as the command takes them: `KEY=VALUE`.
pub(crate) fn assignments(values: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<String>> {
    let Some(values) = values else {
        return Ok(Vec::new());
    };
    let plain = plain(values.as_any())?;
    let plain = plain.cast::<PyDict>()?;
    let assignment = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let key: String = key.extract()?;
        if key.contains('=') {
            return Err(value_error(format!(
                "set: {key:?}: expected the key of a value, such as \"run.duration\""
            )));
        }
        Ok(format!("{key}={}", to_toml(&value)?))
    };
    plain.iter().map(assignment).collect()
}

/// The value without arrays, paths and numbers of numpy.
pub(crate) fn plain<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let values = value.py().import("sinew_sim._values")?;
    values.call_method1("plain", (value,))
}

/// Options of a method.
pub(crate) fn options(values: Option<&Bound<'_, PyDict>>) -> PyResult<Options> {
    let mut options = Options::new();
    let Some(values) = values else {
        return Ok(options);
    };
    let plain = plain(values.as_any())?;
    for (key, value) in plain.cast::<PyDict>()? {
        let key: String = key.extract()?;
        let value = option_value(&key, &to_toml(&value)?)?;
        options.insert(key, value);
    }
    Ok(options)
}

fn option_value(key: &str, value: &toml::Value) -> PyResult<OptionValue> {
    match value {
        toml::Value::Integer(number) => Ok(OptionValue::Number(*number as f64)),
        toml::Value::Float(number) => Ok(OptionValue::Number(*number)),
        toml::Value::String(text) => Ok(OptionValue::Text(text.clone())),
        toml::Value::Table(entries) => {
            let entries = entries.iter();
            let entries = entries.map(|(key, value)| Ok((key.clone(), option_value(key, value)?)));
            Ok(OptionValue::Table(entries.collect::<PyResult<_>>()?))
        }
        other => Err(value_error(format!(
            "{key}: {other}: expected a number, a text or a dictionary of these"
        ))),
    }
}

/// A value of JSON as a Python object.
pub(crate) fn from_json<'py>(
    py: Python<'py>,
    value: &serde_json::Value,
) -> PyResult<Bound<'py, PyAny>> {
    Ok(pythonize(py, value)?)
}

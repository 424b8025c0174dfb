//! Vectors of the library as arrays of numpy, and back.

use numpy::{
    AllowTypeChange, Element, PyArray1, PyArray2, PyArrayLike2, PyArrayMethods, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;

use crate::errors::value_error;

/// Rows of N numbers as an array of shape (rows, N), without a copy.
pub(crate) fn rows<'py, T: Element, const N: usize>(
    py: Python<'py>,
    values: Vec<[T; N]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let count = values.len();
    PyArray1::from_vec(py, values.into_flattened()).reshape([count, N])
}

/// A read-only array: writing into it would change nothing in the session.
pub(crate) fn read_only<'py, T: Element>(
    array: Bound<'py, PyArray2<T>>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}

/// Writes rows of N numbers into an array of the caller.
pub(crate) fn fill<const N: usize>(
    out: &Bound<'_, PyAny>,
    count: usize,
    write: impl FnOnce(&mut [[f64; N]]) -> PyResult<()>,
) -> PyResult<()> {
    let wrong = || wrong_out(out, &[count, N]);
    let array = out.cast::<PyArray2<f64>>().map_err(|_| wrong())?;
    if array.shape() != [count, N] || !array.is_c_contiguous() {
        return Err(wrong());
    }
    let mut array = array.try_readwrite().map_err(|_| wrong())?;
    let values = array.as_slice_mut().map_err(|_| wrong())?;
    write(values.as_chunks_mut().0)
}

/// Numbers, in a new array or in that of the caller.
pub(crate) fn filled_flat<'py>(
    py: Python<'py>,
    out: Option<&Bound<'py, PyAny>>,
    values: Vec<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let Some(out) = out else {
        return Ok(PyArray1::from_vec(py, values).into_any());
    };
    let wrong = || wrong_out(out, &[values.len()]);
    let array = out.cast::<PyArray1<f64>>().map_err(|_| wrong())?;
    if array.len() != values.len() {
        return Err(wrong());
    }
    let mut array = array.try_readwrite().map_err(|_| wrong())?;
    let slice = array.as_slice_mut().map_err(|_| wrong())?;
    slice.copy_from_slice(&values);
    Ok(out.clone())
}

fn wrong_out(out: &Bound<'_, PyAny>, shape: &[usize]) -> PyErr {
    value_error(format!(
        "out: expected a writeable C-contiguous array of float64 of shape {}, got {}",
        in_words(shape),
        described(out)
    ))
}

/// The shape of an array as Python writes it.
pub(crate) fn in_words(shape: &[usize]) -> String {
    let sizes: Vec<String> = shape.iter().map(ToString::to_string).collect();
    match shape.len() {
        1 => format!("({},)", sizes[0]),
        _ => format!("({})", sizes.join(", ")),
    }
}

/// The kind of a value, for messages: of an array its type and shape.
pub(crate) fn described(value: &Bound<'_, PyAny>) -> String {
    if let Ok(array) = value.cast::<PyUntypedArray>() {
        let dtype = array.dtype().to_string();
        let layout = match array.is_c_contiguous() {
            true => "",
            false => ", not C-contiguous",
        };
        return format!("{dtype} of shape {}{layout}", in_words(array.shape()));
    }
    let name = value.get_type().name();
    let name = name.map_or_else(|_| "an object".to_owned(), |name| name.to_string());
    match value.len() {
        Ok(len) => format!("{name} of length {len}"),
        Err(_) => name,
    }
}

/// Three finite numbers of an argument.
pub(crate) fn vector(value: &Bound<'_, PyAny>, name: &str, unit: &str) -> PyResult<[f64; 3]> {
    value.extract::<[f64; 3]>().map_err(|_| {
        value_error(format!(
            "{name}: expected 3 numbers ({unit}), got {}",
            described(value)
        ))
    })
}

/// A value as an array, and the letter of numpy for the kind of its numbers.
fn as_array<'py>(value: &Bound<'py, PyAny>) -> PyResult<(Bound<'py, PyAny>, String)> {
    let array = value
        .py()
        .import("numpy")?
        .call_method1("asarray", (value,))?;
    let kind = array.getattr("dtype")?.getattr("kind")?.extract()?;
    Ok((array, kind))
}

/// Rows of N numbers of an argument.
pub(crate) fn rows_of<const N: usize>(
    value: &Bound<'_, PyAny>,
    name: &str,
    unit: &str,
) -> PyResult<Vec<[f64; N]>> {
    let wrong = || {
        value_error(format!(
            "{name}: expected an array of numbers ({unit}) of shape (n, {N}), got {}",
            described(value)
        ))
    };
    let (array, kind) = as_array(value).map_err(|_| wrong())?;
    if !["b", "f", "i", "u"].contains(&kind.as_str()) {
        return Err(wrong());
    }
    let array: PyArrayLike2<'_, f64, AllowTypeChange> = array.extract().map_err(|_| wrong())?;
    let view = array.as_array();
    if view.ncols() != N {
        return Err(wrong());
    }
    let row = |row: usize| std::array::from_fn(|column| view[[row, column]]);
    Ok((0..view.nrows()).map(row).collect())
}

/// Indices of an argument, rows of N of them, each below a count.
pub(crate) fn index_rows<const N: usize>(
    value: &Bound<'_, PyAny>,
    name: &str,
    of: (&str, usize),
) -> PyResult<Vec<[u32; N]>> {
    let wrong = || {
        value_error(format!(
            "{name}: expected an array of whole numbers of shape (n, {N}), got {}",
            described(value)
        ))
    };
    let (array, kind) = as_array(value).map_err(|_| wrong())?;
    let is_empty = array.getattr("size")?.extract::<usize>()? == 0;
    if kind != "i" && kind != "u" && !is_empty {
        return Err(wrong());
    }
    let array = array.call_method1("astype", ("int64",))?;
    let array = array.cast::<PyArray2<i64>>().map_err(|_| wrong())?;
    let array = array.readonly();
    let view = array.as_array();
    if view.ncols() != N {
        return Err(wrong());
    }
    let (what, count) = of;
    let index = |value: i64| {
        let index = u32::try_from(value)
            .ok()
            .filter(|index| (*index as usize) < count);
        index.ok_or_else(|| {
            value_error(format!(
                "{name}: {value} is no {what}: expected numbers from 0 to {}",
                count.saturating_sub(1)
            ))
        })
    };
    let mut all = Vec::with_capacity(view.nrows());
    for row in view.rows() {
        let mut own = [0; N];
        for (own, value) in own.iter_mut().zip(row) {
            *own = index(*value)?;
        }
        all.push(own);
    }
    Ok(all)
}

/// Indices of an argument, each below a count.
pub(crate) fn indices(
    value: &Bound<'_, PyAny>,
    name: &str,
    of: (&str, usize),
) -> PyResult<Vec<u32>> {
    let numpy = value.py().import("numpy")?;
    let wrong = || {
        value_error(format!(
            "{name}: expected whole numbers, got {}",
            described(value)
        ))
    };
    let array = numpy
        .call_method1("atleast_1d", (value,))
        .map_err(|_| wrong())?;
    let column = array
        .call_method1("reshape", ((-1, 1),))
        .map_err(|_| wrong())?;
    let rows = index_rows::<1>(&column, name, of)?;
    Ok(rows.into_iter().map(|[index]| index).collect())
}

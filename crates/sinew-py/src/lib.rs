//! The extension module of the Python package `sinew_sim`: scenes, sessions and results as Python objects and arrays.
//!
//! It contains no physics and takes no steps of its own: a session is a [`sinew_world::World`], a run a
//! [`sinew_record::RunFolder`]. Parts that are better written in Python (meshes of other packages, results as arrays,
//! sweeps, Gymnasium) are in `python/sinew_sim`.

mod arrays;
mod command;
mod errors;
mod frame;
mod guard;
mod load;
mod matrices;
mod mesh;
mod plan;
mod run;
mod scene;
mod session;
mod shared;
mod tool;
mod values;
mod watch;

use pyo3::prelude::*;

/// The part of sinew_sim that is compiled; import sinew_sim instead.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("SceneError", py.get_type::<errors::SceneError>())?;
    module.add("Diverged", py.get_type::<errors::Diverged>())?;
    module.add("Refused", py.get_type::<errors::Refused>())?;
    module.add("InternalError", py.get_type::<errors::InternalError>())?;
    module.add_class::<mesh::Mesh>()?;
    module.add_class::<mesh::Group>()?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<scene::Warning>()?;
    module.add_class::<matrices::Matrices>()?;
    module.add_class::<session::Session>()?;
    module.add_class::<session::Advanced>()?;
    module.add_class::<tool::Tool>()?;
    module.add_class::<load::Load>()?;
    module.add_function(wrap_pyfunction!(command::command, module)?)?;
    module.add_function(wrap_pyfunction!(frame::read_frame, module)?)?;
    module.add_function(wrap_pyfunction!(guard::forked, module)?)?;
    Ok(())
}

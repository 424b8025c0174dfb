//! The `sinew` command.

mod basics;
mod converge;
#[cfg(feature = "implicit")]
mod factor_memory;
mod film;
mod law;
#[cfg(feature = "implicit")]
mod limits;
#[cfg(all(unix, feature = "live"))]
mod live;
mod mesh;
mod mesh_refusals;
mod new;
#[cfg(unix)]
mod outputs;
mod plan_advice;
mod replay;
mod results;
#[cfg(unix)]
mod run_folders;
#[cfg(feature = "implicit")]
mod scene_reference;
mod silence;
mod warnings;

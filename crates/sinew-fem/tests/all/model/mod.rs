//! Models: supports, loads, regions, queries.

mod loads;
mod missing_inputs;
mod model_errors;
mod nodes_and_dofs;
mod prescribed_motion;
mod properties_from_data;
mod queries;
mod reactions;
mod regions;
mod supports;
mod sweeps;
mod without_groups;

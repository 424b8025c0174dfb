//! The size of a run's folder, predicted before the run.

use sinew_scene::{ProbeRows, Simulation};

use crate::recorder::Schedules;
use crate::tool_rows::ToolRows;

/// Number of bytes of a frame's text.
const TEXT: usize = 2000;

/// Average number of bytes of a number in a table.
const NUMBER: usize = 21;

/// Predicted sizes of the files that a run writes into its folder, without the page, the summary and the checkpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FolderSize {
    /// Frames of fields; none for an oscillator.
    pub frames: usize,
    /// Bytes of a frame before compression, without its text.
    pub frame_bytes: usize,
    /// True if frames are compressed, to a size that depends on the motion.
    pub is_compressed: bool,
    /// Approximate bytes of the tables: the length of numbers varies.
    pub table_bytes: usize,
}

impl FolderSize {
    /// The size of the folder of a simulation's run.
    #[must_use]
    pub fn of(simulation: &Simulation) -> Self {
        let schedules = Schedules::of(simulation);
        let probes = schedules.probes.count() * ProbeRows::new(simulation.body()).columns().len();
        let tools = ToolRows::of(simulation.body());
        let tools = tools.map_or(0, |tools| schedules.probes.count() * tools.columns().len());
        // Time, six energies and perhaps that of the method; then six numbers for each support.
        let supports = simulation
            .body()
            .held_parts()
            .map_or(0, |parts| parts.len());
        let energies = schedules.energy.count() * (8 + 1 + 6 * supports);
        Self {
            frames: schedules.fields.map_or(0, |fields| fields.count()),
            frame_bytes: frame_bytes(simulation),
            is_compressed: simulation.scene().output().compress,
            table_bytes: (probes + tools + energies) * NUMBER,
        }
    }

    /// Bytes of all frames before compression.
    #[must_use]
    pub fn field_bytes(&self) -> usize {
        self.frames * (self.frame_bytes + TEXT)
    }
}

/// Bytes of the numbers of a frame.
fn frame_bytes(simulation: &Simulation) -> usize {
    let Some(body) = simulation.model().body() else {
        return 0;
    };
    let (output, mesh) = (simulation.scene().output(), &body.mesh);
    let (double, single, index) = (size_of::<f64>(), size_of::<f32>(), size_of::<u32>());
    let vectors = 2 + usize::from(output.acceleration);
    let contact = if body.tools.is_some() { 4 * single } else { 0 };
    let point = 3 * double + vectors * 3 * single + contact;
    // The end of its list of nodes, and its type.
    let of_cell = size_of::<i64>() + 1;
    if output.surface_only {
        let surface = mesh.boundary_surface();
        let triangle = 3 * index + of_cell;
        return surface.points.len() * point + surface.triangles.len() * triangle;
    }
    let regions = &body.model.report().regions;
    let has_stress = regions.iter().all(|region| region.network.is_none());
    let flags = 2;
    let numbers = 6 + if has_stress { 7 } else { 0 } + usize::from(output.step_limit);
    let tet = 4 * index + of_cell + flags + numbers * single;
    mesh.points.len() * point + mesh.tets.len() * tet
}

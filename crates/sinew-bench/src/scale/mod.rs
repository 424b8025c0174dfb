//! Methods over the size of a body: error, time, set-up and memory, and the largest body in real time.

use sinew_verify::LabError;
mod cube;
mod fit;
mod methods;
mod newmark;
mod plot;
mod row;
mod run;
mod table;

use serde::Serialize;

pub use fit::{Exponents, ScaleFit};
pub use row::{ScaleBody, ScaleRow, ScaleSkipped};

use cube::Cube;
use methods::{Threads, variants};
use sinew_verify::Machine;
use sinew_verify::Progress;

/// Version of the format of the results.
const SCHEMA: u32 = 1;

/// A bench of one scene at several sizes: the peers' cube with mass damping.
#[derive(Clone, Debug)]
pub struct ScaleBench {
    /// The two smallest cubes only.
    pub quick: bool,
}

/// Measurements of a bench over sizes.
#[derive(Clone, Debug, Serialize)]
pub struct ScaleResults {
    /// Version of this format.
    pub schema: u32,
    /// Revision of the code.
    pub revision: String,
    /// The computer.
    pub machine: Machine,
    /// The cubes, with their references.
    pub bodies: Vec<ScaleBody>,
    /// One row for each cube, method, precision and number of threads.
    pub rows: Vec<ScaleRow>,
    /// Powers of the number of tetrahedra, and the largest body in real time, of each method.
    pub fits: Vec<ScaleFit>,
    /// Runs that were skipped, with the reason.
    pub skipped: Vec<ScaleSkipped>,
}

impl ScaleBench {
    /// Cells a side.
    fn sizes(&self) -> &'static [usize] {
        match self.quick {
            true => &[10, 20],
            false => &[10, 20, 40, 60],
        }
    }

    /// Measures everything.
    ///
    /// # Errors
    /// [`LabError`] when a cube cannot be built or a method cannot run.
    pub fn run(
        &self,
        revision: String,
        machine: Machine,
        mut progress: impl FnMut(Progress),
    ) -> Result<ScaleResults, LabError> {
        let mut results = ScaleResults {
            schema: SCHEMA,
            revision,
            machine,
            bodies: Vec::new(),
            rows: Vec::new(),
            fits: Vec::new(),
            skipped: Vec::new(),
        };
        let variants = variants();
        let of = self.sizes().len() * variants.len();
        let mut done = 0;
        for cells in self.sizes() {
            let mut show = |done, what| progress(Progress::Run { done, of, what });
            show(done, format!("reference of {}", cube::name(*cells)));
            let mut cube = Cube::new(*cells)?;
            results.bodies.push(cube.body.clone());
            for variant in &variants {
                let what = format!("{} on {}", variant.label(), cube.body.mesh);
                show(done, what);
                done += 1;
                let refused = match variant.threads {
                    Threads::Several if !methods::has_several_threads() => {
                        Some("this computer has one processor".to_owned())
                    }
                    _ if variant.factorises => {
                        newmark::refused(&results.rows, cube.body.tets as f64)
                    }
                    _ => None,
                };
                match refused {
                    None => results.rows.push(run::row(&mut cube, variant)?),
                    Some(reason) => results.skipped.push(ScaleSkipped {
                        mesh: cube.body.mesh.clone(),
                        tets: cube.body.tets,
                        method: variant.label(),
                        reason,
                    }),
                }
            }
        }
        results.fits = fit::fits(&results.rows);
        Ok(results)
    }
}

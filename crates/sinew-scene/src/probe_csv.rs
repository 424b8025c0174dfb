//! The motion of probes as a CSV file.

use std::io::{self, Write};

use sinew_core::{Moment, RecordError, Recorder, Verdict};

use crate::output::{Delivery, Output, OutputError};
use crate::probe_rows;
use crate::simulation::Probe;

/// Writes the displacement of probes after every step: columns `t_s`, then `<probe>_u_x_m`,
/// `<probe>_u_y_m`, `<probe>_u_z_m` of each probe (`<probe>_u_m` for an oscillator). Numbers
/// are written so that reading them gives the same bits.
///
/// A file has a temporary name until [`ProbeCsv::finish`], so that a file under its final name is
/// always complete; dropped before that, it leaves nothing behind. Where the output is a pipe and its
/// reader closes it, the run is stopped.
#[derive(Debug)]
pub struct ProbeCsv {
    probes: Vec<Probe>,
    output: Output,
    row: String,
}

impl ProbeCsv {
    /// Starts the output with the row of column names.
    ///
    /// # Errors
    /// [`OutputError::Failed`].
    pub fn new(mut output: Output, probes: &[Probe]) -> Result<Self, OutputError> {
        match writeln!(output, "{}", probe_rows::columns(probes).join(",")) {
            Ok(()) => Ok(Self {
                probes: probes.to_vec(),
                output,
                row: String::new(),
            }),
            Err(source) => Err(output.failed(source)),
        }
    }

    /// Completes the output; see [`Output::finish`].
    ///
    /// # Errors
    /// [`OutputError`] when the output cannot be written or its name may no longer be used.
    pub fn finish(self) -> Result<Delivery, OutputError> {
        self.output.finish()
    }

    /// Writes a row; `moving` holds the displacements of the degrees of freedom, which are not held or moved.
    fn write(&mut self, t: f64, moving: &[f64]) -> io::Result<()> {
        probe_rows::write(&mut self.row, &self.probes, t, moving);
        self.output.write_all(self.row.as_bytes())
    }
}

impl Recorder for ProbeCsv {
    fn next(&mut self, _step: usize) -> Option<usize> {
        None
    }

    fn record(&mut self, _moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        Ok(Verdict::Continue)
    }

    fn watches(&self) -> Vec<u32> {
        probe_rows::watched(&self.probes)
    }

    fn watched(&mut self, t: f64, moving: &[f64]) -> Result<Verdict, RecordError> {
        match self.write(t, moving) {
            Ok(()) if self.output.reader_left() => Ok(Verdict::Stop),
            Ok(()) => Ok(Verdict::Continue),
            Err(error) => Err(RecordError {
                t,
                source: self.output.failed(error).into(),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use sinew_core::Ramp;
    use sinew_fem::Course;

    use super::*;
    use crate::output::Destination;

    fn csv(path: &std::path::Path) -> ProbeCsv {
        let output = Destination::new(path, &[]).unwrap().open().unwrap();
        ProbeCsv::new(output, &probes()).unwrap()
    }

    fn probes() -> Vec<Probe> {
        let probe = |name: &str, dofs: &[Option<usize>]| Probe {
            name: name.into(),
            node: None,
            dofs: dofs.to_vec(),
            courses: Vec::new(),
        };
        let along_y = Course {
            displacement: [9.0, 0.25, 9.0],
            ramp: Ramp::Linear,
        };
        vec![
            probe("tip", &[Some(3), None, Some(5)]),
            probe("mass", &[Some(0)]),
            Probe {
                courses: vec![Vec::new(), vec![along_y], Vec::new()],
                ..probe("moved", &[None, None, Some(8)])
            },
        ]
    }

    /// Of the degrees of freedom 3, 5, 0 and 8.
    const MOVING: [f64; 4] = [1e-7, 0.3, 0.1, 0.7];

    #[test]
    fn rows_hold_the_probes_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        let mut csv = csv(&path);
        csv.write(2.0, &MOVING).unwrap();
        assert!(!path.exists(), "unfinished files have another name");
        assert_eq!(csv.finish().unwrap(), Delivery::Whole);
        assert_eq!(
            fs::read_to_string(&path).unwrap(),
            "t_s,tip_u_x_m,tip_u_y_m,tip_u_z_m,mass_u_m,moved_u_x_m,moved_u_y_m,moved_u_z_m\n\
             2.0,1e-7,0.0,0.3,0.1,0.0,0.5,0.7\n"
        );
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn an_abandoned_file_leaves_the_old_one_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        fs::write(&path, "old").unwrap();
        let mut csv = csv(&path);
        csv.write(0.0, &MOVING).unwrap();
        drop(csv);
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}

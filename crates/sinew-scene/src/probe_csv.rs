//! The motion of probes as a CSV file.

use std::io::{self, Write};

use sinew_core::{RecordError, Recorder, State, System, Verdict};

use crate::output::{Delivery, Output, OutputError};
use crate::simulation::Probe;

/// Writes the displacement of probes after every step: columns `t_s`, then `<probe>_u_x_m`,
/// `<probe>_u_y_m`, `<probe>_u_z_m` of each probe (`<probe>_u_m` for an oscillator). Numbers
/// are written so that reading them gives the same bits.
///
/// A file has another name until [`ProbeCsv::finish`], so that a file with its own name is
/// always whole; dropped before that, it leaves nothing behind. Where the output is a pipe whose
/// reader goes away, the run is stopped.
#[derive(Debug)]
pub struct ProbeCsv {
    probes: Vec<Probe>,
    output: Output,
}

impl ProbeCsv {
    /// Writes the head of the columns.
    ///
    /// # Errors
    /// [`OutputError::Failed`].
    pub fn new(mut output: Output, probes: &[Probe]) -> Result<Self, OutputError> {
        match writeln!(output, "{}", columns(probes).join(",")) {
            Ok(()) => Ok(Self {
                probes: probes.to_vec(),
                output,
            }),
            Err(source) => Err(output.failed(source)),
        }
    }

    /// Completes the output; see [`Output::finish`].
    ///
    /// # Errors
    /// [`OutputError`] when it cannot be written or may no longer have its name.
    pub fn finish(self) -> Result<Delivery, OutputError> {
        self.output.finish()
    }

    fn write(&mut self, state: &State) -> io::Result<()> {
        write!(self.output, "{:?}", state.t())?;
        for probe in &self.probes {
            for value in probe.displacement(&state.u) {
                write!(self.output, ",{value:?}")?;
            }
        }
        writeln!(self.output)
    }
}

impl Recorder for ProbeCsv {
    fn wants(&mut self, _step: usize, _t: f64) -> bool {
        true
    }

    fn record(&mut self, _system: &dyn System, state: &State) -> Result<Verdict, RecordError> {
        match self.write(state) {
            Ok(()) if self.output.reader_left() => Ok(Verdict::Stop),
            Ok(()) => Ok(Verdict::Continue),
            Err(error) => Err(RecordError {
                t: state.t(),
                source: self.output.failed(error).into(),
            }),
        }
    }
}

fn columns(probes: &[Probe]) -> Vec<String> {
    let mut columns = vec!["t_s".to_owned()];
    for Probe { name, dofs, .. } in probes {
        match dofs.len() {
            1 => columns.push(format!("{name}_u_m")),
            _ => columns.extend(["x", "y", "z"].map(|axis| format!("{name}_u_{axis}_m"))),
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    use std::fs;

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
        };
        vec![
            probe("tip", &[Some(3), None, Some(5)]),
            probe("mass", &[Some(0)]),
        ]
    }

    fn state() -> State {
        State::new(vec![0.1, 0.0, 0.0, 1e-7, -2.0, 0.3], vec![0.0; 6])
    }

    #[test]
    fn rows_hold_the_probes_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        let mut csv = csv(&path);
        csv.write(&state()).unwrap();
        assert!(!path.exists(), "unfinished files have another name");
        assert_eq!(csv.finish().unwrap(), Delivery::Whole);
        assert_eq!(
            fs::read_to_string(&path).unwrap(),
            "t_s,tip_u_x_m,tip_u_y_m,tip_u_z_m,mass_u_m\n0.0,1e-7,0.0,0.3,0.1\n"
        );
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn an_abandoned_file_leaves_the_old_one_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        fs::write(&path, "old").unwrap();
        let mut csv = csv(&path);
        csv.write(&state()).unwrap();
        drop(csv);
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}

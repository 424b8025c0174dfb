//! The motion of probes as a CSV file.

use std::io::{self, Write};
use std::path::PathBuf;

use sinew_core::{RecordError, Recorder, State, System, Verdict};

use crate::WholeFile;
use crate::simulation::Probe;

/// Writes the displacement of probes after every step: columns `t_s`, then `<probe>_u_x_m`,
/// `<probe>_u_y_m`, `<probe>_u_z_m` of each probe (`<probe>_u_m` for an oscillator). Numbers
/// are written so that reading them gives the same bits.
///
/// The file has another name until [`ProbeCsv::finish`], so that a file with its own name is
/// always whole; dropped before that, it leaves nothing behind.
#[derive(Debug)]
pub struct ProbeCsv {
    probes: Vec<Probe>,
    file: WholeFile,
}

impl ProbeCsv {
    /// Starts a file that will be called `path`.
    ///
    /// # Errors
    /// When no file can be written there.
    pub fn create(path: impl Into<PathBuf>, probes: &[Probe]) -> io::Result<Self> {
        let mut file = WholeFile::create(path)?;
        writeln!(file, "{}", columns(probes).join(","))?;
        Ok(Self {
            probes: probes.to_vec(),
            file,
        })
    }

    /// Completes the file and gives it its name, replacing one of that name.
    ///
    /// # Errors
    /// When it cannot be written or renamed.
    pub fn finish(self) -> io::Result<PathBuf> {
        self.file.finish()
    }

    fn write(&mut self, state: &State) -> io::Result<()> {
        write!(self.file, "{:?}", state.t())?;
        for probe in &self.probes {
            for value in probe.displacement(&state.u) {
                write!(self.file, ",{value:?}")?;
            }
        }
        writeln!(self.file)
    }
}

impl Recorder for ProbeCsv {
    fn wants(&mut self, _step: usize, _t: f64) -> bool {
        true
    }

    fn record(&mut self, _system: &dyn System, state: &State) -> Result<Verdict, RecordError> {
        match self.write(state) {
            Ok(()) => Ok(Verdict::Continue),
            Err(error) => Err(RecordError {
                t: state.t(),
                source: error.into(),
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
        let mut csv = ProbeCsv::create(&path, &probes()).unwrap();
        csv.write(&state()).unwrap();
        assert!(!path.exists(), "unfinished files have another name");
        assert_eq!(csv.finish().unwrap(), path);
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
        let mut csv = ProbeCsv::create(&path, &probes()).unwrap();
        csv.write(&state()).unwrap();
        drop(csv);
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_path_without_a_file_name_is_refused() {
        assert!(ProbeCsv::create("..", &probes()).is_err());
        assert!(ProbeCsv::create("/no/such/folder/run.csv", &probes()).is_err());
    }
}

//! The motion of probes as a CSV file.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;

use sinew_core::{Moment, RecordError, Recorder, Verdict};

use crate::output::{Delivery, Output, OutputError};
use crate::probe_rows::{BEGIN, ProbeRows, is_column};
use crate::schedule::Schedule;
use crate::simulation::SceneBody;

/// Writes the values of probes after the steps of a [`Schedule`], in the columns of [`ProbeRows`]. Numbers are written
/// so that they are read back with the same bits.
///
/// A file has a temporary name until [`ProbeCsv::finish`], so that a file under its final name is always complete;
/// dropped before that, it leaves nothing behind. If the output is a pipe and its reader closes it, the run is stopped.
#[derive(Debug)]
pub struct ProbeCsv {
    rows: ProbeRows,
    schedule: Schedule,
    /// Steps whose watched displacements were received, including the initial state.
    watched: usize,
    output: Output,
}

impl ProbeCsv {
    /// Starts the output with the row of column names.
    ///
    /// # Errors
    /// [`OutputError::Failed`].
    pub fn new(
        mut output: Output,
        rows: ProbeRows,
        schedule: Schedule,
    ) -> Result<Self, OutputError> {
        match writeln!(output, "{}", rows.columns().join(",")) {
            Ok(()) => Ok(Self {
                rows,
                schedule,
                watched: 0,
                output,
            }),
            Err(source) => Err(output.failed(source)),
        }
    }

    /// True if a file is only such a table, or the table of a run's folder.
    ///
    /// # Errors
    /// The system's reason for which it cannot be read.
    pub fn is_table(path: &Path) -> io::Result<bool> {
        let mut lines = BufReader::new(File::open(path)?).split(b'\n');
        let mut columns = 0;
        let mut rows = 0;
        while let Some(line) = lines.next().transpose()? {
            let Ok(line) = std::str::from_utf8(&line) else {
                return Ok(false);
            };
            if columns == 0 {
                if line.starts_with("# ") {
                    continue;
                }
                let mut names = line.split(',');
                if names.next() != Some(BEGIN) || !names.all(is_column) {
                    return Ok(false);
                }
                columns = line.split(',').count();
                continue;
            }
            let numbers = line.split(',');
            let is_row = numbers.clone().count() == columns
                && numbers.clone().all(|number| number.parse::<f64>().is_ok());
            if !is_row {
                return Ok(false);
            }
            rows += 1;
        }
        Ok(rows > 0)
    }

    /// Continues with the rows of another body, whose probes are the same.
    pub fn change_body(&mut self, body: &SceneBody) {
        self.rows = ProbeRows::new(body);
    }

    /// Completes the output; see [`Output::finish`].
    ///
    /// # Errors
    /// [`OutputError`] when the output cannot be written or its name may no longer be used.
    pub fn finish(self) -> Result<Delivery, OutputError> {
        self.output.finish()
    }
}

/// Writes a row.
fn write(output: &mut Output, t: f64, row: &str) -> Result<Verdict, RecordError> {
    match output.write_all(row.as_bytes()) {
        Ok(()) if output.reader_left() => Ok(Verdict::Stop),
        Ok(()) => Ok(Verdict::Continue),
        Err(error) => Err(RecordError {
            t,
            source: output.failed(error).into(),
        }),
    }
}

impl Recorder for ProbeCsv {
    fn next(&mut self, step: usize) -> Option<usize> {
        let next = self.schedule.next(step);
        next.filter(|_| self.rows.need_moments())
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        let t = moment.state.t();
        let row = self.rows.of_moment(moment);
        let row = row.map_err(|error| RecordError {
            t,
            source: error.into(),
        })?;
        write(&mut self.output, t, row)
    }

    fn watches(&self) -> Vec<u32> {
        self.rows.watched()
    }

    fn watched(&mut self, t: f64, moving: &[f64]) -> Result<Verdict, RecordError> {
        let step = self.watched;
        self.watched += 1;
        match self.schedule.is_due(step) {
            true => write(&mut self.output, t, self.rows.of_watched(t, moving)),
            false => Ok(Verdict::Continue),
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
    use crate::scene::Quantity;
    use crate::simulation::{Probe, ProbeNode};

    fn csv(path: &Path, probes: &[Probe]) -> ProbeCsv {
        let output = Destination::new(path, &[]).unwrap().open().unwrap();
        ProbeCsv::new(
            output,
            ProbeRows::of(probes.into(), None),
            Schedule::at_most(3, 3),
        )
        .unwrap()
    }

    fn probes() -> Vec<Probe> {
        let node = |share: f64, dofs: &[Option<usize>], courses: Vec<Vec<Course>>| ProbeNode {
            share,
            index: 0,
            dofs: dofs.to_vec(),
            courses,
        };
        let probe = |name: &str, nodes: Vec<ProbeNode>| Probe {
            name: name.into(),
            quantity: Quantity::Displacement,
            node: None,
            nodes,
            tets: Vec::new(),
            is_gone: false,
            place: String::new(),
        };
        let along_y = Course::new([9.0, 0.25, 9.0], Ramp::Linear);
        let moved = [Vec::new(), vec![along_y], Vec::new()];
        vec![
            probe(
                "tip",
                vec![node(1.0, &[Some(3), None, Some(5)], Vec::new())],
            ),
            probe("mass", vec![node(1.0, &[Some(0)], Vec::new())]),
            probe(
                "mean",
                vec![
                    node(0.75, &[None, None, Some(8)], moved.to_vec()),
                    node(0.25, &[Some(9), None, Some(11)], Vec::new()),
                ],
            ),
        ]
    }

    /// Displacements of the degrees of freedom 3, 5, 0, 8, 9 and 11.
    const MOVING: [f64; 6] = [1e-7, 0.3, 0.1, 0.5, 4.0, 1.0];

    #[test]
    fn rows_hold_the_probes_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        let probes = probes();
        let mut csv = csv(&path, &probes);
        csv.watched(2.0, &MOVING).unwrap();
        assert!(!path.exists(), "unfinished files have another name");
        assert_eq!(csv.finish().unwrap(), Delivery::Whole);
        assert!(ProbeCsv::is_table(&path).unwrap());
        let own = fs::read_to_string(&path).unwrap();
        for other in [
            "t_s\n",
            "t_s",
            "t_s,x_m,y_m,z_m\n0.0,1.0,2.0,3.0\n",
            "t_s,kinetic_J\n0.0,1.0\n",
            "t_s,factor\n0.0,1.0\n",
            &format!("{own}# mine\n"),
            &format!("{own}1.0,2.0\n"),
            &own.replace("tip_u_x_m", "mine"),
        ] {
            let foreign = folder.path().join("other.csv");
            fs::write(&foreign, other).unwrap();
            assert!(!ProbeCsv::is_table(&foreign).unwrap(), "{other}");
        }
        fs::write(
            folder.path().join("other.csv"),
            format!("# tip: node 1\n{own}"),
        )
        .unwrap();
        assert!(ProbeCsv::is_table(&folder.path().join("other.csv")).unwrap());
        fs::remove_file(folder.path().join("other.csv")).unwrap();
        assert_eq!(
            fs::read_to_string(&path).unwrap(),
            "t_s,tip_u_x_m,tip_u_y_m,tip_u_z_m,mass_u_m,mean_u_x_m,mean_u_y_m,mean_u_z_m\n\
             2.0,1e-7,0.0,0.3,0.1,1.0,0.375,0.625\n"
        );
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn an_abandoned_file_leaves_the_old_one_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        fs::write(&path, "old").unwrap();
        let probes = probes();
        let mut csv = csv(&path, &probes);
        csv.watched(0.0, &MOVING).unwrap();
        drop(csv);
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert!(!ProbeCsv::is_table(&path).unwrap());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}

//! Cost of a step in time.

use std::fmt;
use std::time::Instant;

/// Elapsed time and, on Linux, CPU time of all programs that were run and ended in the meantime (s).
#[derive(Debug)]
pub(super) struct Cost {
    wall: f64,
    cpu: Option<f64>,
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.0} s", self.wall)?;
        match self.cpu {
            Some(cpu) => write!(f, ", {cpu:.0} s of CPU"),
            None => Ok(()),
        }
    }
}

/// Start of a step.
pub(super) struct Stopwatch {
    wall: Instant,
    cpu: Option<f64>,
}

impl Stopwatch {
    pub(super) fn start() -> Self {
        Self {
            wall: Instant::now(),
            cpu: cpu_of_children(),
        }
    }

    pub(super) fn stop(&self) -> Cost {
        Cost {
            wall: self.wall.elapsed().as_secs_f64(),
            cpu: cpu_of_children()
                .zip(self.cpu)
                .map(|(now, then)| now - then),
        }
    }
}

/// CPU time of programs that this one has run and waited for, and of their own such programs (s).
fn cpu_of_children() -> Option<f64> {
    seconds_in(&std::fs::read_to_string("/proc/self/stat").ok()?)
}

/// The fields `cutime` and `cstime` of a line of `/proc/PID/stat`, in ticks of .01 s (proc(5)).
fn seconds_in(line: &str) -> Option<f64> {
    // The second field is a name in brackets, which may hold anything.
    let (_, fields) = line.rsplit_once(')')?;
    let mut fields = fields.split_whitespace().skip(13);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some(0.01 * (ticks()? + ticks()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_of_children_is_the_sixteenth_and_seventeenth_field() {
        let line = "1 (a ) name) S 4 5 6 7 8 9 10 11 12 13 14 15 250 50 18";
        assert_eq!(seconds_in(line), Some(3.0));
        assert_eq!(seconds_in("nothing"), None);
    }

    #[test]
    fn a_cost_has_cpu_time_where_it_is_known() {
        let mut cost = Cost {
            wall: 1.6,
            cpu: Some(3.0),
        };
        assert_eq!(cost.to_string(), "2 s, 3 s of CPU");
        cost.cpu = None;
        assert_eq!(cost.to_string(), "2 s");
    }
}

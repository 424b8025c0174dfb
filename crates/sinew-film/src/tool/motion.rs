//! Poses of an instrument over time.

/// A position and a rotation at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseAt {
    /// Time (s).
    pub t: f64,
    /// The position (m) of the instrument's own origin.
    pub position: [f64; 3],
    /// Its rotation vector (rad).
    pub rotation: [f64; 3],
}

/// The pose at a time (s), by linear interpolation between two of them.
pub(super) fn at(poses: &[PoseAt], t: f64) -> Option<PoseAt> {
    let after = poses.partition_point(|pose| pose.t <= t);
    let before = *poses.get(after.saturating_sub(1))?;
    let Some(later) = poses
        .get(after)
        .filter(|later| t > before.t && later.t > before.t)
    else {
        return Some(before);
    };
    let share = (t - before.t) / (later.t - before.t);
    let mix =
        |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|axis| a[axis] + share * (b[axis] - a[axis]));
    Some(PoseAt {
        t,
        position: mix(before.position, later.position),
        rotation: mix(before.rotation, later.rotation),
    })
}

/// The poses of an instrument of this name in the text of `tools.csv`. Without columns of its rotation, all poses have
/// the given rotation. `None` if the table lacks its columns, or a row lacks their numbers.
#[must_use]
pub fn poses_of_table(text: &str, name: &str, rotation: [f64; 3]) -> Option<Vec<PoseAt>> {
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let head: Vec<&str> = lines.next()?.split(',').collect();
    let column = |column: &str| head.iter().position(|found| *found == column);
    let columns = |part: &str, unit: &str| -> Option<[usize; 3]> {
        let [x, y, z] = ["x", "y", "z"].map(|axis| column(&format!("{name}_{part}{axis}_{unit}")));
        Some([x?, y?, z?])
    };
    let t = column("t_s")?;
    let places = columns("", "m")?;
    let turns = columns("r", "rad");
    let rows = lines.map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |column: usize| cells.get(column)?.parse::<f64>().ok();
        let three = |[x, y, z]: [usize; 3]| Some([number(x)?, number(y)?, number(z)?]);
        Some(PoseAt {
            t: number(t)?,
            position: three(places)?,
            rotation: match turns {
                Some(turns) => three(turns)?,
                None => rotation,
            },
        })
    });
    rows.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str =
        "# jaw: a remark\nt_s,jaw_x_m,jaw_y_m,jaw_z_m,jaw_work_J\n0.0,1,2,3,0\n2.0,3,2,3,0\n";

    #[test]
    fn poses_of_a_table_are_straight_between_its_rows() {
        let poses = poses_of_table(TABLE, "jaw", [0.5, 0.0, 0.0]).unwrap_or_default();
        let place = |t| at(&poses, t).map(|pose| (pose.position, pose.rotation));
        assert_eq!(place(1.0), Some(([2.0, 2.0, 3.0], [0.5, 0.0, 0.0])));
        assert_eq!(place(-1.0), Some(([1.0, 2.0, 3.0], [0.5, 0.0, 0.0])));
        assert_eq!(place(5.0), Some(([3.0, 2.0, 3.0], [0.5, 0.0, 0.0])));
    }

    #[test]
    fn another_tool_and_a_cut_off_row_have_none() {
        assert_eq!(poses_of_table(TABLE, "hook", [0.0; 3]), None);
        assert_eq!(
            poses_of_table(&format!("{TABLE}3.0,1"), "jaw", [0.0; 3]),
            None
        );
    }
}

//! Blades of a table of strokes.

use super::instrument::Tool;
use super::motion::PoseAt;
use super::part::{Part, Shape};
use crate::vector::{V3, cross, dot, length, scaled, sub, turned, unit};

/// The columns of a table of strokes.
const COLUMNS: &str = "stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m";

/// The direction of a blade's edge in its own frame.
const EDGE: V3 = [0.0, 0.0, 1.0];

/// A row of a table: the number of the stroke, a time (s), and both ends (m) of the blade.
#[derive(Debug, Clone, Copy)]
struct Row {
    stroke: f64,
    t: f64,
    ends: [[f64; 3]; 2],
}

/// The blades of a table of strokes, one for each stroke. A blade is visible from the end of the previous stroke, waits
/// at the beginning of its own stroke, and disappears at its end. `None` for another table.
#[must_use]
pub fn blades_of_strokes(text: &str) -> Option<Vec<Tool>> {
    let mut lines = text.lines().map(str::trim);
    let mut lines = lines
        .by_ref()
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    let head: String = lines.next()?.split_whitespace().collect();
    if head != COLUMNS {
        return None;
    }
    let rows: Vec<Row> = lines.map(row).collect::<Option<_>>()?;
    let mut blades = Vec::new();
    let mut from = f64::NEG_INFINITY;
    for rows in rows.chunk_by(|a, b| a.stroke == b.stroke) {
        let blade = blade(rows, from);
        from = rows.last().map_or(from, |row| row.t);
        blades.push(blade);
    }
    Some(blades)
}

fn row(line: &str) -> Option<Row> {
    let numbers: Vec<f64> = line
        .split(',')
        .map(|cell| cell.trim().parse().ok())
        .collect::<Option<_>>()?;
    match numbers[..] {
        [stroke, t, ax, ay, az, bx, by, bz] => Some(Row {
            stroke,
            t,
            ends: [[ax, ay, az], [bx, by, bz]],
        }),
        _ => None,
    }
}

/// The blade of a stroke, visible from a time on.
fn blade(rows: &[Row], from: f64) -> Tool {
    let along = |row: &Row| {
        let [a, b] = row.ends;
        [0, 1, 2].map(|axis| (b[axis] - a[axis]) as f32)
    };
    let poses: Vec<PoseAt> = rows
        .iter()
        .map(|row| PoseAt {
            t: row.t,
            position: [0, 1, 2].map(|axis| 0.5 * (row.ends[0][axis] + row.ends[1][axis])),
            rotation: between(EDGE, unit(along(row))).map(f64::from),
        })
        .collect();
    let longest = rows
        .iter()
        .map(|row| length(along(row)))
        .fold(0.0, f32::max);
    let shape = Shape::Blade {
        length: f64::from(longest),
        back: back_of(&poses),
    };
    let part = Part {
        shape,
        at: [0.0; 3],
        rotation: [0.0; 3],
    };
    let seen = [from, rows.last().map_or(from, |row| row.t)];
    Tool {
        seen,
        ..Tool::new(vec![part], poses)
    }
}

/// The direction in a blade's own frame opposite to its motion: that of its back.
#[must_use]
pub fn back_of(poses: &[PoseAt]) -> [f64; 3] {
    let (Some(first), Some(last)) = (poses.first(), poses.last()) else {
        return [1.0, 0.0, 0.0];
    };
    let way = [0, 1, 2].map(|axis: usize| (first.position[axis] - last.position[axis]) as f32);
    let back = turned(way, first.rotation.map(|x| -x as f32));
    let across = sub(back, scaled(EDGE, dot(back, EDGE)));
    match length(across) > 0.0 {
        true => unit(across).map(f64::from),
        false => [1.0, 0.0, 0.0],
    }
}

/// The rotation vector that turns one direction into another.
fn between(from: V3, to: V3) -> V3 {
    let axis = cross(from, to);
    let sine = length(axis);
    let cosine = dot(from, to);
    match sine > 1e-6 {
        true => scaled(axis, sine.atan2(cosine) / sine),
        // The same direction, or half a turn about any axis across.
        false if cosine >= 0.0 => [0.0; 3],
        false => [std::f32::consts::PI, 0.0, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m\n1,0.5,0,0,0,0,0,2\n1,1.0,0,3,0,0,3,2\n\n2,2.0,0,0,0,4,0,0\n2,3.0,0,0,-1,4,0,-1\n";

    #[test]
    fn each_stroke_has_its_blade_which_comes_edge_first() {
        let blades = blades_of_strokes(TABLE).unwrap_or_default();
        assert_eq!(blades.len(), 2);
        let [first, second] = &blades[..] else { return };
        assert_eq!(
            first.parts[0].shape,
            Shape::Blade {
                length: 2.0,
                back: [0.0, -1.0, 0.0]
            }
        );
        let place = |blade: &Tool, t: f64| blade.pose(t).map(|pose| pose.position);
        assert_eq!(place(first, 0.75), Some([0.0, 1.5, 1.0]));
        assert_eq!(place(first, 1.5), None);
        assert_eq!(
            (place(second, 0.9), place(second, 1.5)),
            (None, Some([2.0, 0.0, 0.0]))
        );
        // Along x, and its back above it.
        let rotation = second.poses[0].rotation.map(|x| x as f32);
        let along = turned(EDGE, rotation);
        assert!(length(sub(along, [1.0, 0.0, 0.0])) < 1e-6, "{along:?}");
        let Shape::Blade { back, .. } = second.parts[0].shape else {
            return;
        };
        let back = turned(back.map(|x| x as f32), rotation);
        assert!(length(sub(back, EDGE)) < 1e-6, "{back:?}");
    }

    #[test]
    fn another_table_has_no_blades() {
        assert_eq!(blades_of_strokes("t_s,x_m,y_m,z_m\n0,0,0,0\n"), None);
        assert_eq!(blades_of_strokes(&TABLE.replace("0.5", "soon")), None);
    }
}

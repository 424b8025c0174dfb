//! The runs that no other run beats.

use std::collections::BTreeMap;

use super::{Row, RowOutcome};

/// The largest error (fraction) of a run on the front.
const LARGEST_ON_FRONT: f64 = 0.5;

/// Sets `pareto` on every row: true if no other finished run of the same case is at least as
/// cheap (`cpu_s_per_s`) and at least as accurate (`error`), and better in one of the two.
///
/// Equal runs are on the front together. Diverged runs are never on the front, and neither are runs with an error above
/// 50 %: a zero solution has 100 % at no cost.
pub fn mark_pareto(rows: &mut [Row]) {
    let mut cases: BTreeMap<&str, Vec<(usize, f64, f64)>> = BTreeMap::new();
    for (index, row) in rows.iter().enumerate() {
        if let Some((cost, error)) = point(row) {
            cases
                .entry(&row.case)
                .or_default()
                .push((index, cost, error));
        }
    }
    let mut front = vec![false; rows.len()];
    for points in cases.values_mut() {
        points.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
        let mut last = (f64::NAN, f64::INFINITY);
        for &(index, cost, error) in points.iter() {
            if error < last.1 || (cost, error) == last {
                front[index] = true;
                last = (cost, error);
            }
        }
    }
    for (row, on_front) in rows.iter_mut().zip(front) {
        row.pareto = on_front;
    }
}

fn point(row: &Row) -> Option<(f64, f64)> {
    let error = row.error_at_most().filter(|&e| e <= LARGEST_ON_FRONT)?;
    (row.outcome == RowOutcome::Finished && row.cpu_s_per_s.is_finite())
        .then_some((row.cpu_s_per_s, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn front(points: &[(f64, f64)]) -> Vec<bool> {
        let mut rows: Vec<Row> = points
            .iter()
            .map(|&(cost, error)| row(cost, error))
            .collect();
        mark_pareto(&mut rows);
        rows.iter().map(|row| row.pareto).collect()
    }

    fn row(cost: f64, error: f64) -> Row {
        Row {
            case: "a".into(),
            cpu_s_per_s: cost,
            error: Some(error),
            ..Row::default()
        }
    }

    #[test]
    fn a_run_that_costs_more_and_is_worse_is_off_the_front() {
        assert_eq!(
            front(&[(1.0, 0.5), (2.0, 0.1), (3.0, 0.2), (4.0, 0.01)]),
            [true, true, false, true]
        );
    }

    #[test]
    fn equal_runs_share_the_front() {
        assert_eq!(front(&[(1.0, 0.5), (1.0, 0.5)]), [true, true]);
    }

    #[test]
    fn a_tie_in_one_figure_is_decided_by_the_other() {
        assert_eq!(front(&[(1.0, 0.5), (1.0, 0.4)]), [false, true]);
        assert_eq!(front(&[(2.0, 0.5), (1.0, 0.5)]), [false, true]);
    }

    #[test]
    fn nothing_off_by_more_than_half_is_on_the_front() {
        let runs = [(1e-9, 1.0), (1e-8, 0.77), (1.0, 0.5)];
        assert_eq!(front(&runs), [false, false, true]);
    }

    #[test]
    fn diverged_runs_and_old_marks_do_not_count() {
        let mut rows = vec![
            Row {
                outcome: RowOutcome::Diverged,
                error: Some(0.0),
                pareto: true,
                ..row(0.1, 0.0)
            },
            Row {
                error: None,
                pareto: true,
                ..row(0.1, 0.0)
            },
            row(1.0, 0.5),
        ];
        mark_pareto(&mut rows);
        assert_eq!(
            rows.iter().map(|r| r.pareto).collect::<Vec<_>>(),
            [false, false, true]
        );
    }

    #[test]
    fn each_case_has_its_own_front() {
        let mut rows = vec![
            row(1.0, 0.1),
            Row {
                case: "b".into(),
                ..row(2.0, 0.2)
            },
        ];
        mark_pareto(&mut rows);
        assert!(rows.iter().all(|row| row.pareto));
    }
}

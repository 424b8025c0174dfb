//! The plot "largest scene in real time".

use super::ScaleResults;
use super::row::ScaleRow;
use super::table::{error, real_time};
use sinew_draw::{Axis, Dash, Plot, Point, Series, Style};

impl ScaleResults {
    /// Wall time per simulated second over tetrahedra: a line for each method, precision and number of
    /// threads, with the size at which it is simulated time and its largest error.
    #[must_use]
    pub fn plot(&self) -> Plot {
        let x = Axis::log(
            "tetrahedra; below: how many in real time (* beyond the sizes measured), largest error",
        );
        let y = Axis::log("wall seconds per simulated second");
        let mut plot =
            Plot::new("Largest scene in real time", x, y).with_horizontal_rule(1.0, "real time");
        plot.height = 420.0;
        let mut families: Vec<&str> = Vec::new();
        for fit in &self.fits {
            if !families.contains(&fit.integrator) {
                families.push(fit.integrator);
            }
            let family = families.iter().position(|name| *name == fit.integrator);
            let style = Style {
                dash: match fit.threads {
                    1 => Dash::Solid,
                    _ => Dash::Dashed,
                },
                ..Style::of_family(family.unwrap_or(0), usize::from(fit.precision == "f32"))
            };
            let threads = match fit.threads {
                1 => "1 thread".to_owned(),
                count => format!("{count} threads"),
            };
            let figure = real_time(fit).map_or_else(String::new, |tets| format!(": {tets}"));
            let own = self.rows.iter().filter(|row| {
                (row.integrator, row.precision, row.threads)
                    == (fit.integrator, fit.precision, fit.threads)
            });
            let own: Vec<&ScaleRow> = own.collect();
            let worst = own.iter().max_by(|a, b| at_most(a).total_cmp(&at_most(b)));
            let worst = worst.map_or_else(String::new, |row| format!(", {} %", error(row)));
            let name = format!(
                "{} {}, {threads}{figure}{worst}",
                fit.integrator, fit.precision
            );
            let points = own.iter().map(|row| Point {
                x: row.tets as f64,
                y: row.wall_s_per_s,
                note: format!(
                    "{} {}, {threads}, {} tetrahedra: {:.3} s per s, error {} %",
                    row.integrator,
                    row.precision,
                    row.tets,
                    row.wall_s_per_s,
                    error(row)
                ),
                ringed: false,
            });
            plot.series.push(Series::new(name, style, points.collect()));
        }
        plot
    }
}

/// The largest error that a run may have; infinite for a run that diverged.
fn at_most(row: &ScaleRow) -> f64 {
    let error = row.error_is_below.or(row.error);
    error.unwrap_or(f64::INFINITY)
}

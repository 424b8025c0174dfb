//! Pictures of the curves of laws.

use sinew_draw::{Axis, Colour, Dash, Plot, Point, Series, Sheet, Style};
use sinew_fem::homogeneous::{Curve, End, Load, LoadState};

use super::curves::RegionCurves;
use super::measured::Measured;
use super::table::title;
use super::words::{misfits, moduli, stability};

/// The beginning of the description of a picture, which identifies it.
pub(super) const DESCRIBED: &str = "Curves of a law";

const WIDTHS: [f64; 2] = [600.0, 440.0];
const HEIGHT: f64 = 400.0;
/// Limit of stresses that are drawn, over their median: a law that stiffens exponentially leaves the frame.
const MOST: f64 = 8.0;
/// Limit of the extent of a sheet's stress over that of the others: under pressure along two axes it grows so fast that
/// it would hide them.
const OF_SHEET: f64 = 1.25;
/// Largest number of dots of measured points of a load: more would hide each other and the curve.
const MOST_DOTS: usize = 100;

/// The picture of a region's law: stretches on the left, shear on the right. Lines are solid where the law is stable
/// and dashed beyond; measured points are dots.
#[must_use]
pub fn picture_of_law(region: &RegionCurves, measured: Option<&Measured>) -> String {
    let stretches = [Load::Uniaxial, Load::Equibiaxial, Load::Planar];
    let [left, right] = WIDTHS;
    let plots = vec![
        plot(region, measured, &stretches, left),
        plot(region, measured, &[Load::SimpleShear], right),
    ];
    let mut lines = vec![moduli(region)];
    lines.extend(region.notes.iter().map(|note| note.replace('`', "")));
    let is_whole = |curve: &&Curve| curve.ends == [End::default(); 2];
    let (whole, others): (Vec<&Curve>, Vec<&Curve>) = region.curves.iter().partition(is_whole);
    match others.is_empty() {
        true => lines.push("stable (Drucker) in every load, as far as it is drawn".to_owned()),
        false => {
            lines.extend(others.into_iter().map(stability));
            lines.extend(whole.into_iter().map(stability));
        }
    }
    lines.extend(misfits(region, measured));
    let title = title(region);
    let sheet = Sheet {
        described: format!("{DESCRIBED}. {title}"),
        title,
        lines,
        plots,
    };
    sheet.svg()
}

/// The colour and marker of a load.
fn style(load: Load) -> Style {
    let place = Load::ALL.iter().position(|other| *other == load);
    Style {
        width: 2.0,
        ..Style::nth(place.unwrap_or_default())
    }
}

fn plot(region: &RegionCurves, measured: Option<&Measured>, loads: &[Load], width: f64) -> Plot {
    let curves: Vec<&Curve> = loads.iter().filter_map(|load| region.of(*load)).collect();
    let is_shear = loads.iter().all(|load| load.is_shear());
    let (name, x, y) = match is_shear {
        true => ("Simple shear", "amount of shear", "shear stress [Pa]"),
        false => ("Tension and compression", "stretch", "nominal stress [Pa]"),
    };
    let mut plot = Plot::new(name, Axis::linear(x), Axis::linear(y));
    plot.width = width;
    plot.height = HEIGHT;
    if let Some([low, high]) = range(&curves, measured) {
        plot.y = plot.y.range(low, high);
    }
    for curve in &curves {
        plot = with_curve(plot, curve);
    }
    if curves
        .iter()
        .any(|curve| curve.ends.iter().any(|end| end.limit.is_some()))
    {
        let beyond = Style {
            colour: Colour(0x77, 0x77, 0x77),
            dash: Dash::Dashed,
            ..style(Load::Uniaxial)
        };
        plot = plot.with(Series::line("not stable (Drucker)", beyond, []));
    }
    if let Some(measured) = measured {
        for load in loads {
            plot = with_points(plot, *load, measured);
        }
    }
    plot
}

/// A curve: solid in its stable range, dashed beyond.
fn with_curve(plot: Plot, curve: &Curve) -> Plot {
    let [low, high] = curve.stable();
    let drawn = |state: &LoadState| (state.amount, state.nominal);
    let at = |amount: f64| curve.at(amount).map(|stress| (amount, stress));
    let stable = curve
        .states
        .iter()
        .filter(|state| state.is_stable)
        .map(drawn);
    let stable = at(low).into_iter().chain(stable).chain(at(high));
    let below = curve
        .states
        .iter()
        .filter(|state| state.amount < low)
        .map(drawn);
    let above = curve
        .states
        .iter()
        .filter(|state| state.amount > high)
        .map(drawn);
    let dashed = Style {
        dash: Dash::Dashed,
        ..style(curve.load)
    };
    let below: Vec<_> = below.chain(at(low)).collect();
    let above: Vec<_> = at(high).into_iter().chain(above).collect();
    let mut plot = plot.with(Series::line(
        curve.load.to_string(),
        style(curve.load),
        stable,
    ));
    for part in [below, above].into_iter().filter(|part| part.len() > 1) {
        plot = plot.with(Series::line("", dashed, part));
    }
    plot
}

/// Measured points as dots without a line.
fn with_points(plot: Plot, load: Load, measured: &Measured) -> Plot {
    let all = measured.of(load).count();
    let nth = all.div_ceil(MOST_DOTS).max(1);
    let gap = || Point::from((f64::NAN, f64::NAN));
    let points = measured.of(load).step_by(nth).flat_map(|(amount, stress)| {
        let note = format!("measured, {load} {amount}: {stress} Pa");
        let point = Point {
            note,
            ..Point::from((amount, stress))
        };
        [point, gap()]
    });
    let points: Vec<Point> = points.collect();
    match points.is_empty() {
        true => plot,
        false => {
            let dots = Style {
                width: 0.0,
                ..style(load)
            };
            let name = match nth {
                1 => format!("measured, {load}"),
                _ => format!("measured, {load}, one of {nth}"),
            };
            plot.with(Series::new(name, dots, points))
        }
    }
}

/// The range of stresses that is shown.
fn range(curves: &[&Curve], measured: Option<&Measured>) -> Option<[f64; 2]> {
    let is_sheet = |curve: &&&Curve| curve.load == Load::Equibiaxial;
    let stresses = |curve: &&Curve| -> Vec<f64> {
        let states = curve.states.iter();
        states.map(|state| state.nominal).collect()
    };
    let others = curves.iter().filter(|curve| !is_sheet(curve));
    let others: Vec<f64> = others.flat_map(stresses).collect();
    let mut sizes: Vec<f64> = others.iter().map(|stress| stress.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let most = MOST * sizes.get(sizes.len() / 2)?;
    let others = others.into_iter().map(|stress| stress.clamp(-most, most));
    let [low, high] = extent(others).map(|end| OF_SHEET * end);
    let sheets = curves.iter().filter(is_sheet).flat_map(stresses);
    let sheets = sheets.map(|stress| stress.clamp(low, high));
    let points = measured.into_iter().flat_map(|measured| {
        let of = curves.iter().flat_map(|curve| measured.of(curve.load));
        of.map(|(_, stress)| stress)
    });
    let others = [low, high].map(|end| end / OF_SHEET);
    let [low, high] = extent(sheets.chain(points).chain(others));
    let room = 0.05 * (high - low);
    (room > 0.0 && room.is_finite()).then_some([low - room, high + room])
}

/// The least and the largest of these stresses and 0.
fn extent(stresses: impl Iterator<Item = f64>) -> [f64; 2] {
    stresses.fold([0.0, 0.0], |[low, high], stress: f64| {
        [low.min(stress), high.max(stress)]
    })
}

#[cfg(test)]
mod tests {
    use sinew_fem::homogeneous::{Axes, Solid};
    use sinew_fem::{Law, Region};

    use super::*;

    fn region(law: Law) -> RegionCurves {
        let solid = Solid::of(&Region::new(law.clone(), 1000.0)).unwrap();
        let axes = Axes::along([1.0, 0.0, 0.0]).unwrap();
        let curve = |load: Load| {
            let shift = load.rest() - 1.0;
            solid.curve(load, &axes, [0.5 + shift, 1.5 + shift], &[])
        };
        RegionCurves {
            number: 1,
            group: Some("<liver>".to_owned()),
            law: law.to_string(),
            lame: solid.lame(),
            has_fibres: false,
            notes: Vec::new(),
            curves: Load::ALL.map(curve).to_vec(),
        }
    }

    #[test]
    fn curves_are_dashed_where_they_are_not_stable() {
        use sinew_fem::hyperelastic::Parameters;
        let weak = region(Law::hyperelastic("stvk", Parameters::new(3000.0, 0.3)));
        let svg = picture_of_law(&weak, None);
        // Three curves of the left plot, and the legend.
        assert_eq!(svg.matches("stroke-dasharray").count(), 4, "{svg}");
        assert!(svg.contains("not stable (Drucker)"));
        let sound = picture_of_law(&region(Law::linear(3000.0, 0.3)), None);
        assert!(!sound.contains("stroke-dasharray") && !sound.contains("not stable"));
        assert!(sound.contains("stable (Drucker) in every load"));
    }

    #[test]
    fn measured_points_are_dots_that_are_seen() {
        let measured = Measured {
            points: vec![(Load::Uniaxial, 1.1, 310.0), (Load::Uniaxial, 1.2, 1e4)],
        };
        let linear = region(Law::linear(3000.0, 0.3));
        let svg = picture_of_law(&linear, Some(&measured));
        // Two dots, and that of the legend.
        assert_eq!(svg.matches("<circle").count(), 3);
        assert!(svg.contains("measured, uniaxial 1.2: 10000 Pa") && svg.contains("&lt;liver&gt;"));
        let curves: Vec<&Curve> = linear.curves.iter().take(3).collect();
        assert!(range(&curves, Some(&measured)).unwrap()[1] > 1e4);
    }
}

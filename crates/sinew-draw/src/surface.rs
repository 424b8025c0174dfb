//! Pictures of surface meshes.

mod projection;

use crate::{
    axis::{Axis, nice_step},
    colour_map::{shade, viridis},
    number,
    style::{Colour, Dash},
    svg::{Anchor, Frame, Paint, Stroke, Svg, Text, text_width},
};
use projection::{Extent, corners, edges, light, project};

const MARGIN: f64 = 14.0;
const TITLE: f64 = 15.0;
const TEXT: f64 = 12.0;
const BAR: f64 = 14.0;

/// A surface of triangles seen from above one corner, coloured by a number at each vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface<'a> {
    /// Title above the picture.
    pub title: String,
    /// Vertices (m) of the drawn state; z is up.
    pub points: &'a [[f64; 3]],
    /// Triangles of vertices.
    pub triangles: &'a [[u32; 3]],
    /// The number at each vertex.
    pub values: &'a [f64],
    /// Name of the numbers, with the unit.
    pub value_label: String,
    /// Numbers at the ends of the colour bar; otherwise they come from `values`.
    pub range: Option<(f64, f64)>,
    /// A box drawn in outline: lowest and highest corner (m). Usually the undeformed body.
    pub outline: Option<[[f64; 3]; 2]>,
    /// The box that fits into the picture, lowest and highest corner (m); otherwise it fits the surface and the
    /// outline. The same box gives pictures of the same scale.
    pub view: Option<[[f64; 3]; 2]>,
    /// Width and height of the drawing without title and colour bar (px).
    pub size: (f64, f64),
}

impl<'a> Surface<'a> {
    /// A surface with default values of all other fields.
    #[must_use]
    pub fn new(
        title: impl Into<String>,
        points: &'a [[f64; 3]],
        triangles: &'a [[u32; 3]],
        values: &'a [f64],
        value_label: impl Into<String>,
    ) -> Self {
        Self {
            title: title.into(),
            points,
            triangles,
            values,
            value_label: value_label.into(),
            range: None,
            outline: None,
            view: None,
            size: (440.0, 400.0),
        }
    }

    /// The picture. Triangles with a vertex that is missing or not finite are left out, and the picture states their
    /// number.
    #[must_use]
    pub fn svg(&self) -> String {
        let (shown, left_out) = self.facets();
        let frame = Frame {
            left: MARGIN,
            top: MARGIN + TITLE + 12.0,
            width: self.size.0,
            height: self.size.1,
        };
        let gutter = 16.0 + BAR + 8.0 + 46.0 + TEXT + 8.0;
        let height = frame.bottom() + 40.0;
        let described = format!("{}, coloured by {}", self.title, self.value_label);
        let mut svg = Svg::new(frame.right() + gutter + MARGIN, height, &described);
        svg.text(
            &Text::new(MARGIN, MARGIN + 0.6 * TITLE, &self.title)
                .sized(TITLE)
                .bold(),
        );

        let view = self.fit(&shown, frame);
        svg.clipped(frame, |svg| {
            let (hidden, seen) = self.outline.map(edges).unwrap_or_default();
            view.outline(svg, &hidden, Dash::Dotted);
            self.draw_facets(svg, &view, shown);
            view.outline(svg, &seen, Dash::Dashed);
        });
        view.scale_bar(&mut svg, frame);
        self.colour_bar(&mut svg, frame);
        if left_out > 0 {
            let note = format!("{left_out} triangles not finite, left out");
            svg.text(
                &Text::new(frame.right(), frame.bottom() + 20.0, &note)
                    .anchored(Anchor::End)
                    .painted(Paint::Muted),
            );
        }
        svg.finish()
    }

    fn facets(&self) -> (Vec<Facet>, usize) {
        let facets: Vec<Facet> = self
            .triangles
            .iter()
            .filter_map(|triangle| self.facet(triangle))
            .collect();
        let left_out = self.triangles.len() - facets.len();
        (facets, left_out)
    }

    fn facet(&self, triangle: &[u32; 3]) -> Option<Facet> {
        let mut corners = [[0.0; 3]; 3];
        let mut value = 0.0;
        for (corner, &vertex) in corners.iter_mut().zip(triangle) {
            *corner = *self.points.get(vertex as usize)?;
            value += self.values.get(vertex as usize)? / 3.0;
        }
        let finite = corners.iter().flatten().all(|x| x.is_finite()) && value.is_finite();
        finite.then_some(Facet { corners, value })
    }

    fn colour_range(&self) -> (f64, f64) {
        if let Some(range) = self.range {
            return range;
        }
        let finite = self.values.iter().copied().filter(|x| x.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        if low < high {
            (low, high)
        } else if low == high && low != 0.0 {
            (low.min(0.0), low.max(0.0))
        } else {
            (0.0, 1.0)
        }
    }

    fn fit(&self, shown: &[Facet], frame: Frame) -> View {
        let mut extent = Extent::default();
        if let Some(view) = self.view {
            corners(view)
                .into_iter()
                .for_each(|p| extent.add(project(p)));
        } else {
            let surface = shown.iter().flat_map(|facet| facet.corners);
            let outline = self.outline.into_iter().flat_map(corners);
            surface.chain(outline).for_each(|p| extent.add(project(p)));
        }
        View::new(&extent, frame)
    }

    fn draw_facets(&self, svg: &mut Svg, view: &View, mut facets: Vec<Facet>) {
        let (low, high) = self.colour_range();
        let depth = |facet: &Facet| facet.corners.iter().map(|&p| project(p).depth).sum::<f64>();
        facets.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
        for facet in &facets {
            let base = viridis((facet.value - low) / (high - low));
            let lit = shade(base, light(&facet.corners));
            let points = facet.corners.map(|p| view.place(p));
            svg.facet(&points, lit, shade(lit, 0.82));
        }
    }

    fn colour_bar(&self, svg: &mut Svg, frame: Frame) {
        let (low, high) = self.colour_range();
        let bar = Frame {
            left: frame.right() + 16.0,
            top: frame.top + 10.0,
            width: BAR,
            height: frame.height - 20.0,
        };
        let slices = 64;
        for i in 0..slices {
            let colour = viridis((f64::from(i) + 0.5) / f64::from(slices));
            // Each reaches to the top and the next covers it: no seams.
            let height = bar.height * (1.0 - f64::from(i) / f64::from(slices));
            svg.rect(Frame { height, ..bar }, Paint::Data(colour));
        }
        let axis = Axis::linear("").range(low, high);
        let mut widest: f64 = 0.0;
        for tick in axis.fitted(std::iter::empty()).ticks(6) {
            let y = bar.bottom() - tick.at * bar.height;
            let label = tick.label.unwrap_or_default();
            widest = widest.max(text_width(&label, TEXT));
            let edge = bar.right();
            svg.line((edge, y), (edge + 4.0, y), Stroke::new(Paint::Muted, 1.0));
            svg.text(&Text::new(edge + 7.0, y, &label));
        }
        let x = bar.right() + 7.0 + widest + 12.0;
        svg.text(
            &Text::new(x, bar.top + 0.5 * bar.height, &self.value_label)
                .anchored(Anchor::Middle)
                .upward(),
        );
    }
}

struct Facet {
    corners: [[f64; 3]; 3],
    value: f64,
}

/// The map from the projection to the picture.
struct View {
    scale: f64,
    shift: (f64, f64),
}

impl View {
    fn new(extent: &Extent, frame: Frame) -> Self {
        let inside = (frame.width - 12.0, frame.height - 12.0);
        let (width, height) = extent.size();
        let scale = (inside.0 / width).min(inside.1 / height);
        let scale = if scale.is_finite() { scale } else { 1.0 };
        let (x, y) = extent.middle();
        let shift = (
            frame.left + 0.5 * frame.width - scale * x,
            frame.top + 0.5 * frame.height - scale * y,
        );
        Self { scale, shift }
    }

    fn place(&self, point: [f64; 3]) -> (f64, f64) {
        let p = project(point);
        // Far outside, coordinates only have to stay safe to write.
        let safe = |x: f64| x.clamp(-1e5, 1e5);
        (
            safe(self.shift.0 + self.scale * p.x),
            safe(self.shift.1 + self.scale * p.y),
        )
    }

    fn outline(&self, svg: &mut Svg, edges: &[[[f64; 3]; 2]], dash: Dash) {
        let stroke = Stroke {
            dash,
            ..Stroke::new(Paint::Data(Colour(0x70, 0x70, 0x70)), 1.0)
        };
        for edge in edges {
            svg.polyline(&edge.map(|p| self.place(p)), stroke);
        }
    }

    /// A length along one of the three axes, which the projection shortens equally.
    fn scale_bar(&self, svg: &mut Svg, frame: Frame) {
        let per_metre = self.scale * projection::SHORTENING;
        let length = nice_step(60.0 / per_metre);
        let pixels = length * per_metre;
        if !(10.0..=frame.width).contains(&pixels) {
            return;
        }
        let (x, y) = (frame.left + 4.0, frame.bottom() + 20.0);
        let stroke = Stroke::new(Paint::Ink, 1.5);
        svg.line((x, y), (x + pixels, y), stroke);
        for end in [x, x + pixels] {
            svg.line((end, y - 4.0), (end, y + 4.0), stroke);
        }
        let label = if length >= 1.0 {
            format!("{} m", number::short(length))
        } else {
            format!("{} mm", number::short(1e3 * length))
        };
        svg.text(&Text::new(
            x + pixels + 8.0,
            y,
            &format!("{label} along each axis"),
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [[f64; 3]; 4] = [
        [0.0, 0.0, 0.0],
        [0.1, 0.0, 0.0],
        [0.0, 0.1, 0.0],
        [0.0, 0.0, f64::NAN],
    ];

    #[test]
    fn a_triangle_is_drawn_and_a_broken_one_is_told_of() {
        let surface = Surface::new(
            "<s>",
            &POINTS,
            &[[0, 1, 2], [0, 1, 3], [0, 1, 9]],
            &[0.0, 1.0, 2.0, 3.0],
            "|u| [mm]",
        );
        let svg = surface.svg();
        assert!(svg.contains("2 triangles not finite, left out"));
        assert_eq!(svg.matches("stroke-width=\"0.5\"").count(), 1);
        assert!(svg.contains("&lt;s&gt;") && !svg.contains("NaN"));
    }

    #[test]
    fn nothing_to_see_is_a_picture() {
        let svg = Surface::new("", &[], &[], &[], "").svg();
        assert!(svg.starts_with("<svg") && !svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn what_lies_far_outside_stays_a_safe_coordinate() {
        let points = [[0.0, 0.0, 0.0], [1e30, 0.0, 0.0], [0.0, 1e30, 0.0]];
        let mut surface = Surface::new("", &points, &[[0, 1, 2]], &[0.0; 3], "");
        surface.view = Some([[0.0; 3], [0.1; 3]]);
        assert!(!surface.svg().contains("00000000"));
    }
}

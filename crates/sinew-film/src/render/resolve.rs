//! Colours of pixels from the visible triangles at their points.

use rayon::prelude::*;

use super::camera::Camera;
use super::contact::Contact;
use super::floor::{BACKGROUND, Floor, SLANTED};
use super::light::Light;
use super::model::Model;
use super::paint::{Palette, Point};
use super::raster::{BAND, NOTHING, Projected, SAMPLES, Samples};
use super::shadow::Shadow;
use crate::colour_space::{Screen, linear};
use crate::vector::{V3, add, dot, scaled, times, unit};
use crate::{Picture, Size};

/// The share of the lamp's light that reaches sides facing away from it.
const AWAY: f32 = 0.35;

/// The part of a scene that is the same in all pictures.
pub(crate) struct Stage {
    camera: Camera,
    light: Light,
    /// The height of the floor.
    floor: f32,
    palette: Palette,
    screen: Screen,
}

impl Stage {
    /// A stage in the view of a camera, with a floor at this height.
    pub(crate) fn new(camera: Camera, floor: f32) -> Self {
        Self {
            light: Light::of(&camera),
            camera,
            floor,
            palette: Palette::new(),
            screen: Screen::new(),
        }
    }
}

/// A picture of a model. The bits do not depend on the number of threads.
pub(crate) fn draw(stage: &Stage, model: &Model, size: Size) -> Picture {
    let mut picture = Picture::new(size, BACKGROUND);
    let projected = Projected::of(model, &stage.camera);
    let shadow = Shadow::of(model, stage.light.key);
    // Seen from the side or from below there is none.
    let floor = (stage.camera.back[2] > SLANTED)
        .then(|| Floor::of(stage.floor, &shadow, &Contact::of(model, stage.floor)));
    let drawing = Drawing {
        stage,
        model,
        shadow,
        floor,
        background: linear(BACKGROUND),
        projected,
    };
    let width = size.width();
    let bands = drawing.projected.bands(size.height());
    let pixels = picture
        .pixels
        .par_chunks_mut(width * BAND)
        .zip(&bands)
        .enumerate();
    pixels.for_each_init(Samples::default, |samples, (band, (pixels, triangles))| {
        let top = band * BAND;
        samples.clear(pixels.len());
        for index in triangles {
            let corners = drawing.projected.triangles[*index as usize];
            let corners = corners.map(|corner| drawing.projected.seen[corner as usize]);
            samples.fill(*index, corners, width, top);
        }
        for (place, (pixel, seen)) in pixels.iter_mut().zip(&samples.triangles).enumerate() {
            let middle = [place % width, top + place / width].map(|at| at as f32 + 0.5);
            if let Some(light) = drawing.pixel(middle, seen) {
                *pixel = stage.screen.colour(light);
            }
        }
    });
    picture
}

/// A picture while it is drawn.
struct Drawing<'a> {
    stage: &'a Stage,
    model: &'a Model,
    projected: Projected,
    shadow: Shadow,
    floor: Option<Floor>,
    background: V3,
}

impl Drawing<'_> {
    /// The light of a pixel: of each visible triangle once, weighted by the share it covers. `None` for the background.
    fn pixel(&self, middle: [f32; 2], seen: &[u32; 4]) -> Option<V3> {
        if *seen == [NOTHING; 4] {
            return self.floor(middle);
        }
        let mut light = [0.0; 3];
        for (first, triangle) in seen.iter().enumerate() {
            if seen[..first].contains(triangle) {
                continue;
            }
            let mut at = [0.0; 2];
            let mut count = 0.0;
            for (sample, other) in SAMPLES.iter().zip(seen) {
                if other == triangle {
                    at = [at[0] + sample[0], at[1] + sample[1]];
                    count += 1.0;
                }
            }
            let at = [middle[0] + at[0] / count, middle[1] + at[1] / count];
            let own = match *triangle {
                NOTHING => self.floor(at).unwrap_or(self.background),
                triangle => self.surface(triangle as usize, at),
            };
            // What is brighter than white would keep edges from being smooth.
            let own = own.map(|light| light.min(1.0));
            light = add(light, scaled(own, 0.25 * count));
        }
        Some(light)
    }

    /// The light of the floor; `None` if it is that of the background.
    fn floor(&self, [x, y]: [f32; 2]) -> Option<V3> {
        let left = self.floor.as_ref()?.left(self.stage.camera.ray(x, y))?;
        Some(times(self.background, left))
    }

    /// The light of a triangle at a position in the picture.
    fn surface(&self, triangle: usize, [x, y]: [f32; 2]) -> V3 {
        let corners = self.projected.triangles[triangle];
        let [a, b, c] = corners.map(|corner| self.projected.seen[corner as usize]);
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        let of_b = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
        let of_c = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
        // Straight on the picture is not straight in space.
        let shares = [
            (1.0 - of_b - of_c).max(0.0) * a.shrink,
            of_b.max(0.0) * b.shrink,
            of_c.max(0.0) * c.shrink,
        ];
        let sum: f32 = shares.iter().sum();
        let shares = shares.map(|share| share / sum);
        let vertices = corners.map(|corner| &self.projected.vertices[corner as usize]);
        let mean = |of: [V3; 3]| {
            add(
                add(scaled(of[0], shares[0]), scaled(of[1], shares[1])),
                scaled(of[2], shares[2]),
            )
        };
        let place = mean(vertices.map(|vertex| vertex.place));
        let to_eye = self.stage.camera.towards_eye(place);
        let mut normal = unit(mean(vertices.map(|vertex| vertex.normal)));
        if dot(normal, to_eye) < -0.2 {
            // The inner side of a surface that is open, or turned inside out.
            normal = scaled(normal, -1.0);
        }
        let values = [0, 1, 2].map(|corner: usize| shares[corner] * vertices[corner].value);
        let (_, paint) = self.model.triangles[self.projected.origins[triangle] as usize];
        let light = &self.stage.light;
        // A side that is turned away shades itself; the map is too coarse to tell where that begins.
        let turned = ((dot(normal, light.key) + 0.15) / 0.25).clamp(0.0, 1.0);
        let lit = match turned > 0.0 {
            true => AWAY + turned * (self.shadow.lit(place, normal) - AWAY),
            false => AWAY,
        };
        let point = Point {
            normal,
            rest: mean(vertices.map(|vertex| vertex.rest)),
            value: values.iter().sum(),
            paint,
            to_eye,
            lit,
        };
        self.stage.palette.shade(light, &point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::View;
    use crate::render::{Paint, Vertex};

    /// Adds a square at a depth that fills the picture.
    fn square(model: &mut Model, towards_eye: f32, value: f32) {
        let first = model.vertices.len() as u32;
        for [x, z] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            let place = [x, -towards_eye, z];
            let normal = [0.0, -1.0, 0.0];
            model.vertices.push(Vertex {
                place,
                normal,
                rest: place,
                value,
            });
        }
        let corners =
            [[0, 1, 2], [0, 2, 3]].map(|triangle| triangle.map(|corner: u32| first + corner));
        model
            .triangles
            .extend(corners.map(|corners| (corners, Paint::Field)));
    }

    #[test]
    fn what_is_nearer_hides_what_is_farther_in_either_order() {
        let size = Size::new(64, 64).expect("a size");
        for text in ["front", "0,0"] {
            let view: View = text.parse().expect("a view");
            let mut camera = Camera::new(view);
            (camera.scale, camera.middle) = (20.0, [32.0; 2]);
            let stage = Stage::new(camera, -2.0);
            let middle = |squares: &[(f32, f32)]| {
                let mut model = Model::default();
                for (towards_eye, value) in squares {
                    square(&mut model, *towards_eye, *value);
                }
                draw(&stage, &model, size).at(32, 32)
            };
            let (near, far) = ((0.5, 1.0), (-0.5, 0.0));
            let yellow = middle(&[near]);
            assert_ne!(yellow, middle(&[far]));
            assert_eq!(middle(&[near, far]), yellow);
            assert_eq!(middle(&[far, near]), yellow);
        }
    }
}

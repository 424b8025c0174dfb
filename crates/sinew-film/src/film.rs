//! Pictures of a surface in motion, one for each instant.

use crate::body::Kind;
use crate::files::{Animation, Colours};
use crate::overlay::{Bar, Overlay, room};
use crate::range::Range;
use crate::render::{Camera, Model, Paint, Room, Stage, Vertex, draw, fitted};
use crate::tool::{Part, Solid, placed, solid};
use crate::vector::{V3, add, cross, scaled, sub, turned, unit};
use crate::{Clip, Colouring, FilmError, Frame, Picture, Size, Timing, Tool, View};

/// Number of instants at which the positions of a body and its instruments are sampled.
const LOOKS: usize = 24;

/// Number of pictures from which the colours of a film are chosen.
const SAMPLES: usize = 12;

/// The distance from the body up to which an instrument is kept in the picture, in radii of the body.
const BEYOND: f32 = 0.42;

/// Size, view, colours and title of the pictures.
#[derive(Debug, Clone)]
pub struct Look {
    /// Width and height of pictures.
    pub size: Size,
    /// The direction of view.
    pub view: View,
    /// The meaning of the body's colour.
    pub colouring: Colouring,
    /// The values at the ends of a field's colours; `None` for those that fit.
    pub range: Option<[f64; 2]>,
    /// The text at the top.
    pub title: String,
}

/// A surface in motion with its instruments, seen by a camera.
pub struct Film {
    clip: Clip,
    tools: Vec<Tool>,
    /// The surfaces of the parts of each tool (m), in its own frame.
    solids: Vec<Vec<Solid>>,
    is_field: bool,
    range: Range,
    scale: Scale,
    stage: Stage,
    overlay: Overlay,
    has_words: bool,
    view: View,
    size: Size,
    span: [f64; 2],
}

/// The map from positions (m) to those of the stage. On the stage the body's middle is the origin and its radius 1.
#[derive(Debug, Clone, Copy)]
struct Scale {
    middle: [f64; 3],
    radius: f64,
}

impl Scale {
    /// The scale of a clip, from the bounding box of all its positions.
    fn of(clip: &Clip) -> Self {
        let (mut low, mut high) = ([f64::MAX; 3], [f64::MIN; 3]);
        for frame in &clip.frames {
            for point in 0..frame.displacements.len() {
                let place = frame.place(point);
                if place.iter().all(|x| x.is_finite()) {
                    low = [0, 1, 2].map(|axis| low[axis].min(place[axis]));
                    high = [0, 1, 2].map(|axis| high[axis].max(place[axis]));
                }
            }
        }
        if low[0] > high[0] {
            (low, high) = ([0.0; 3], [0.0; 3]);
        }
        let half = [0, 1, 2].map(|axis| 0.5 * (high[axis] - low[axis]));
        let radius = half.iter().map(|half| half * half).sum::<f64>().sqrt();
        Self {
            middle: [0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis])),
            radius: if radius > 0.0 { radius } else { 1.0 },
        }
    }

    fn place(&self, place: [f64; 3]) -> V3 {
        [0, 1, 2].map(|axis| ((place[axis] - self.middle[axis]) / self.radius) as f32)
    }

    /// A displacement or a position in a tool's own frame.
    fn length(&self, v: V3) -> V3 {
        scaled(v, (1.0 / self.radius) as f32)
    }
}

impl Film {
    /// A film of a clip with instruments.
    ///
    /// # Errors
    /// [`FilmError`] for a clip without frames and for a range that is not valid.
    pub fn new(clip: Clip, tools: Vec<Tool>, look: &Look) -> Result<Self, FilmError> {
        let span = clip.span().ok_or(FilmError::NothingToShow)?;
        let field = look.colouring.field();
        if field.is_none() && look.range.is_some() {
            return Err(FilmError::RangeOfTissue);
        }
        let range = Range::of(&clip, look.range, &look.colouring)?;
        let scale = Scale::of(&clip);
        let solids = tools.iter().map(|tool| {
            let parts = tool
                .parts
                .iter()
                .map(|part| placed_solid(part, scale.radius as f32));
            parts.collect()
        });
        let bar = field.map(|_| {
            Bar::new(
                look.colouring.title(),
                look.colouring.unit(),
                range.ends,
                range.beyond,
            )
        });
        let mut film = Self {
            solids: solids.collect(),
            clip,
            tools,
            is_field: field.is_some(),
            range,
            scale,
            stage: Stage::new(Camera::new(look.view), 0.0),
            overlay: Overlay {
                title: look.title.clone(),
                span,
                pixels_per_metre: 1.0,
                bar,
            },
            has_words: true,
            view: look.view,
            size: look.size,
            span,
        };
        film.fit(room(field.is_some()));
        Ok(film)
    }

    /// The same film without title, time, length and the values of colours: pictures for a small size.
    #[must_use]
    pub fn without_words(mut self) -> Self {
        self.has_words = false;
        self.fit(Room::EVEN);
        self
    }

    /// Places the camera so that all of the motion is within the margins.
    fn fit(&mut self, room: Room) {
        let (points, floor) = self.extent();
        let camera = fitted(self.view, self.size, room, &points);
        self.overlay.pixels_per_metre = f64::from(camera.scale) / self.scale.radius;
        self.stage = Stage::new(camera, floor);
    }

    /// Times (s) of the first and the last frame.
    #[must_use]
    pub fn span(&self) -> [f64; 2] {
        self.span
    }

    /// Pixels for a length of 1 m; in perspective, at the middle of the view.
    #[must_use]
    pub fn pixels_per_metre(&self) -> f64 {
        self.overlay.pixels_per_metre
    }

    /// The texts next to the lower end, the middle and the upper end of the colours; `None` without a field.
    #[must_use]
    pub fn marks(&self) -> Option<&[String; 3]> {
        Some(&self.overlay.bar.as_ref()?.marks)
    }

    /// The picture at a time (s) between the first frame and the last.
    ///
    /// # Errors
    /// [`FilmError::Instant`].
    pub fn picture_at(&self, t: f64) -> Result<Picture, FilmError> {
        let [first, last] = self.span;
        // Times are written with few digits.
        let room = 1e-6 * (last - first).max(last.abs());
        match t >= first - room && t <= last + room {
            true => Ok(self.picture(t)),
            false => Err(FilmError::Instant {
                asked: t,
                first,
                last,
            }),
        }
    }

    /// The picture at a time (s): before the first frame that of the first frame, after the last frame that of the
    /// last.
    #[must_use]
    pub fn picture(&self, t: f64) -> Picture {
        let mut picture = draw(&self.stage, &self.model(t), self.size);
        if self.has_words {
            self.overlay.draw(&mut picture, t);
        }
        picture
    }

    /// The film as an animated PNG. After each picture `go_on` gets the number of finished ones; `false` stops the film.
    ///
    /// # Errors
    /// [`FilmError`]: [`FilmError::Stopped`] if `go_on` returned `false`.
    pub fn animation(
        &self,
        timing: Timing,
        go_on: &mut dyn FnMut(usize) -> bool,
    ) -> Result<Vec<u8>, FilmError> {
        let times = timing.instants(self.span);
        let step = times.len().div_ceil(SAMPLES).max(1);
        // From the end backwards, so that the last one, where most has happened, is among them.
        let samples = times.iter().rev().step_by(step).map(|t| self.picture(*t));
        let samples: Vec<Picture> = samples.collect();
        let colours = Colours::of(samples.iter());
        drop(samples);
        let mut file = Vec::new();
        let pictures = (times.len(), timing.fps());
        let mut animation = Animation::new(&mut file, (self.size, colours), pictures)?;
        for (done, t) in times.iter().enumerate() {
            animation.add(&self.picture(*t))?;
            if !go_on(done + 1) {
                return Err(FilmError::Stopped);
            }
        }
        animation.finish()?;
        Ok(file)
    }

    /// The visible triangles at a time (s).
    fn model(&self, t: f64) -> Model {
        let mut model = Model::default();
        if let Some(frame) = self.clip.at(t) {
            self.add_body(&mut model, &frame);
        }
        for (tool, solids) in self.tools.iter().zip(&self.solids) {
            let Some(pose) = tool.pose(t) else {
                continue;
            };
            let rotation = pose.rotation.map(|x| x as f32);
            let at = self.scale.place(pose.position);
            for solid in solids {
                let first = model.vertices.len() as u32;
                let vertices = solid
                    .points
                    .iter()
                    .zip(&solid.normals)
                    .map(|(point, normal)| Vertex {
                        place: add(at, turned(self.scale.length(*point), rotation)),
                        normal: turned(*normal, rotation),
                        rest: [0.0; 3],
                        value: 0.0,
                    });
                model.vertices.extend(vertices);
                let triangles = solid.triangles.iter();
                let triangles =
                    triangles.map(|corners| (corners.map(|corner| first + corner), Paint::Steel));
                model.triangles.extend(triangles);
            }
        }
        model
    }

    fn add_body(&self, model: &mut Model, frame: &Frame) {
        let surface = &frame.surface;
        let points = 0..surface.rest.len();
        let places: Vec<V3> = points
            .map(|point| self.scale.place(frame.place(point)))
            .collect();
        let corners = &surface.corners;
        let mut normals = vec![[0.0; 3]; corners.points.len()];
        for (triangle, own) in surface.triangles.iter().zip(&corners.of_triangles) {
            let [a, b, c] = triangle.map(|point| places[point as usize]);
            let normal = cross(sub(b, a), sub(c, a));
            for corner in own {
                let sum = &mut normals[*corner as usize];
                *sum = add(*sum, normal);
            }
        }
        let vertices = corners.points.iter().zip(&normals).map(|(point, normal)| {
            let point = *point as usize;
            let value = frame.values.get(point).copied().unwrap_or(0.0);
            Vertex {
                place: places[point],
                normal: unit(*normal),
                rest: self.scale.place(surface.rest[point]),
                value: self.range.share(value),
            }
        });
        model.vertices.extend(vertices);
        let triangles = corners.of_triangles.iter().zip(&surface.kinds);
        model.triangles.extend(triangles.map(|(corners, kind)| {
            let paint = match (self.is_field, kind) {
                (true, _) => Paint::Field,
                (false, Kind::Cut) => Paint::Cut,
                (false, Kind::Tissue(region)) => Paint::Tissue(*region),
            };
            (*corners, paint)
        }));
    }

    /// Points that must be in the picture, and the height of the floor.
    fn extent(&self) -> (Vec<V3>, f32) {
        let mut points = Vec::new();
        let step = self.clip.frames.len().div_ceil(LOOKS).max(1);
        for frame in self.clip.frames.iter().rev().step_by(step) {
            let places =
                (0..frame.displacements.len()).map(|point| self.scale.place(frame.place(point)));
            points.extend(places.filter(|place| place.iter().all(|x| x.is_finite())));
        }
        let along = |axis: usize| points.iter().map(move |point| point[axis]);
        let low = [0, 1, 2].map(|axis| along(axis).fold(f32::MAX, f32::min));
        let high = [0, 1, 2].map(|axis| along(axis).fold(f32::MIN, f32::max));
        if points.is_empty() {
            return (vec![[-1.0; 3], [1.0; 3]], -1.0);
        }
        let near = |place: V3| -> V3 {
            [0, 1, 2].map(|axis: usize| place[axis].clamp(low[axis] - BEYOND, high[axis] + BEYOND))
        };
        let [first, last] = self.span;
        for look in 0..LOOKS {
            let t = first + (last - first) * look as f64 / (LOOKS - 1) as f64;
            for (tool, solids) in self.tools.iter().zip(&self.solids) {
                let Some(pose) = tool.pose(t) else {
                    continue;
                };
                let at = self.scale.place(pose.position);
                let rotation = pose.rotation.map(|x| x as f32);
                let all = solids.iter().flat_map(|solid| &solid.points);
                let all = all.map(|point| add(at, turned(self.scale.length(*point), rotation)));
                points.extend(all.map(near));
            }
        }
        (points, low[2])
    }
}

/// The surface of a part in the frame of its instrument.
fn placed_solid(part: &Part, radius: f32) -> Solid {
    let own = solid(&part.shape, radius);
    let turn = part.rotation.map(|x| x as f32);
    Solid {
        points: own
            .points
            .iter()
            .map(|point| placed(part, *point))
            .collect(),
        normals: own
            .normals
            .iter()
            .map(|normal| turned(*normal, turn))
            .collect(),
        triangles: own.triangles,
    }
}

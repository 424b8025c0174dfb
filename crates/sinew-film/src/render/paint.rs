//! Shading of tissue, cut faces, fields and steel.

use sinew_draw::colour_map::viridis;

use super::light::Light;
use super::model::Paint;
use super::mottle::Mottle;
use crate::colour_space::linear;
use crate::vector::{V3, add, dot, scaled, sub, times, unit};

/// Colours of tissue by region: flesh, fat, muscle, skin, liver, gland.
const TISSUES: [[u8; 3]; 6] = [
    [205, 116, 112],
    [232, 198, 128],
    [178, 66, 62],
    [228, 178, 160],
    [150, 78, 70],
    [206, 150, 140],
];

/// The colour of cut faces.
const CUT: [u8; 3] = [138, 24, 28];

/// The reach of light of each colour around a tissue's edge into the shade: red reaches farthest.
const WRAP: V3 = [0.42, 0.18, 0.14];

/// Cells of the grain in a length of 1: blotches, and vessels.
const BLOTCHES: f32 = 6.0;
const VESSELS: f32 = 4.3;

/// Unevenness of the film of liquid on tissue.
const BUMPS: f32 = 0.16;

/// The strength of the lamp.
const KEY: V3 = [1.02, 1.0, 0.96];

/// Steps of the colours of fields.
const STEPS: usize = 256;

/// A visible point of a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) normal: V3,
    pub(super) rest: V3,
    pub(super) value: f32,
    pub(super) paint: Paint,
    /// The direction to the eye.
    pub(super) to_eye: V3,
    /// The share of the lamp's light that reaches the point.
    pub(super) lit: f32,
}

/// All materials.
pub(crate) struct Palette {
    tissues: [V3; TISSUES.len()],
    cut: V3,
    fields: Vec<V3>,
    mottle: Mottle,
}

/// The colour of a share of a field's range, the same as in bars.
pub(crate) fn colour_of(share: f32) -> [u8; 3] {
    let colour = viridis(f64::from(share));
    [colour.0, colour.1, colour.2]
}

impl Palette {
    pub(crate) fn new() -> Self {
        let field = |step: usize| linear(colour_of(step as f32 / (STEPS - 1) as f32));
        Self {
            tissues: TISSUES.map(linear),
            cut: linear(CUT),
            fields: (0..STEPS).map(field).collect(),
            mottle: Mottle::new(),
        }
    }

    /// The light that goes from a point to the eye.
    pub(super) fn shade(&self, light: &Light, point: &Point) -> V3 {
        match point.paint {
            Paint::Tissue(region) => {
                let tint = self.tissues[usize::from(region.max(1) - 1) % self.tissues.len()];
                let (grain, bumps) = self.grain(point.rest);
                wet(light, point, times(tint, grain), 1.0, bumps)
            }
            Paint::Cut => {
                let grain = 0.82 + 0.36 * self.mottle.at(scaled(point.rest, 2.0 * BLOTCHES));
                wet(light, point, scaled(self.cut, grain), 1.3, [0.0; 3])
            }
            Paint::Field => {
                let share = point.value.clamp(0.0, 1.0);
                let colour = self.fields[(share * (STEPS - 1) as f32 + 0.5) as usize];
                matt(light, point, colour)
            }
            Paint::Steel => steel(light, point),
        }
    }

    /// The colour of blotches of three sizes and of fine, interrupted vessels; and the unevenness of the film of liquid.
    fn grain(&self, rest: V3) -> (V3, V3) {
        let noise = |cells: f32| self.mottle.at(scaled(rest, cells)) - 0.5;
        let (large, small) = (noise(BLOTCHES), noise(2.7 * BLOTCHES));
        let fine = noise(7.1 * BLOTCHES);
        let blotch = large + 0.6 * small + 0.35 * fine;
        // Bent by the blotches: smooth lines would look drawn.
        let bent = add(
            scaled(rest, VESSELS),
            [0.5 * large + 0.35 * small, 0.4 * small, 0.5 * large],
        );
        let ridge = 1.0 - (2.0 * self.mottle.at(bent) - 1.0).abs();
        let vessel = ((ridge - 0.93) / 0.07).max(0.0);
        let vessel = 0.30 * vessel * (0.5 + 2.0 * large + small).clamp(0.0, 1.0);
        let colour = [
            (1.0 + 0.16 * blotch) * (1.0 - 0.55 * vessel),
            (1.0 + 0.42 * blotch) * (1.0 - vessel),
            (1.0 + 0.36 * blotch) * (1.0 - 0.9 * vessel),
        ];
        (
            colour,
            scaled([small + fine, large + fine, small - large], BUMPS),
        )
    }
}

/// Soft tissue with a film of liquid.
fn wet(light: &Light, point: &Point, colour: V3, gloss: f32, bumps: V3) -> V3 {
    let facing = dot(point.normal, light.key);
    let lit = point.lit;
    let diffuse = [0, 1, 2].map(|axis| {
        let wrap = WRAP[axis];
        let round = ((facing + wrap) / (1.0 + wrap)).max(0.0);
        // Some red light comes through where the lamp does not reach.
        let reached = lit + 0.35 * wrap * (1.0 - lit);
        0.66 * KEY[axis] * round * reached
    });
    let body = times(colour, add(diffuse, light.around(point.normal)));
    let half = unit(add(light.key, point.to_eye));
    let shine = dot(unit(add(point.normal, bumps)), half).max(0.0);
    let rim = (1.0 - dot(point.normal, point.to_eye).clamp(0.0, 1.0)).powi(4);
    let lobe = 0.09 * shine.powi(12) + 0.20 * shine.powi(80);
    let sheen = gloss * (lobe * lit * step(facing) + 0.16 * rim * (0.5 + 0.5 * point.normal[2]));
    add(body, [sheen; 3])
}

/// A matt surface, whose colour shows a value.
fn matt(light: &Light, point: &Point, colour: V3) -> V3 {
    let facing = (0.75 * dot(point.normal, light.key) + 0.25).max(0.0);
    let amount = 0.34 + 0.46 * facing * (0.45 + 0.55 * point.lit);
    let around = light.around(point.normal);
    let light = [0, 1, 2].map(|axis| amount + 0.5 * around[axis]);
    times(colour, light)
}

/// Brushed metal. It reflects a bright room with a dark floor and a window on the lamp's side.
fn steel(light: &Light, point: &Point) -> V3 {
    let (normal, to_eye) = (point.normal, point.to_eye);
    let across = dot(normal, to_eye);
    let mirrored = sub(scaled(normal, 2.0 * across), to_eye);
    let height = smooth(-0.55, 0.8, mirrored[2]);
    let towards = dot(mirrored, light.key);
    let window = smooth(0.15, 0.62, towards) * (1.0 - 0.35 * smooth(0.62, 0.85, towards));
    let lamp = smooth(0.90, 0.99, towards);
    let rim = (1.0 - across.clamp(0.0, 1.0)).powi(3);
    let room = 0.13 + 0.26 * height + 0.40 * window + 0.18 * rim;
    let diffuse = 0.20 * dot(normal, light.key).max(0.0) * point.lit;
    let amount = room * (0.55 + 0.45 * point.lit) + 0.40 * lamp * point.lit + diffuse;
    scaled([0.93, 0.96, 1.0], amount)
}

/// A smooth step from 0 to 1 as light begins to graze a surface.
fn step(facing: f32) -> f32 {
    smooth(0.0, 0.15, facing)
}

fn smooth(from: f32, to: f32, at: f32) -> f32 {
    let share = ((at - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

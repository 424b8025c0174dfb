//! The curves of regions.

use sinew_draw::short;
use sinew_fem::homogeneous::{Axes, Curve, Load};
use sinew_fem::{Direction, Moduli, Region};
use sinew_mesh::vector::dot;
use sinew_scene::{Scene, Subject};

use super::error::LawCurvesError;
use super::measured::Measured;

/// Largest number of measured amounts of a load that are states of its curve; for more of them the curve is
/// interpolated by straight lines.
const MOST_AMOUNTS: usize = 5000;

/// Range of stretches by default.
const USUAL: [f64; 2] = [0.7, 2.0];

/// Margin around measured points, as a share of their extent.
const ROOM: f64 = 0.1;

/// The requested curves.
#[derive(Debug, Clone, PartialEq)]
pub struct AskedCurves {
    /// The number (from 1 on) or the group of the only region that is shown; `None` shows all.
    pub region: Option<String>,
    /// The axis of the pull; `None` for x, or for the direction between the fibre directions given by data of the mesh.
    pub along: Option<[f64; 3]>,
    /// The second axis of sheets and shears, made perpendicular to the first; `None` for the second of the material's
    /// axes from data of the mesh, otherwise the mesh's axis after the one nearest to the first.
    pub across: Option<[f64; 3]>,
    /// The least and the largest stretch; an amount of shear is a stretch less 1. `None`: the range of the measured
    /// points with a margin, otherwise from .7 to 2.
    pub stretch: Option<[f64; 2]>,
}

/// The curves of a region's law.
#[derive(Debug, Clone, PartialEq)]
pub struct RegionCurves {
    /// The region's number, from 1 on.
    pub number: usize,
    /// Its group; `None` for the whole mesh.
    pub group: Option<String>,
    /// Description of its law.
    pub law: String,
    /// Lame's constants (lambda, mu) (Pa) at rest, without fibres.
    pub lame: (f64, f64),
    /// True if it has fibres, which the constants at rest do not include.
    pub has_fibres: bool,
    /// Sentences about the material of the curves.
    pub notes: Vec<String>,
    /// One curve for each load.
    pub curves: Vec<Curve>,
}

/// The curves of the laws of a scene. The scene is built only if data of its mesh give a modulus.
///
/// # Errors
/// [`LawCurvesError`].
pub fn curves_of_laws(
    scene: &Scene,
    asked: &AskedCurves,
    measured: Option<&Measured>,
) -> Result<Vec<RegionCurves>, LawCurvesError> {
    let path = || scene.source().path().to_owned();
    let Subject::Body(body) = scene.subject() else {
        return Err(LawCurvesError::Oscillator { scene: path() });
    };
    let regions = &body.problem.regions;
    let is_asked = |(index, region): &(usize, &Region)| match asked.region.as_deref() {
        None => true,
        Some(name) => name == (index + 1).to_string() || region.group.as_deref() == Some(name),
    };
    let chosen: Vec<(usize, &Region)> = regions.iter().enumerate().filter(is_asked).collect();
    if let (true, Some(name)) = (chosen.is_empty(), &asked.region) {
        let known = regions.iter().enumerate();
        let known = known.map(|(index, region)| match &region.group {
            Some(group) => format!("{} (`{group}`)", index + 1),
            None => (index + 1).to_string(),
        });
        return Err(LawCurvesError::NoRegion {
            scene: path(),
            name: name.clone(),
            known: known.collect(),
        });
    }
    let between = match (asked.stretch, measured) {
        (Some(stretch), _) => stretch,
        (None, Some(measured)) => with_room(measured.stretches()),
        (None, None) => USUAL,
    };
    let needs_mesh = |(_, region): &(usize, &Region)| {
        region.from_mesh.youngs_modulus.is_some() || region.tissue.takes_data()
    };
    let mut moduli = vec![None; regions.len()];
    let mut at_place: Vec<Region> = regions.clone();
    if chosen.iter().any(needs_mesh) {
        // Springs are refused before the mesh is read.
        for (index, region) in &chosen {
            scene.solid(*index, region)?;
        }
        let simulation = scene.clone().build()?;
        let facts = simulation.model().body().map(|body| body.model.report());
        let facts = facts.into_iter().flat_map(|report| &report.regions);
        for (modulus, facts) in moduli.iter_mut().zip(facts) {
            *modulus = Some(facts.youngs_modulus);
        }
        if let Some(body) = simulation.model().body() {
            let region_of = body.model.region_of();
            for (index, region) in at_place.iter_mut().enumerate() {
                let first = region_of.iter().position(|of| *of as usize == index);
                *region = region.at_tetrahedron(&body.mesh, first.unwrap_or_default())?;
            }
        }
    }
    chosen
        .into_iter()
        .map(|(index, region)| {
            let by_data = region.tissue.takes_data();
            let stated = &at_place[index];
            let (along, second) = match (asked.along, by_data) {
                (Some(along), _) => (along, None),
                (None, true) => directions(stated),
                (None, false) => ([1.0, 0.0, 0.0], None),
            };
            let axes = match asked.across.or(second) {
                Some(second) => Axes::spanned(along, second),
                None => Axes::along(along),
            }?;
            let (region, notes) = at_a_point((region, stated), moduli[index], &axes);
            let solid = scene.solid(index, &region)?;
            let curve = |load: Load| {
                let shift = load.rest() - 1.0;
                let at = measured.map_or_else(Vec::new, |measured| measured.amounts(load));
                let at = if at.len() > MOST_AMOUNTS {
                    &[]
                } else {
                    &at[..]
                };
                solid.curve(load, &axes, between.map(|to| to + shift), at)
            };
            Ok(RegionCurves {
                number: index + 1,
                group: region.group.clone(),
                law: region.law.to_string(),
                lame: solid.lame(),
                has_fibres: !region.tissue.fibres.is_empty(),
                notes,
                curves: Load::ALL.map(curve).to_vec(),
            })
        })
        .collect()
}

/// A range widened by a margin on both sides.
fn with_room([low, high]: [f64; 2]) -> [f64; 2] {
    let room = ROOM * (high - low).max(0.01);
    // No stretch is 0.
    [(low - room).max(0.5 * low), high + room]
}

/// A region with the properties of one position if the mesh's data give them, and sentences about the material of its
/// curves. `moduli` are the least and the largest of its tetrahedra (Pa).
fn at_a_point(
    (given, stated): (&Region, &Region),
    moduli: Option<[f64; 2]>,
    axes: &Axes,
) -> (Region, Vec<String>) {
    let mut region = stated.clone();
    let mut notes = Vec::new();
    if let (Some(name), Some([least, largest])) = (&region.from_mesh.youngs_modulus, moduli) {
        notes.push(format!(
            "of the stiffest tetrahedron by the mesh's data `{name}`: E is {} to {} Pa",
            short(least),
            short(largest)
        ));
        region.law.scale_stiffness(largest);
    }
    notes.extend(region.tissue.fibres.iter().map(ToString::to_string));
    if let Some([first, second]) = &region.tissue.axes {
        notes.push(format!(
            "axes by {first} and {second}; the constants at rest are means over all directions"
        ));
    }
    if given.tissue.takes_data() {
        notes.push(
            "directions by the mesh's data are those of the region's first tetrahedron".to_owned(),
        );
    }
    if !region.tissue.fibres.is_empty() || region.law.orthotropic().is_some() {
        let [[x, y, z], [a, b, c], _] = axes.vectors().map(|axis| axis.map(short));
        notes.push(format!(
            "pulled along [{x}, {y}, {z}]; the second axis of sheets and shears is [{a}, {b}, {c}]"
        ));
    }
    if let Some(memory) = &region.tissue.memory {
        notes.push(match memory.moduli {
            Moduli::Instantaneous => {
                format!("the instantaneous curve, before anything relaxes: {memory}")
            }
            Moduli::LongTerm => format!("the long-term curve, when all has relaxed: {memory}"),
        });
    }
    (region, notes)
}

/// The direction between families of fibres, each taken in the sense that is nearest to the first; or both axes of the
/// material.
fn directions(region: &Region) -> ([f64; 3], Option<[f64; 3]>) {
    let families = region.tissue.fibres.iter().map(|family| &family.direction);
    let mut sum = [0.0; 3];
    for direction in families {
        if let Direction::Everywhere(vector) = direction {
            let length = dot(*vector, *vector).sqrt();
            let sense = if dot(sum, *vector) < 0.0 { -1.0 } else { 1.0 };
            sum = [0, 1, 2].map(|i| sum[i] + sense * vector[i] / length);
        }
    }
    match (&region.tissue.axes, sum == [0.0; 3]) {
        (Some([Direction::Everywhere(first), Direction::Everywhere(second)]), true) => {
            (*first, Some(*second))
        }
        (_, true) => ([1.0, 0.0, 0.0], None),
        (_, false) => (sum, None),
    }
}

impl RegionCurves {
    /// The region's name in reports, such as "region 1, `tissue`".
    #[must_use]
    pub fn name(&self) -> String {
        match &self.group {
            Some(group) => format!("region {}, `{group}`", self.number),
            None => format!("region {}", self.number),
        }
    }

    /// The curve of a load; `None` if absent.
    #[must_use]
    pub fn of(&self, load: Load) -> Option<&Curve> {
        self.curves.iter().find(|curve| curve.load == load)
    }
}

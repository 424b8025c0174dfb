//! Errors that an estimate of the error in space does not cover.

use serde::{Deserialize, Serialize};
use sinew_scene::{MeshSource, Simulation, Subject as SceneSubject, WarningKind};

use super::quantity::{Quantity, Subject, is_estimated};
use crate::number::{percent, three};

/// A restriction of an estimate. It prints as one sentence.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Caveat {
    /// Two meshes do not show an order.
    #[error(
        "two meshes show no order: 2 is assumed, that of linear elements where the solution is smooth (Strang and Fix, 1973); at \
         edges of supports and corners that point inwards it is 1 to 2, and the error up to 1.5 times as large; --levels 3 \
         observes it"
    )]
    OrderAssumed,
    /// Differences are too large for the series.
    #[error(
        "{}: the meshes differ by {} %, too much for a series: take the estimate as a size only",
        named(subject), percent(*difference)
    )]
    FarApart {
        /// The subject.
        subject: Subject,
        /// The largest difference (fraction).
        difference: f64,
    },
    /// Differences do not fall.
    #[error(
        "{}: the meshes do not come nearer to one another (order {}): no estimate; a point support, a point load or a stress \
         that grows without bound has no limit, and a coarse mesh does not show its order yet",
        named(subject), three(*order)
    )]
    NoLimit {
        /// The subject.
        subject: Subject,
        /// The order observed.
        order: f64,
    },
    /// The compared solutions have errors in time that are not negligible.
    #[error(
        "{}: the solutions that are compared have an error in time of {} %, which the difference between meshes may hide; a \
         shorter dt makes it smaller",
        named(subject), percent(*left)
    )]
    TimeMatters {
        /// The subject.
        subject: Subject,
        /// The error in time (fraction).
        left: f64,
    },
    /// A mesh from a file is refined within its own flat faces.
    #[error(
        "the refined mesh has the flat faces of the scene's: an error of the shape itself is not in the estimate"
    )]
    ShapeKept,
    /// A network of springs is another material on another mesh.
    #[error(
        "springs of a finer mesh are another network: the estimate includes by how much its stiffness differs, not that of \
         any network from the tissue"
    )]
    Springs,
    /// Linear tetrahedra lock.
    #[error(
        "near incompressibility linear tetrahedra reach their order on much finer meshes only: with two meshes the estimate \
         is too small; --levels 3"
    )]
    Locking,
    /// A region differs on the finer mesh.
    #[error(
        "{by}: its place takes {} of the scene's mesh and {} of a refined one: part of the difference; a named group of the mesh \
         does not change",
        hit(*from, *is_volume), hit(*to, *is_volume)
    )]
    PlaceChanged {
        /// The table of the scene.
        by: String,
        /// Area (m^2) or volume (m^3) on the scene's mesh.
        from: f64,
        /// The same on a refined one.
        to: f64,
        /// True if it is a volume.
        is_volume: bool,
    },
    /// A place of single nodes.
    #[error(
        "{by}: single nodes, whose displacement under a force or reaction has no limit on finer meshes: estimates near them are \
         void"
    )]
    PointPlace {
        /// The table of the scene.
        by: String,
    },
    /// A probe of which no error is estimated.
    #[error("`{name}` is no displacement, and its error in space is not estimated")]
    ProbeNotEstimated {
        /// The probe.
        name: String,
    },
    /// A probe outside the body.
    #[error(
        "`{name}` lies outside the body: its nearest node of the scene's mesh, {} m away, is taken on all meshes",
        three(*distance)
    )]
    ProbeOutside {
        /// The probe.
        name: String,
        /// Distance from its node (m).
        distance: f64,
    },
}

fn hit(size: f64, is_volume: bool) -> String {
    format!("{} {}", three(size), if is_volume { "m3" } else { "m2" })
}

/// Description of a subject.
fn named(subject: &Subject) -> String {
    match subject {
        Subject::Displacement => "displacement of all nodes".to_owned(),
        Subject::Probe(name) => format!("`{name}`"),
        Subject::Force(name) => format!("force on `{name}`"),
        Subject::ElasticEnergy => "elastic energy".to_owned(),
    }
}

impl Caveat {
    /// Its name for programs.
    #[must_use]
    pub fn id(&self) -> &'static str {
        match self {
            Self::OrderAssumed => "order-assumed",
            Self::FarApart { .. } => "far-apart",
            Self::NoLimit { .. } => "no-limit",
            Self::TimeMatters { .. } => "time-matters",
            Self::ShapeKept => "shape-kept",
            Self::Springs => "springs",
            Self::Locking => "locking",
            Self::PlaceChanged { .. } => "place-changed",
            Self::PointPlace { .. } => "point-place",
            Self::ProbeNotEstimated { .. } => "probe-not-estimated",
            Self::ProbeOutside { .. } => "probe-outside",
        }
    }
}

/// Difference (fraction) beyond which terms of higher order are as large.
const FAR: f64 = 0.3;

/// Share of the difference between meshes above which errors in time are not negligible.
const MATTERS: f64 = 0.3;

/// Caveats that follow from the scene.
pub(super) fn of_scene(simulation: &Simulation, levels: usize) -> Vec<Caveat> {
    let mut caveats = Vec::new();
    if levels == 2 {
        caveats.push(Caveat::OrderAssumed);
    }
    if let SceneSubject::Body(body) = simulation.scene().subject()
        && matches!(body.mesh, MeshSource::File(_))
    {
        caveats.push(Caveat::ShapeKept);
    }
    let regions = simulation.model().body();
    let mut regions = regions
        .into_iter()
        .flat_map(|body| &body.model.report().regions);
    if regions.any(|region| region.network.is_some()) {
        caveats.push(Caveat::Springs);
    }
    let probes = simulation.probes().iter();
    let left_out = probes.filter(|probe| !is_estimated(probe));
    caveats.extend(left_out.map(|probe| Caveat::ProbeNotEstimated {
        name: probe.name.clone(),
    }));
    let warnings = simulation.warnings();
    let locks = |kind: WarningKind| kind == WarningKind::Locking;
    if levels == 2 && warnings.iter().any(|warning| locks(warning.kind)) {
        caveats.push(Caveat::Locking);
    }
    caveats
}

/// The size of each part that the scene chose by position: an area (m^2), or a volume (m^3).
pub(super) fn hits(simulation: &Simulation) -> Vec<(String, f64, bool)> {
    let parts = simulation.model().body();
    let parts = parts.into_iter().flat_map(|body| &body.selected);
    let hit = parts.map(|part| match part.tets {
        Some((_, volume)) => (part.by.clone(), volume, true),
        None => (part.by.clone(), part.area, false),
    });
    hit.collect()
}

/// Caveats about regions that select other parts of finer meshes.
pub(super) fn of_places(levels: &[Vec<(String, f64, bool)>]) -> Vec<Caveat> {
    let (Some(first), Some(last)) = (levels.first(), levels.last()) else {
        return Vec::new();
    };
    let pairs = first.iter().zip(last);
    let caveat = pairs.filter_map(|((by, from, is_volume), (_, to, _))| {
        // Probes are no part of the problem.
        if by.starts_with("[[probe]]") {
            None
        } else if (from - to).abs() > 1e-6 * from {
            Some(Caveat::PlaceChanged {
                by: by.clone(),
                from: *from,
                to: *to,
                is_volume: *is_volume,
            })
        } else if *to == 0.0 {
            Some(Caveat::PointPlace { by: by.clone() })
        } else {
            None
        }
    });
    caveat.collect()
}

/// Caveats that follow from the estimates.
pub(super) fn of_estimates(quantities: &[Quantity]) -> Vec<Caveat> {
    let mut caveats: Vec<Caveat> = Vec::new();
    for quantity in quantities {
        let subject = quantity.subject.clone();
        let estimate = &quantity.estimate;
        let differences = estimate.differences.iter().copied();
        let last = differences.clone().next_back().unwrap_or(0.0);
        let difference = differences.fold(0.0, f64::max);
        let caveat = if estimate.error.is_none() {
            Caveat::NoLimit {
                subject,
                order: estimate.order,
            }
        } else if difference > FAR {
            Caveat::FarApart {
                subject,
                difference,
            }
        } else if quantity.left_in_time > MATTERS * last {
            Caveat::TimeMatters {
                subject,
                left: quantity.left_in_time,
            }
        } else {
            continue;
        };
        if !caveats.contains(&caveat) {
            caveats.push(caveat);
        }
    }
    caveats
}

//! `summary.json`: facts about a run that are known without a reference solution.

use serde_json::{Value, json};
use sinew_integrators::Stepper;
use sinew_scene::{CutTotals, Cutter, HeldPlace, RoughStrokes, SceneBody, Simulation};

use crate::fast_loads::unseen;
use crate::made_energy::{THERMAL, has_stored_energy, remedy};
use crate::progress::{Largest, Progress, Seen};
use crate::recorder::Schedules;
use crate::request::Record;
use crate::run_end::Ended;
use crate::stepping::Stepping;
use crate::tables::{column_name, table_of};

pub(crate) const NAME: &str = "summary.json";

/// Strain up to which small-strain theory is valid.
const LARGEST_STRAIN: f64 = 0.1;

/// Rotation (degrees) up to which small-strain theory is valid.
const LARGEST_ROTATION: f64 = 15.0;

/// Share of its largest kinetic energy below which a body counts as at rest.
const AT_REST: f64 = 1e-6;

/// All data of a summary.
pub(crate) struct Summary<'a> {
    pub(crate) scene: &'a Simulation,
    pub(crate) body: &'a SceneBody,
    pub(crate) record: &'a Record,
    pub(crate) ended: &'a Ended,
    pub(crate) steps: usize,
    pub(crate) stepping: &'a Stepping,
    /// Time of the last state (s).
    pub(crate) t: f64,
    pub(crate) progress: &'a Progress,
    pub(crate) schedules: &'a Schedules,
    pub(crate) parts: &'a [HeldPlace],
    pub(crate) integrator: &'a dyn Stepper,
    /// Remarks of the integrator at the end.
    pub(crate) remarks: &'a [String],
    /// Wall time (s) of this process.
    pub(crate) wall: f64,
    pub(crate) resumed: bool,
    /// Warnings about the motion itself.
    pub(crate) warnings: &'a [String],
    /// Record of the cuts, if the body may be cut.
    pub(crate) cuts: Option<&'a CutRecord>,
}

/// Cuts of a run.
#[derive(Debug, Clone)]
pub(crate) struct CutRecord {
    pub(crate) totals: CutTotals,
    /// Defects that strokes left and that are not visible in their sheets.
    rough: RoughStrokes,
    /// Description of these defects, in sentences.
    pub(crate) left: Vec<String>,
    /// Mass (kg) of the body at the beginning and at the end.
    mass: [f64; 2],
    /// Number of pieces of the body at the end.
    pub(crate) pieces: usize,
}

impl CutRecord {
    /// Record of the cuts on a body that had this mass (kg).
    pub(crate) fn of(cutter: &Cutter, mass: f64) -> Self {
        Self {
            totals: *cutter.totals(),
            rough: cutter.rough_strokes(),
            left: cutter.left_by_strokes(),
            mass: [mass, cutter.mass()],
            pieces: cutter.pieces(),
        }
    }

    fn to_json(&self) -> Value {
        let CutTotals {
            report,
            changes,
            blade_work,
            rough: _,
        } = self.totals;
        let energy = report.energy_gained;
        json!({
            "changes_of_the_body": changes,
            "area_at_rest_m2": report.area,
            "faces": report.faces,
            "new_nodes": report.new_nodes,
            "moved_nodes": report.moved_nodes,
            "mass_gained_by_moved_nodes_kg": report.mass_gained,
            "removed_tetrahedra": report.removed_tets,
            "removed_mass_kg": report.removed_mass,
            "frozen_tetrahedra": report.frozen_tets,
            "kinetic_energy_gained_J": energy.map(|energy| energy.kinetic),
            "elastic_energy_gained_J": energy.map(|energy| energy.elastic),
            "work_of_the_blade_J": blade_work,
            "left_uncut_m2": self.rough.uncut.map_or(0.0, |uncut| uncut.area),
            "chips": self.rough.chips.map_or(0, |(_, chips)| chips.count),
            "strokes_that_cut_nothing": self.rough.missed.map_or(0, |(_, missed)| missed.strokes),
            "pieces_at_the_end": self.pieces,
        })
    }
}

/// Warnings about a motion: deformations beyond small-strain theory, and bodies that pass through each other.
///
/// A rotation by an angle theta is a strain of `1 - cos theta` to the linear theory, .034 at 15 degrees; at a strain of
/// 10 % the quadratic terms that it leaves out are about as large as 10 % of those that it keeps.
pub(crate) fn warnings(seen: &Seen) -> Vec<String> {
    let mut warnings = Vec::new();
    let (strain, rotation) = (seen.linear_strain, seen.linear_rotation.value.to_degrees());
    if strain.value > LARGEST_STRAIN {
        warnings.push(format!(
            "a principal strain of {:.0} % in tetrahedron {} at t = {} s: the linear theory is off by about as much of the \
             stress; it is made for less than {:.0} %, and model = \"neo-hookean\" for more",
            100.0 * strain.value,
            strain.at,
            strain.t,
            100.0 * LARGEST_STRAIN
        ));
    }
    if rotation > LARGEST_ROTATION {
        let angle = seen.linear_rotation.value.min(std::f64::consts::PI);
        warnings.push(format!(
            "a rotation of about {rotation:.0} degrees of tetrahedron {} at t = {} s: the linear theory takes it for a strain \
             of {:.0} %; it is made for less than {LARGEST_ROTATION} degrees, and model = \"neo-hookean\" for any",
            seen.linear_rotation.at,
            seen.linear_rotation.t,
            100.0 * (1.0 - angle.cos())
        ));
    }
    if seen.inverted > 0 {
        warnings.push(format!(
            "{} tetrahedra are inside out at some instant: the motion is wrong there",
            seen.inverted
        ));
    }
    warnings.extend(seen.overlap().map(|overlap| overlap.to_string()));
    warnings
}

/// Limit of the excess energy relative to the supplied energy, at any row, and relative to the largest energy, as a
/// mean over some rows with constant loads and supports; beyond it a motion is wrong.
const MADE_ENERGY: f64 = 0.1;
const CREPT_ENERGY: f64 = 0.01;

/// A warning if a motion in large deformation, or a saturated one, has more energy than was supplied. Energy dissipated
/// by a method is not a sign of this.
pub(crate) fn made_energy(
    scene: &Simulation,
    body: &SceneBody,
    progress: &Progress,
) -> Option<String> {
    let ([most, made], given) = (progress.balance, progress.taken.given);
    let saturates = progress.work.saturated > 0;
    let is_known = (saturates || body.system().as_linear().is_none()) && !has_stored_energy(scene);
    let (is_made, crept) = (made > MADE_ENERGY * given, progress.crept.most);
    let has_crept = crept > CREPT_ENERGY * most;
    let made = if is_made { made } else { crept };
    (is_known && (is_made || has_crept) && made > THERMAL).then(|| {
        let share = match made < 100.0 * given {
            true => format!(", {:.0} %", 100.0 * made / given),
            false => String::new(),
        };
        let told = format!(
            "the motion has {made:.3e} J more than the {given:.3e} J that it was given{share}: its fastest part is wrong; {}",
            remedy(body, saturates)
        );
        unseen(body, progress.taken.span).unwrap_or(told)
    })
}

/// A warning if damping added energy to the motion, which is impossible for all damping laws here: the results are
/// wrong.
pub(crate) fn driven_by_damping(progress: &Progress) -> Option<String> {
    let driven = progress.energy.driven;
    (driven > THERMAL).then(|| {
        format!(
            "damping gave the motion {driven:.3e} J, though it can only take energy: this is an error of sinew, and the motion is wrong; \
             please report it with the scene"
        )
    })
}

impl Summary<'_> {
    pub(crate) fn to_json(&self) -> String {
        let Self {
            scene,
            body,
            record,
            progress,
            ..
        } = self;
        let (settings, seen, work) = (scene.settings(), &progress.seen, progress.work);
        let (outcome, diverged) = match self.ended {
            Ended::Finished => ("finished", Value::Null),
            Ended::Diverged { t, place } => ("diverged", json!({ "t_s": t, "at": place })),
            Ended::Refused { .. } => ("refused", Value::Null),
            Ended::Interrupted { .. } => ("interrupted", Value::Null),
        };
        let [most, last] = progress.kinetic;
        let largest = |largest: &Largest, unit: &str, at: &str, factor: f64| json!({ unit: largest.value * factor, "t_s": largest.t, at: largest.at });
        let extremes = body.model().body().map(|_| {
            json!({
                "seen": "at the instants of the fields",
                "displacement": largest(&seen.displacement, "m", "node", 1.0),
                "principal_strain": largest(&seen.strain, "1", "tetrahedron", 1.0),
                "rotation": largest(&seen.rotation, "degrees", "tetrahedron", 1f64.to_degrees()),
                "inverted_tetrahedra": seen.inverted,
            })
        });
        let regions = body.model().body().map(|body| {
            let groups = body.problem.regions.iter();
            let names =
                groups.map(|region| region.group.clone().unwrap_or_else(|| "whole body".into()));
            (1..)
                .zip(names)
                .map(|(number, name)| json!({ "region": number, "group": name }))
                .collect::<Vec<_>>()
        });
        let parts = self.parts.iter().map(
            |part| json!({ "columns": column_name(part), "by": table_of(part), "moment_about_m": part.centre }),
        );
        let tools = body.model().tools().into_iter();
        let tools = tools.flat_map(|tools| tools.tools());
        let tools = tools.map(|tool| json!({ "columns": tool.name, "nodes": tool.cells.len() }));
        let json = json!({
            "title": scene.scene().title(),
            "outcome": outcome,
            "diverged": diverged,
            "refused": match self.ended {
                Ended::Refused { t, reason } => json!({ "t_s": t, "reason": reason }),
                _ => Value::Null,
            },
            "bounded": !matches!(self.ended, Ended::Diverged { .. }),
            "guarded": work.saturated > 0,
            "saturated_share_of_velocities": work.saturated_share(self.steps, body.system().dofs()),
            "at_rest_at_the_end": last <= AT_REST * most,
            "t_s": self.t,
            "duration_s": settings.duration,
            "dt_s": self.stepping.dt(),
            "steps": self.steps,
            "integrator": self.stepping.method(),
            "options": self.stepping.options(),
            "error": "not known: `sinew plan --tolerance` measures it",
            "extremes": extremes,
            "overlap": seen.overlap().map(|overlap| json!({
                "depth_m": overlap.depth,
                "t_s": overlap.t,
                "at_m": overlap.at,
                "node": overlap.node,
                "parts": overlap.parts,
            })),
            "mass_kg": self.cuts.map(|cuts| json!({ "start": cuts.mass[0], "end": cuts.mass[1] })),
            "cuts": self.cuts.map(CutRecord::to_json),
            "work": work,
            "warnings": record.warnings.iter().chain(self.warnings).collect::<Vec<_>>(),
            "regions": regions,
            "reactions": parts.collect::<Vec<_>>(),
            "tools": tools.collect::<Vec<_>>(),
            "rows_apart_in_steps": {
                "probes": self.schedules.probes.spacing(),
                "energy_and_reactions": self.schedules.energy.spacing(),
                "fields": self.schedules.fields.map(|fields| fields.spacing()),
            },
            "repeat": record,
            "computer": {
                "wall_s": self.wall,
                "went_on_from_a_checkpoint": self.resumed,
                "computed_by": self.integrator.computed_by(),
                "remarks": self.remarks,
                "system": format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            },
        });
        format!("{json:#}\n")
    }
}

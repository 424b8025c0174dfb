//! The energy balance of a run.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sinew_core::vectors::dot;
use sinew_core::{
    Acceleration, Contact, ElasticLaw, EnergyBehaviour, Inputs, LinearOperators, LoadTime, Moment,
    Needs, Properties, Ramp, State, System,
};
use sinew_fem::Model;
use sinew_integrators::{NumericalDissipation, StepEnd, Stepper};
use sinew_scene::{SceneBody, SceneModel, Schedule, Simulation};
use sinew_tools::Tools;
use sinew_world::BodyCut;

use crate::error::RecordRunError;

/// Energies (J) of a run at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Energies {
    pub(crate) t: f64,
    /// Time (s) since the last check.
    pub(crate) span: f64,
    pub(crate) kinetic: f64,
    pub(crate) elastic: f64,
    /// Work of loads and gravity since the beginning.
    pub(crate) loads: f64,
    /// Work of supports in motion since the beginning.
    pub(crate) supports: f64,
    /// Work of tools since the beginning, if there are tools.
    pub(crate) tools: Option<f64>,
    /// Energy added by cuts since the beginning, if the body may be cut: negative for removed energy.
    pub(crate) cuts: Option<f64>,
    /// Energy that damping took since the beginning.
    pub(crate) damped: f64,
    /// Energy that the method dissipated since the beginning, if its closed form is known.
    pub(crate) method: Option<f64>,
    /// Change of energy that the entries above do not explain: energy stored and dissipated by memory (negative),
    /// energy that the method dissipates, if unknown, and errors from the distance between rows.
    pub(crate) remainder: f64,
    /// Energy supplied up to this instant: the energy at the start and the work since then.
    pub(crate) given: f64,
    /// Energy dissipated since the beginning by the method, if it is a dissipative one, or by its clamp.
    pub(crate) taken: Option<f64>,
}

/// Sums of a balance: the data that a checkpoint stores in addition to the last motion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sums {
    first: f64,
    loads: f64,
    supports: f64,
    damped: f64,
    method: f64,
    /// Work of tools' forces on the nodes: that of tools minus the dissipation by friction.
    at_contacts: f64,
    pub(crate) cuts: f64,
    /// Energy (J) that damping added, which is always an error.
    #[serde(default)]
    pub(crate) driven: f64,
}

/// Share of the energies below which a decrease of the dissipated energy is rounding.
const ROUNDING: f64 = 1e-11;

impl Sums {
    /// Adds the energy (J) that damping dissipated between two rows, of a motion with this energy (J).
    fn count_damped(&mut self, taken: f64, energy: f64) {
        self.damped += taken;
        if taken < -ROUNDING * (energy.abs() + self.damped.abs()) {
            self.driven -= taken;
        }
    }
}

/// Motion at the last row: time (s), displacement (m) and velocity (m/s) of the degrees of freedom, and the
/// acceleration (m/s^2) if the energy that the method dissipates is known.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct LastRow {
    pub(crate) t: f64,
    /// Time (s) of the row before it; its own if it is the first.
    pub(crate) before: f64,
    pub(crate) u: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) a: Vec<f64>,
    /// Internal variables, if forces on supports in motion are requested.
    pub(crate) internal: Vec<f64>,
}

/// Sums up, from row to row, the work of loads and moved supports and the dissipation by damping.
///
/// Between two rows forces are taken as the mean of both ends and velocities as `du/dt`, so that for the mean
/// acceleration method (Newmark with gamma 1/2 and beta 1/4), with a row for every step, only rounding remains, jumps
/// and kinks of loads included. Work of a support against the inertia and the damping of its own nodes is computed from
/// their kinetic energy and their dissipation, so jumps of its velocity do not matter. Part of the error remains for
/// loads that jump or have kinks together with moved supports.
pub(crate) struct Balance {
    body: Arc<SceneBody>,
    may_be_cut: bool,
    pub(crate) sums: Sums,
    pub(crate) last: Option<LastRow>,
    /// All nodes at the last row, if some are moved.
    nodes: Option<Nodes>,
    /// Closed form of the energy that the method dissipates, if known.
    form: Option<NumericalDissipation>,
    /// True if the method itself dissipates energy.
    takes_energy: bool,
    /// True if each step is checked to measure the dissipated energy.
    is_watched: bool,
    /// True if each step has a row.
    has_rows_of_steps: bool,
}

/// A row, with all nodes at its time if some are moved.
type End<'a> = (&'a LastRow, Option<&'a Nodes>);

/// Work (J) of loads and of supports, without the work against the inertia of the supports' own nodes, and energy (J)
/// taken by damping.
#[derive(Debug, Clone, Copy)]
struct Work {
    loads: f64,
    supports: f64,
    damped: f64,
}

impl Work {
    /// Work over an interval, improved by that over its two halves: the error falls as the square of the length
    /// (Richardson extrapolation).
    fn extrapolated(self, [first, second]: [Self; 2]) -> Self {
        let better = |part: fn(&Self) -> f64| {
            let halves = part(&first) + part(&second);
            halves + (halves - part(&self)) / 3.0
        };
        Self {
            loads: better(|work| work.loads),
            supports: better(|work| work.supports),
            damped: better(|work| work.damped),
        }
    }

    fn is_finite(&self) -> bool {
        [self.loads, self.supports, self.damped]
            .iter()
            .all(|work| work.is_finite())
    }
}

/// The motion halfway between two rows, from the cubic curve through their displacements and velocities.
fn half_way([last, here]: [&LastRow; 2]) -> LastRow {
    let span = here.t - last.t;
    let mean = |[a, b]: [&[f64]; 2]| -> Vec<f64> {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| 0.5 * (a + b)).collect()
    };
    let mut u = mean([&last.u, &here.u]);
    for (u, (before, after)) in u.iter_mut().zip(last.v.iter().zip(&here.v)) {
        *u += span / 8.0 * (before - after);
    }
    let ends = here.u.iter().zip(&last.u).zip(last.v.iter().zip(&here.v));
    let speed = |((after, before), (v_before, v_after)): ((&f64, &f64), (&f64, &f64))| {
        1.5 * (after - before) / span - 0.25 * (v_before + v_after)
    };
    LastRow {
        t: 0.5 * (last.t + here.t),
        before: last.t,
        u,
        v: ends.map(speed).collect(),
        a: Vec::new(),
        internal: mean([&last.internal, &here.internal]),
    }
}

/// Displacements (m) of all nodes, fixed and moved ones included, and the forces (N) that do work on them.
struct Nodes {
    u: Vec<f64>,
    loads: Vec<f64>,
    /// Forces of supports and moved parts, which balance the elastic forces of the body.
    supports: Vec<f64>,
    /// Kinetic energy (J) of all nodes, and of the components that are moved.
    kinetic: [f64; 2],
}

impl Balance {
    /// Begins with rows at these steps of the method; `None` for several methods, or steps of several lengths.
    pub(crate) fn new(
        scene: &Simulation,
        body: &Arc<SceneBody>,
        method: Option<&dyn Stepper>,
        rows: Schedule,
    ) -> Self {
        let mut balance = Self {
            body: Arc::clone(body),
            may_be_cut: scene.is_cut(),
            sums: Sums::default(),
            last: None,
            nodes: None,
            form: None,
            takes_energy: false,
            is_watched: false,
            has_rows_of_steps: rows.is_every_step(),
        };
        // Beside steps that are sweeps, a check of each of them costs too much where rows are rare for that reason.
        balance.takes_energy = method.is_some_and(|method| takes_energy(method, body.system()));
        balance.is_watched = balance.takes_energy
            && !balance.has_memory()
            && (rows.is_every_step() || method.is_some_and(|method| !is_program(method)));
        // The form is that of one step of free degrees of freedom.
        if !balance.may_be_cut
            && rows.is_every_step()
            && balance.moved_body().is_none()
            && balance.operators().is_some()
        {
            balance.form = method.and_then(Stepper::numerical_dissipation);
        }
        balance
    }

    /// True if stress relaxes: energy stored and energy dissipated by memory are not separated, and are part of the
    /// remainder.
    pub(crate) fn has_memory(&self) -> bool {
        self.body.system().internal_variables() > 0
    }

    /// True if the scene has tools.
    pub(crate) fn has_tools(&self) -> bool {
        self.tools().is_some()
    }

    /// True if the body may be cut.
    pub(crate) fn has_cuts(&self) -> bool {
        self.may_be_cut
    }

    fn tools(&self) -> Option<&Tools> {
        self.body.model().tools().map(|tools| &**tools)
    }

    /// True if the energy that the method dissipates is known in closed form.
    pub(crate) fn knows_method(&self) -> bool {
        self.form.is_some()
    }

    /// True if each step is checked, even if no row is due.
    pub(crate) fn looks_at_every_step(&self) -> bool {
        self.is_watched
    }

    fn sees_steps(&self) -> bool {
        self.is_watched || self.has_rows_of_steps
    }

    /// True if missing energy can be attributed to the method or its clamp: the body has no memory, and friction at
    /// tools is known, since every step is checked.
    fn tells_taken(&self, moment: &Moment<'_>) -> bool {
        (self.takes_energy || moment.work.saturated > 0)
            && !self.has_memory()
            && (self.sees_steps() || !self.has_tools())
    }

    /// Continues after a row that was written by an earlier run.
    pub(crate) fn resumed(mut self, sums: Sums, last: LastRow) -> Result<Self, RecordRunError> {
        self.sums = sums;
        self.nodes = self.nodes(&last, Inputs::none())?;
        self.last = Some(last);
        Ok(self)
    }

    /// Continues with loads that follow inputs, which does not change forces yet.
    pub(crate) fn change_loads(&mut self, body: &Arc<SceneBody>) {
        self.body = Arc::clone(body);
    }

    /// Continues on a body that was cut.
    pub(crate) fn change_body(
        &mut self,
        body: &Arc<SceneBody>,
        cut: &BodyCut,
    ) -> Result<(), RecordRunError> {
        self.body = Arc::clone(body);
        self.sums.cuts += cut.energy;
        let state = &cut.after;
        let t = state.t();
        let mut v = vec![0.0; state.u.len()];
        state.velocity_at_t(self.body.system(), Inputs::none(), &mut v)?;
        let internal = match self.moved_body() {
            Some(_) => state.internal.clone(),
            None => Vec::new(),
        };
        let row = LastRow {
            t,
            before: t,
            u: state.u.clone(),
            v,
            a: Vec::new(),
            internal,
        };
        self.nodes = self.nodes(&row, Inputs::none())?;
        self.last = Some(row);
        Ok(())
    }

    fn operators(&self) -> Option<&LinearOperators> {
        Some(self.body.system().as_linear()?.operators())
    }

    /// The body, if parts of it are moved.
    fn moved_body(&self) -> Option<&Model> {
        let body = self.body.model().body()?;
        (!body.problem.moves.is_empty()).then_some(&body.model)
    }

    /// Adds the next row, with the velocity `v` (m/s) at its time.
    pub(crate) fn row(
        &mut self,
        moment: &Moment<'_>,
        v: &[f64],
    ) -> Result<Energies, RecordRunError> {
        let t = moment.state.t();
        let here = LastRow {
            t,
            before: self.last.as_ref().map_or(t, |last| last.t),
            u: moment.state.u.clone(),
            v: v.to_vec(),
            a: self.acceleration(moment, v)?,
            internal: match self.moved_body() {
                Some(_) => moment.state.internal.clone(),
                None => Vec::new(),
            },
        };
        let inputs = moment.inputs;
        let span = here.t - here.before;
        let nodes = self.nodes(&here, inputs)?;
        let (kinetic, elastic) = self.stored(&here, nodes.as_ref())?;
        let mut taken = 0.0;
        if let Some(last) = &self.last {
            let ends = [(last, self.nodes.as_ref()), (&here, nodes.as_ref())];
            let work = self.work_between(ends, moment)?;
            self.sums.loads += work.loads;
            self.sums.supports += work.supports;
            taken = work.damped;
            if let [(_, Some(before)), (_, Some(after))] = ends {
                self.sums.supports += after.kinetic[1] - before.kinetic[1];
            } else {
                self.sums.method += self.taken_by_method(last, &here, inputs);
            }
            self.sums.at_contacts += self.work_at_contacts(moment.state, last, &here);
        } else {
            self.sums.first = kinetic + elastic;
        }
        self.sums.count_damped(taken, kinetic + elastic);
        self.nodes = nodes;
        self.last = Some(here);
        let Sums {
            first,
            loads,
            supports,
            damped,
            method,
            at_contacts,
            cuts,
            ..
        } = self.sums;
        let tools = self.tools().map(|tools| tools.work(moment.state));
        let given = first + loads + supports + tools.unwrap_or(0.0) + cuts;
        let remainder = kinetic + elastic - given + damped + method;
        let by_friction = tools.map_or(0.0, |tools| tools - at_contacts);
        Ok(Energies {
            t,
            span,
            kinetic,
            elastic,
            loads,
            supports,
            tools,
            cuts: self.has_cuts().then_some(cuts),
            damped,
            method: self.form.map(|_| method),
            remainder,
            given,
            taken: self
                .tells_taken(moment)
                .then_some(method - remainder - by_friction),
        })
    }

    /// Work of loads, supports and damping between two rows.
    ///
    /// If the rows are one step apart and that step was divided into substeps, the work over both halves is computed
    /// too, with the motion halfway, and the leading error of the means, which falls by a factor of four, is removed.
    fn work_between(
        &self,
        ends: [End<'_>; 2],
        moment: &Moment<'_>,
    ) -> Result<Work, RecordRunError> {
        let inputs = moment.inputs;
        let whole = self.work_of_means(ends, inputs)?;
        let [(last, _), (here, _)] = ends;
        if !self.is_of_parts(here.t - last.t, moment.state) {
            return Ok(whole);
        }
        let middle = half_way([last, here]);
        // The motion half way is an estimate: where a law has no meaning there, the means are what is known.
        let halves = self
            .nodes(&middle, inputs)
            .and_then(|nodes| {
                let middle = (&middle, nodes.as_ref());
                let first = self.work_of_means([ends[0], middle], inputs)?;
                Ok([first, self.work_of_means([middle, ends[1]], inputs)?])
            })
            .ok();
        let better = halves.map(|halves| whole.extrapolated(halves));
        Ok(better.filter(Work::is_finite).unwrap_or(whole))
    }

    /// True if the step between two rows that are `span` (s) apart was divided into substeps.
    fn is_of_parts(&self, span: f64, state: &State) -> bool {
        let part = state.clock.last_step();
        self.has_rows_of_steps && part.is_some_and(|part| part < 0.75 * span)
    }

    /// Work of loads, supports and damping between two instants, with the mean of the forces at both.
    fn work_of_means(
        &self,
        [(last, before), (here, after)]: [End<'_>; 2],
        inputs: &Inputs,
    ) -> Result<Work, RecordRunError> {
        if let (Some(before), Some(after)) = (before, after) {
            let ends = [&before.u[..], &after.u];
            return Ok(Work {
                loads: work([&before.loads, &after.loads], ends),
                supports: work([&before.supports, &after.supports], ends)
                    + self.damping_of_supports([last, here], ends, inputs)?,
                damped: self.damped([last, here], Some(ends))?,
            });
        }
        let (before, after) = self.loads_at_ends(last, here, inputs);
        Ok(Work {
            loads: work([&before, &after], [&last.u, &here.u]),
            supports: 0.0,
            damped: self.damped([last, here], None)?,
        })
    }

    /// True if a load or a support changed, or may have changed, between the last two rows.
    pub(crate) fn has_changed(&self) -> bool {
        let (Some(body), Some(last)) = (self.body.model().body(), &self.last) else {
            return true;
        };
        let law = self.body.system().as_elastic();
        let loads = body.problem.loads.iter().map(|load| &load.ramp);
        let courses = body.problem.moves.iter().flat_map(|moving| &moving.courses);
        let mut ramps = loads.chain(courses.map(|course| &course.ramp));
        let (from, to) = (last.before, last.t);
        let rests = |ramp: &Ramp| {
            !ramp.is_input()
                && ramp.is_constant_between(from, to)
                && ramp.breakpoint_between(from, to).is_none()
        };
        law.is_none_or(ElasticLaw::loads_follow) || !ramps.all(rests)
    }

    /// The acceleration that the method stores, if it is needed; before the first step the consistent one.
    fn acceleration(&self, moment: &Moment<'_>, v: &[f64]) -> Result<Vec<f64>, RecordRunError> {
        if self.form.is_none() {
            return Ok(Vec::new());
        }
        if moment.state.acceleration == Acceleration::Same {
            return Ok(moment.state.a.clone());
        }
        let mut a = vec![0.0; v.len()];
        moment.acceleration(v, &mut a)?;
        Ok(a)
    }

    /// The energy (J) that the method dissipates in a step between two rows; 0 if that is unknown.
    fn taken_by_method(&self, last: &LastRow, here: &LastRow, inputs: &Inputs) -> f64 {
        let (Some(form), Some(operators)) = (self.form, self.operators()) else {
            return 0.0;
        };
        let dt = here.t - last.t;
        let [before, after] = form
            .loads_at_ends(last.t, dt)
            .map(|when| self.loads_at(when.under(inputs), &here.u));
        // The step begins with the acceleration of the last one and what the loads are other than at the end of that.
        let known = match last.before < last.t {
            true => {
                let [_, end] = form.loads_at_ends(last.before, last.t - last.before);
                self.loads_at(end.under(inputs), &last.u)
            }
            false => self.loads_at(LoadTime::at(last.t).under(inputs), &last.u),
        };
        let change = before.iter().zip(&known).zip(operators.mass());
        let change = change.map(|((load, known), mass)| (load - known) / mass);
        let a: Vec<f64> = last.a.iter().zip(change).map(|(a, b)| a + b).collect();
        let first = StepEnd {
            u: &last.u,
            v: &last.v,
            a: &a,
            load: &before,
        };
        let last = StepEnd {
            u: &here.u,
            v: &here.v,
            a: &here.a,
            load: &after,
        };
        form.taken(operators, dt, [first, last])
    }

    /// The work (J) of tools' forces on the nodes in the step between two rows, if requested.
    fn work_at_contacts(&self, state: &State, last: &LastRow, here: &LastRow) -> f64 {
        let Some(tools) = self.tools().filter(|_| self.sees_steps()) else {
            return 0.0;
        };
        let mut forces = vec![0.0; here.u.len()];
        tools.add_forces(state, false, &mut forces);
        work([&forces, &forces], [&last.u, &here.u])
    }

    /// Loads (N) on the degrees of freedom at two rows. Their mean gives the impulse of the loads between the rows,
    /// jumps included.
    fn loads_at_ends(
        &self,
        last: &LastRow,
        here: &LastRow,
        inputs: &Inputs,
    ) -> (Vec<f64>, Vec<f64>) {
        let ends = LoadTime::at_both_ends(last.t, here.t - last.t, 0.5);
        let [from, to] = ends.map(|when| when.under(inputs));
        (self.loads_at(from, &last.u), self.loads_at(to, &here.u))
    }

    fn loads_at(&self, when: LoadTime<'_>, u: &[f64]) -> Vec<f64> {
        let system = self.body.system();
        let mut loads = vec![0.0; system.dofs()];
        system.external_force(when, u, &mut loads);
        loads
    }

    /// All nodes at a row, if some are moved.
    fn nodes(&self, row: &LastRow, inputs: &Inputs) -> Result<Option<Nodes>, RecordRunError> {
        let Some(model) = self.moved_body() else {
            return Ok(None);
        };
        let mut u = vec![[0.0; 3]; model.mesh().points.len()];
        let still = u.clone();
        let (mut v, mut loads, mut supports) = (u.clone(), u.clone(), u.clone());
        let when = LoadTime::at(row.t).under(inputs);
        model.displacements_at(when, &row.u, &mut u)?;
        model.velocities_at(when, &row.v, &mut v)?;
        model.load_forces(when, &u, &mut loads)?;
        let body = model.with_memory(&row.internal);
        body.moving_reactions(when, [&u, &still, &still], &mut supports)?;
        let mut kinetic = [0.0; 2];
        for (node, (v, mass)) in (0..).zip(v.iter().zip(model.node_masses())) {
            for (axis, v) in v.iter().enumerate() {
                let energy = 0.5 * mass * v * v;
                kinetic[0] += energy;
                if !moves_by_itself(model, node, axis) {
                    kinetic[1] += energy;
                }
            }
        }
        Ok(Some(Nodes {
            u: u.into_flattened(),
            loads: loads.into_flattened(),
            supports: supports.into_flattened(),
            kinetic,
        }))
    }

    /// Kinetic and elastic energy.
    fn stored(&self, row: &LastRow, nodes: Option<&Nodes>) -> Result<(f64, f64), RecordRunError> {
        let (Some(model), Some(nodes)) = (self.moved_body(), nodes) else {
            let energy = match self.body.model() {
                SceneModel::Body(_) => self.body.system().energy(&row.u, &row.v),
                SceneModel::Oscillator(_) => self
                    .operators()
                    .map(|operators| operators.energy(&row.u, &row.v)),
            };
            return Ok(energy.map_or((f64::NAN, f64::NAN), |energy| {
                (energy.kinetic, energy.elastic)
            }));
        };
        let elastic = model.elastic_energy(nodes.u.as_chunks::<3>().0)?;
        Ok((nodes.kinetic[0], elastic))
    }

    /// Work (J) of supports against damping at the components that they move, between two rows with these displacements
    /// (m) of all nodes: `w_p' (D w)_p dt` with `w = du/dt`.
    fn damping_of_supports(
        &self,
        [last, here]: [&LastRow; 2],
        [before, after]: [&[f64]; 2],
        inputs: &Inputs,
    ) -> Result<f64, RecordRunError> {
        let span = here.t - last.t;
        let Some(model) = self.moved_body() else {
            return Ok(0.0);
        };
        let damping = self.body.system().as_elastic();
        let is_damped = damping.map(ElasticLaw::damping).is_some_and(|damping| {
            damping.mass != 0.0 || damping.stiffness != 0.0 || damping.extra.is_some()
        });
        if !is_damped || span <= 0.0 {
            return Ok(0.0);
        }
        let ends = || before.iter().zip(after);
        let middle: Vec<f64> = ends().map(|(a, b)| 0.5 * (a + b)).collect();
        let w: Vec<f64> = ends().map(|(a, b)| (b - a) / span).collect();
        let [middle, w] = [&middle, &w].map(|field| field.as_chunks::<3>().0);
        let still = vec![[0.0; 3]; w.len()];
        let when = LoadTime::at(here.t).under(inputs);
        let forces = |v: &[[f64; 3]]| -> Result<Vec<[f64; 3]>, RecordRunError> {
            let mut out = still.clone();
            model.moving_reactions(when, [middle, v, &still], &mut out)?;
            Ok(out)
        };
        // At rest they are the loads, and what the body holds.
        let (moving, resting) = (forces(w)?, forces(&still)?);
        let (moving, resting) = (moving.as_flattened(), resting.as_flattened());
        let terms = w.as_flattened().iter().zip(moving.iter().zip(resting));
        Ok(span
            * terms
                .map(|(w, (moving, resting))| w * (moving - resting))
                .sum::<f64>())
    }

    /// Energy (J) that damping dissipates between two rows: `w' D w dt` with `w = du/dt`, and D halfway between them.
    /// For a body with moved parts all nodes count, with these displacements (m).
    fn damped(
        &self,
        [last, here]: [&LastRow; 2],
        nodes: Option<[&[f64]; 2]>,
    ) -> Result<f64, RecordRunError> {
        let (span, system) = (here.t - last.t, self.body.system());
        let Some(damping) = system.as_elastic().map(ElasticLaw::damping) else {
            return Ok(0.0);
        };
        if span <= 0.0
            || (damping.mass == 0.0 && damping.stiffness == 0.0 && damping.extra.is_none())
        {
            return Ok(0.0);
        }
        let rate = |[before, after]: [&[f64]; 2]| -> Vec<f64> {
            let ends = after.iter().zip(before);
            ends.map(|(after, before)| (after - before) / span)
                .collect()
        };
        let own = [&last.u[..], &here.u];
        if let (None, Some(operators)) = (nodes, self.operators()) {
            let (w, mut force) = (rate(own), vec![0.0; system.dofs()]);
            operators.subtract_damping(&w, &mut force);
            return Ok(-span * dot(&force, &w));
        }
        let Some(body) = self.body.model().body() else {
            return Ok(0.0);
        };
        let of_body = |row: &LastRow| -> Result<Vec<f64>, RecordRunError> {
            let mut u = vec![[0.0; 3]; body.model.mesh().points.len()];
            body.model
                .displacements_at(LoadTime::at(row.t), &row.u, &mut u)?;
            Ok(u.into_flattened())
        };
        let found;
        let ends = match nodes {
            Some(ends) => ends,
            None => {
                found = [of_body(last)?, of_body(here)?];
                [&found[0][..], &found[1]]
            }
        };
        let w = rate(ends);
        let [before, after] = ends;
        let middle = before.iter().zip(after).map(|(a, b)| 0.5 * (a + b));
        let middle: Vec<f64> = middle.collect();
        let motion = [&middle, &w].map(|field| field.as_chunks::<3>().0);
        Ok(span * body.model.damping_power(motion)?)
    }
}

/// True if a method itself dissipates energy of an undamped motion. Energy properties of methods that solve equations
/// hold for linear equations only.
fn takes_energy(method: &dyn Stepper, system: &dyn System) -> bool {
    let Properties { energy, needs, .. } = method.properties();
    let falls = matches!(energy, EnergyBehaviour::Falls | EnergyBehaviour::NeverRises);
    falls || (needs == Needs::Tangents && system.as_linear().is_none())
}

/// True if the steps of a method run as a program of the machine.
fn is_program(method: &dyn Stepper) -> bool {
    sinew_integrators::entry(method.id()).is_some_and(|entry| entry.programs)
}

/// True if a component of a node is a degree of freedom.
fn moves_by_itself(model: &Model, node: u32, axis: usize) -> bool {
    let dof = |cell: u32| 3 * cell as usize + axis;
    model
        .cell_of_node(node)
        .is_some_and(|cell| !model.pinned()[dof(cell)])
}

/// Work (J) between two rows of forces (N) that are linear in the displacement (m) between them.
fn work([before, after]: [&[f64]; 2], [u_before, u_after]: [&[f64]; 2]) -> f64 {
    let forces = before.iter().zip(after);
    let moved = u_before.iter().zip(u_after);
    let terms = forces.zip(moved);
    terms
        .map(|((before, after), (u_before, u_after))| 0.5 * (before + after) * (u_after - u_before))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damping_that_gives_energy_is_found_and_rounding_is_not() {
        let mut sums = Sums::default();
        sums.count_damped(1.0, 5.0);
        sums.count_damped(-1e-12, 5.0);
        assert_eq!(sums.driven, 0.0);
        sums.count_damped(-1e-6, 5.0);
        assert!((sums.driven - 1e-6).abs() < 1e-12, "{sums:?}");
    }
}

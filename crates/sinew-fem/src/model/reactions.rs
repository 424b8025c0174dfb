//! Forces of the supports on a body.

use sinew_core::{LoadTime, Ramp, State};

use super::Model;
use super::field_error::{FieldError, require_inputs};
use crate::On;
use crate::border::Border;
use crate::large::{Past, Wanted, fill};
use crate::motion::Field;

impl Model {
    /// Nodes (0-based) that are fixed or moved in some direction, increasing.
    #[must_use]
    pub fn held_nodes(&self) -> &[u32] {
        &self.body.cells.held_nodes
    }

    /// Lumped mass of each node of the mesh (kg), fixed ones included.
    #[must_use]
    pub fn node_masses(&self) -> &[f64] {
        &self.masses
    }

    /// Writes the force (N) of the supports on the body at each node of the mesh, at a time (s), with displacement `u`
    /// (m) and velocity `v` (m/s) at that time (see [`sinew_core::State::velocity_at_t`]); zero in free components. For
    /// a state of a run with stiffness damping see [`Model::reactions_in`].
    ///
    /// At each fixed or moved component p it is `M_p (a_p + alpha v_p) + (K u + D v)_p - F_p(t)`: the force of its
    /// prescribed motion, the pull of all other components, less the model's own loads on p, so that all reactions
    /// together are minus all loads if nothing moves. A change of velocity at an instant, as at a row of a table, needs
    /// an impulse, which is a force only with respect to a time interval: [`LoadTime::around`] gives this interval, two
    /// steps of a run or the distances to the rows before and after. `a_p` is then the mean over it. Loads that were
    /// given to the system in other ways are not included; add those of [`NodalForces::dropped`](super::NodalForces) to
    /// the result.
    ///
    /// The first call sums up the rows of the fixed nodes; later ones allocate only a few numbers for each prescribed
    /// motion beyond the eighth, and with hyperelastic regions one vector over the nodes.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `u` and `v` have one entry for each degree of freedom and `out` one for each node
    /// of the mesh, and [`FieldError::NoInput`] if a motion, or a load on fixed components, follows an input that the
    /// time does not contain.
    pub fn reactions<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        v: &[f64],
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        let when = when.into();
        let damped = Damped::at(when, u, v);
        self.reactions_after((when, Past::RELAXED), u, damped, out)
    }

    /// Writes the forces (N) of [`Model::reactions`] in a state, with its internal variables, and with the damping
    /// velocities of the method that led to it ([`State::damping`]): they balance the method's own forces on the
    /// degrees of freedom with all loads and inertia.
    ///
    /// # Errors
    /// Same as [`Model::reactions`].
    pub fn reactions_in<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        state: &State,
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        let when = when.into();
        let past = Past {
            internal: &state.internal,
            dt: 0.0,
        };
        let (u, v, at) = state.damping();
        let damped = Damped {
            when: at.under(when.inputs()),
            u: &u,
            v: &v,
        };
        self.reactions_after((when, past), &state.u, damped, out)
    }

    fn reactions_after(
        &self,
        at: (LoadTime<'_>, Past<'_>),
        u: &[f64],
        damped: Damped<'_>,
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        self.require_dofs("the displacement", u)?;
        self.require_dofs("the velocity", damped.v)?;
        self.require_nodes("the output", out)?;
        let force = self.forces_in_motion(at, u, damped)?;
        self.held_forces(at.0, force, out);
        Ok(())
    }

    /// The force (N) of the supports on the body at all nodes of a part of the mesh together, see [`Model::reactions`].
    /// Nodes that are neither fixed nor moved add nothing. Searches the nodes on each call: for calls in every frame,
    /// use [`On::nodes`] once and then [`Model::reaction_of_nodes`].
    ///
    /// # Errors
    /// Same as [`Model::reactions`], and [`FieldError::Place`] if the mesh has no such part.
    pub fn reaction<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        v: &[f64],
        on: &On,
    ) -> Result<[f64; 3], FieldError> {
        let nodes = on.nodes(&self.mesh)?;
        self.reaction_of_nodes(when, u, v, &nodes)
    }

    /// The force (N) of the supports on the body at some nodes (0-based) together, each as often as it is
    /// named, see [`Model::reactions`].
    ///
    /// # Errors
    /// Same as [`Model::reaction`].
    pub fn reaction_of_nodes<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        v: &[f64],
        nodes: &[u32],
    ) -> Result<[f64; 3], FieldError> {
        self.require_dofs("the displacement", u)?;
        self.require_dofs("the velocity", v)?;
        let when = when.into();
        let damped = Damped::at(when, u, v);
        let force_in_motion = self.forces_in_motion((when, Past::RELAXED), u, damped)?;
        let mut sum = [0.0; 3];
        for &node in nodes {
            self.require_node(node)?;
            let mut force = force_in_motion(node);
            for load in &self.supports.loads {
                if let Ok(at) = load.forces.binary_search_by_key(&node, |(node, _)| *node) {
                    subtract(&mut force, value(&load.ramp, when), &load.forces[at].1);
                }
            }
            subtract(&mut sum, -1.0, &self.held_part(node, force));
        }
        Ok(sum)
    }

    /// Writes the force (N) of supports that move in any way. `motion` has the displacement (m), velocity
    /// (m/s) and acceleration (m/s^2) of all nodes of the mesh, fixed or not. At each fixed component p the
    /// force is `M_p (a_p + alpha v_p) + K_p u + D_p v - F_p(t)`, alpha M being the mass damping and D all
    /// other damping. Motions that the problem prescribes are those of [`Model::reactions`].
    ///
    /// # Errors
    /// [`FieldError::Length`] unless all have one entry for each node of the mesh, and [`FieldError::NoInput`] if a
    /// load on fixed components follows an input that the time does not contain.
    pub fn moving_reactions<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        motion: [&[[f64; 3]]; 3],
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        self.moving_reactions_after(Past::RELAXED, when.into(), motion, out)
    }

    pub(super) fn moving_reactions_after(
        &self,
        past: Past<'_>,
        when: LoadTime<'_>,
        motion: [&[[f64; 3]]; 3],
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        let names = ["the displacement", "the velocity", "the acceleration"];
        for (what, field) in names.into_iter().zip(motion) {
            self.require_nodes(what, field)?;
        }
        self.require_nodes("the output", out)?;
        self.require_held_inputs(when)?;
        let [u, v, a] = motion.map(|field| move |node: u32| field[node as usize]);
        self.held_forces(when, self.row_forces((when, past), u, (u, v), a), out);
        Ok(())
    }

    fn require_held_inputs(&self, when: LoadTime<'_>) -> Result<(), FieldError> {
        let ramps = self.supports.loads.iter().map(|load| &load.ramp);
        require_inputs(ramps, when.inputs())
    }

    /// The result of `row_forces` with the prescribed motion.
    fn forces_in_motion<'a>(
        &'a self,
        (when, past): (LoadTime<'a>, Past<'a>),
        u: &'a [f64],
        damped: Damped<'a>,
    ) -> Result<impl Fn(u32) -> [f64; 3] + 'a, FieldError> {
        self.require_held_inputs(when)?;
        Ok(self.row_forces(
            (when, past),
            self.at_nodes(when, Field::Displacement, Some(u))?,
            (
                self.at_nodes(damped.when, Field::Displacement, Some(damped.u))?,
                self.at_nodes(damped.when, Field::Velocity, Some(damped.v))?,
            ),
            self.at_nodes(when, Field::Acceleration, None)?,
        ))
    }

    pub(super) fn border(&self) -> &Border {
        self.supports.border(self.parts(), self.held_nodes())
    }

    /// M (a + alpha v) + K u + D v (N) at a fixed node, D being the damping other than alpha M, evaluated at its
    /// displacement; less the forces of follower pressures beyond those on the surface at rest.
    fn row_forces(
        &self,
        at: (LoadTime<'_>, Past<'_>),
        u: impl Fn(u32) -> [f64; 3],
        (damped_u, v): (impl Fn(u32) -> [f64; 3], impl Fn(u32) -> [f64; 3]),
        a: impl Fn(u32) -> [f64; 3],
    ) -> impl Fn(u32) -> [f64; 3] {
        let damping = self.operators.damping();
        let (alpha, beta, border) = (damping.mass, damping.stiffness, self.border());
        let large = self.large_forces(at, beta, &u, (damped_u, &v));
        move |node| {
            let mut force = border.internal_force(node, beta, &u, &v);
            if let Some(large) = &large {
                subtract(&mut force, -1.0, &large[node as usize]);
            }
            let mass = self.masses[node as usize];
            subtract(&mut force, -mass, &a(node));
            subtract(&mut force, -mass * alpha, &v(node));
            force
        }
    }

    /// The forces (N) of hyperelastic regions at all nodes, with their stiffness damping and follower pressures; NaN
    /// outside a law's domain, and `None` without such regions.
    fn large_forces(
        &self,
        (when, past): (LoadTime<'_>, Past<'_>),
        beta: f64,
        u: impl Fn(u32) -> [f64; 3],
        (damped_u, v): (impl Fn(u32) -> [f64; 3], impl Fn(u32) -> [f64; 3]),
    ) -> Option<Vec<[f64; 3]>> {
        let large = self.large.as_ref()?;
        let mut forces = vec![[0.0; 3]; self.mesh.points.len()];
        let evaluated = large.with_scratch(|scratch| {
            fill(&mut scratch.displacement, &u);
            large.evaluate(scratch, past, false)?;
            large.at_nodes(scratch, |node, force| {
                subtract(&mut forces[node as usize], -1.0, &force);
            });
            if beta != 0.0 {
                fill(&mut scratch.displacement, &damped_u);
                fill(&mut scratch.change, &v);
                large.product(scratch, past, Wanted::Viscosity)?;
                large.at_nodes(scratch, |node, force| {
                    subtract(&mut forces[node as usize], -beta, &force);
                });
            }
            Ok::<(), sinew_core::EvaluationError>(())
        });
        if evaluated.is_err() {
            forces.fill([f64::NAN; 3]);
        }
        // Forces at the instant: the window is that of accelerations.
        let now = LoadTime::at(when.t()).under(when.inputs());
        for pressure in &*self.following {
            pressure.forces(pressure.factor(now), &u, |node, force| {
                subtract(&mut forces[node as usize], 1.0, &force);
            });
        }
        Some(forces)
    }

    fn held_forces(
        &self,
        when: LoadTime<'_>,
        force: impl Fn(u32) -> [f64; 3],
        out: &mut [[f64; 3]],
    ) {
        out.fill([0.0; 3]);
        for &node in self.held_nodes() {
            out[node as usize] = self.held_part(node, force(node));
        }
        for load in &self.supports.loads {
            let factor = value(&load.ramp, when);
            for (node, force) in &load.forces {
                subtract(&mut out[*node as usize], factor, force);
            }
        }
    }

    /// The force in fixed components; zero in free ones.
    pub(super) fn held_part(&self, node: u32, force: [f64; 3]) -> [f64; 3] {
        let cells = &self.body.cells;
        std::array::from_fn(|axis| match cells.free_dof(node, axis) {
            Some(_) => 0.0,
            None => force[axis],
        })
    }
}

/// The motion that determines damping: displacement (m) and velocity (m/s) of the degrees of freedom, and the time of
/// the supports' velocity.
struct Damped<'a> {
    when: LoadTime<'a>,
    u: &'a [f64],
    v: &'a [f64],
}

impl<'a> Damped<'a> {
    /// A motion with the velocity at the displacement's time.
    fn at(when: LoadTime<'a>, u: &'a [f64], v: &'a [f64]) -> Self {
        let when = centred(when);
        Self { when, u, v }
    }
}

/// The time with a window of equal length on both sides: at a kink in its middle the velocity is the mean of both
/// sides; if there is one side only, as at the start, it is that of the instant.
fn centred(when: LoadTime<'_>) -> LoadTime<'_> {
    let ((from, to), t) = (when.span(), when.t());
    let half = (t - from).min(to - t);
    let centred = match half > 0.0 {
        true => LoadTime::around(t, half, half),
        false => LoadTime::at(t),
    };
    centred.under(when.inputs())
}

/// The factor at an instant.
fn value(ramp: &Ramp, when: LoadTime<'_>) -> f64 {
    ramp.known(when.inputs()).value(when.t())
}

fn subtract(sum: &mut [f64; 3], factor: f64, force: &[f64; 3]) {
    for (sum, force) in sum.iter_mut().zip(force) {
        *sum -= factor * force;
    }
}

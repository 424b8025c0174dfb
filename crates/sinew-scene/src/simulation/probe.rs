//! Probes: the degrees of freedom that are recorded.

use sinew_fem::Course;

use super::model::BodyModel;
use crate::error::{Fault, SceneError};
use crate::scene::{Places, ProbeAt, ProbePoint};

/// A node, or the mass of an oscillator, whose motion is recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Its name.
    pub name: String,
    /// Its node; `None` for an oscillator.
    pub node: Option<NearestNode>,
    /// Its degrees of freedom: along x, y and z for a node, one for an oscillator. `None` stands for a
    /// direction in which the node is held or moved.
    pub dofs: Vec<Option<usize>>,
    /// The courses of each direction in which the node is moved; none in others.
    pub courses: Vec<Vec<Course>>,
}

/// The node nearest to the point of a probe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestNode {
    /// Index in the mesh, from 0.
    pub index: u32,
    /// Tag in the mesh file.
    pub tag: u64,
    /// Its distance from the probe's point (m).
    pub distance: f64,
}

impl Probe {
    /// The displacement (m) in each of its directions at time `t` (s), with that of the degrees of freedom then: 0
    /// where it is held, the prescribed one where it is moved.
    pub fn displacement<'a>(&'a self, t: f64, u: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let own = move |dof: usize| u.get(dof).copied().unwrap_or(f64::NAN);
        let directions = self.dofs.iter().enumerate();
        directions.map(move |(axis, dof)| dof.map_or_else(|| self.prescribed(axis, t), own))
    }

    /// The displacement (m) that is prescribed in a direction at time `t` (s); 0 where none is.
    pub(crate) fn prescribed(&self, axis: usize, t: f64) -> f64 {
        let courses = self.courses.get(axis).into_iter().flatten();
        // A scene has no inputs.
        let along = |course: &Course| course.displacement_at(t, axis).unwrap_or(f64::NAN);
        courses.fold(0.0, |sum, course| sum + along(course))
    }
}

/// The probes of a body.
pub(super) fn of_body(
    points: &[ProbePoint],
    places: &Places,
    body: &BodyModel,
) -> Result<Vec<Probe>, SceneError> {
    let nearest = |at: &ProbeAt| match at {
        ProbeAt::Point(point) => Ok(body.mesh.nearest_node(*point)),
        ProbeAt::Group(name) => match body.mesh.group_nodes(body.mesh.group(name)?)[..] {
            [node] => Ok((node, 0.0)),
            ref nodes => {
                let nodes = nodes.len();
                Err(Fault::SeveralNodes { nodes })
            }
        },
    };
    let probe = |(place, ProbePoint { name, at }): (usize, &ProbePoint)| {
        let place = places.of(&places.probes, place);
        let (index, distance) =
            nearest(at).map_err(|fault| place.value_fault(place.part_key(), fault))?;
        let cell = body.model.cell_of_node(index);
        let dof = |axis: usize| -> Option<usize> {
            let dof = 3 * cell? as usize + axis;
            (!body.model.pinned()[dof]).then_some(dof)
        };
        Ok(Probe {
            name: name.clone(),
            node: Some(NearestNode {
                index,
                tag: body.mesh.node_tags[index as usize],
                distance,
            }),
            dofs: (0..3).map(dof).collect(),
            courses: (0..3)
                .map(|axis| body.model.courses(index, axis).to_vec())
                .collect(),
        })
    };
    points.iter().enumerate().map(probe).collect()
}

pub(super) fn of_oscillator() -> Probe {
    Probe {
        name: "mass".into(),
        node: None,
        dofs: vec![Some(0)],
        courses: Vec::new(),
    }
}

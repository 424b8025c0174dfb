//! Rigid surgical tools on tissue: contact, grasping and forces in a step, with their motion and shape.
//!
//! [`Tools`] are the contact of a step of a body: each [`Tool`] presses on the cells that it touches, with friction,
//! may grasp them, and may be a body of its own ([`ToolBody`]) on a coupling; cut faces ([`CutFace`]) push each other.
//! [`ToolReport`] reports the results of a step.
//!
//! A [`Shape`] is a union of [`Convex`] shapes, each with a [`Pose`] in the tool's own frame. A [`Motion`] gives the
//! pose of that frame at any time, unless a [`Steering`] does while the simulation runs. A [`Stroke`] is the motion of
//! one part over a step: it finds the first contact with a node at any speed of both, so that neither passes through
//! the other. [`swept_box`] finds the nodes that need to be checked.
//!
//! ```
//! use sinew_core::Inputs;
//! use sinew_tools::{Convex, Motion, Pose, Shape, Stroke, swept_box};
//!
//! // A ball of 5 mm moves down on a node at 30 m/s: 30 mm in a step of 1 ms.
//! let shape = Shape::of(Convex::sphere(0.005)?);
//! let start = Pose::new([0.0, 0.0, 0.02], [0.0; 3]);
//! let motion = Motion::Steady { start, velocity: [0.0, 0.0, -30.0] };
//! let (before, after) = (motion.at(0.0, Inputs::none()), motion.at(0.001, Inputs::none()));
//! let node = [0.0, 0.0, 0.0];
//!
//! let [low, high] = swept_box(&shape, &before, &after).ok_or("a ball is bounded")?;
//! assert!((0..3).all(|axis| low[axis] <= node[axis] && node[axis] <= high[axis]));
//!
//! let stroke = Stroke::new(&shape.parts()[0], before, after);
//! let touch = stroke.first_contact(node, node).ok_or("the ball passes over the node")?;
//! assert!((touch.share - 0.5).abs() < 1e-12);
//! assert_eq!(stroke.pose_at(touch.share).turned(touch.normal), [0.0, 0.0, -1.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod contact;
mod motion;
mod pose;
mod rotation;
mod segments;
mod shape;
mod steering;
mod stroke;
mod surface_pressures;
mod swept_box;
mod table;
mod triangle;
pub mod vector;

pub use contact::{
    BodyReport, Corner, CutFace, Depth, Grasp, LipsReport, Tool, ToolBody, ToolBodyError,
    ToolReport, Tools, ToolsError, TouchedCell, TouchedTriangle,
};
pub use motion::Motion;
pub use pose::Pose;
pub use segments::nearest_of_segments;
pub use shape::{Convex, Nearest, Part, Shape, ShapeError, Touch};
pub use steering::Steering;
pub use stroke::Stroke;
pub use surface_pressures::SurfacePressures;
pub use swept_box::swept_box;
pub use table::{Row, Table, TableError};
pub use triangle::nearest_of_triangle;

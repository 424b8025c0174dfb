//! Rigid tools and the nodes that they may touch.

use std::sync::Arc;

use sinew_core::{Inputs, State, System};
use sinew_fem::Model;
use sinew_mesh::{FindGroupError, TetMesh};
use sinew_tools::{
    Convex, Corner, CutFace, Motion, Part, Pose, Row, Shape, ShapeError, Table, Tools, ToolsError,
    TouchedCell,
};

use super::model::BodyModel;
use super::motion_table::PoseTable;
use super::tool_surface::{self, moved_nodes};
use crate::decode::Place;
use crate::error::{Fault, SceneError, ToolFault};
use crate::scene::{
    Body, FARTHEST, Lips, Places, StartsInside, Tool, ToolPath, ToolShape, ToolStart,
};

/// Share of the body's size by which a node may lie inside a tool that begins on its surface.
pub(super) const ROUNDING: f64 = 1e-9;

/// Adds the tools of a scene to a body, which begins in the state `initial`.
pub(super) fn added_to(
    built: BodyModel,
    body: &Body,
    places: &Places,
    initial: &State,
    duration: f64,
) -> Result<BodyModel, SceneError> {
    if body.tools.is_empty() {
        return Ok(built);
    }
    let (mut nodes_of, mut tools) = (Vec::new(), Vec::new());
    for (index, tool) in body.tools.iter().enumerate() {
        let place = places.of_tool(index);
        if tool.is_blade() && !body.is_cut_by(index) {
            let (key, reason) = match tool.is_scissors() {
                true => (
                    "shapes",
                    "are two blades, scissors, which cut in scenes with [cutting] only",
                ),
                false => (
                    "shape",
                    "is a blade, which cuts where [cutting] has tool = \"its name\" only",
                ),
            };
            let reason = reason.to_owned();
            return Err(place.key_fault(key, Fault::Misplaced { key, reason }));
        }
        nodes_of.push(nodes(body, index, &built, place)?);
        let known = sinew_tools::Tool {
            name: tool.name.clone(),
            shape: shape(tool).map_err(|error| place.fault(ToolFault::from(error).into()))?,
            motion: motion(tool, place)?,
            friction: tool.friction,
            cells: Vec::new(),
            grasp: tool.grasp,
            body: tool.body,
            triangles: Vec::new(),
        };
        if !tool.is_blade() {
            check_width(&known, &built).map_err(|(part, fault)| {
                let key = tool.parts[part].shape.thinnest();
                let size = places.tools[index].sizes.get(part);
                match (size, key) {
                    (Some(size), Some(key)) => size.value_fault(key, fault.into()),
                    _ => place.fault(fault.into()),
                }
            })?;
        }
        tools.push(known);
    }
    let are_fine = tool_surface::are_fine(&tools, &built, duration, body.cutting.is_some());
    let tools = on_nodes(tools, &are_fine, &nodes_of, Vec::new(), &built).map_err(|error| {
        let at_fault = error.tool().and_then(|name| {
            let mut tools = body.tools.iter();
            tools.position(|tool| tool.name == name)
        });
        let last = body.tools.len() - 1;
        let place = places.of_tool(at_fault.unwrap_or(last));
        place.fault(ToolFault::from(error).into())
    })?;
    for (index, tool) in body.tools.iter().enumerate() {
        let place = places.of_tool(index);
        let key = match tool.path {
            ToolPath::Table(_) => "table",
            ToolPath::Hold(_) | ToolPath::Velocity(..) => "start",
        };
        if body.is_cut_by(index) {
            continue;
        }
        check_start(&tools, index, tool, &built, initial)
            .map_err(|fault| place.value_fault(key, fault.into()))?;
    }
    Ok(built.touched_by(Arc::new(tools)))
}

/// Tools that each touch these nodes of a body, and the surface if they are smaller than its triangles; with the pairs
/// of cut faces that touch each other.
fn on_nodes(
    mut tools: Vec<sinew_tools::Tool>,
    are_fine: &[bool],
    nodes_of: &[Vec<u32>],
    cut_faces: Vec<[[u32; 3]; 2]>,
    built: &BodyModel,
) -> Result<Tools, ToolsError> {
    let is_met = |node: &u32| built.model.cell_of_node(*node).is_some();
    let lips = cut_faces
        .iter()
        .flatten()
        .flatten()
        .filter(|node| is_met(node));
    let mut touched: Vec<u32> = nodes_of.iter().flatten().chain(lips).copied().collect();
    touched.sort_unstable();
    touched.dedup();
    for (tool, nodes) in tools.iter_mut().zip(nodes_of) {
        let among = nodes.iter().map(|node| touched.binary_search(node));
        tool.cells = among.flatten().map(|place| place as u32).collect();
        tool.triangles.clear();
    }
    let cells = touched
        .iter()
        .filter_map(|node| cell(&built.model, *node))
        .collect();
    let triangles = tool_surface::under_tips(&mut tools, are_fine, nodes_of, &touched, built);
    let tools = Tools::with_triangles(tools, cells, triangles)?;
    let corner = |node: u32| match touched.binary_search(&node) {
        Ok(place) => Corner::Cell(place as u32),
        Err(_) => Corner::Held(built.mesh.points[node as usize]),
    };
    let faces = cut_faces.into_iter().map(|face| CutFace {
        corners: face.map(|corners| corners.map(corner)),
    });
    tools.with_cut_faces(faces.collect())
}

/// Pairs of cut faces of a body that touch each other: those of which no corner is moved by the scene or frozen away
/// from its position at rest.
fn cut_faces(body: &Body, built: &BodyModel) -> Vec<[[u32; 3]; 2]> {
    let touches = body
        .cutting
        .as_ref()
        .is_some_and(|cutting| cutting.lips == Lips::Contact);
    let Some(from) = built.cut.as_ref().filter(|_| touches) else {
        return Vec::new();
    };
    let rests = |node: &u32| built.model.rests_in_place(*node);
    let mut faces = from.cut.cut_faces();
    faces.retain(|face| face.as_flattened().iter().all(rests));
    faces
}

/// Rebuilds the contact of tools with a body that has changed. Tools have contact with triangles if they had it before,
/// so that no triangle is suddenly added inside a tool.
pub(super) fn touching_anew(
    built: BodyModel,
    body: &Body,
    tools: Option<&Tools>,
) -> Result<BodyModel, ToolsError> {
    let tools = tools.map_or_else(Vec::new, |tools| tools.tools().to_vec());
    let are_fine: Vec<bool> = tools
        .iter()
        .map(|tool| !tool.triangles.is_empty())
        .collect();
    touched_by(built, body, tools, &are_fine)
}

/// Rebuilds the contact of tools after a change of steering.
pub(super) fn led_anew(
    built: BodyModel,
    body: &Body,
    tools: &Tools,
    duration: f64,
) -> Result<BodyModel, ToolsError> {
    let tools = tools.tools().to_vec();
    let are_fine = tool_surface::are_fine(&tools, &built, duration, body.cutting.is_some());
    touched_by(built, body, tools, &are_fine)
}

fn touched_by(
    built: BodyModel,
    body: &Body,
    tools: Vec<sinew_tools::Tool>,
    are_fine: &[bool],
) -> Result<BodyModel, ToolsError> {
    let nodes_of: Vec<Vec<u32>> = body
        .tools
        .iter()
        .enumerate()
        // A group of which a cut left nothing is empty.
        .map(|(index, _)| {
            touchable(body, index, &built).map_or_else(|_| Vec::new(), |nodes| nodes.0)
        })
        .collect();
    let faces = cut_faces(body, &built);
    let tools = on_nodes(tools, are_fine, &nodes_of, faces, &built)?;
    Ok(built.touched_by(Arc::new(tools)))
}

/// The nodes that a tool may touch: those that move freely in at least one direction, and are not moved in another.
fn nodes(
    body: &Body,
    index: usize,
    built: &BodyModel,
    place: &Place,
) -> Result<Vec<u32>, SceneError> {
    let (met, unmet) = touchable(body, index, built)
        .map_err(|error| place.value_fault("touches", error.into()))?;
    if met.is_empty() && !body.is_cut_by(index) {
        let fault = ToolFault::NothingToTouch { nodes: unmet.len() };
        return Err(place.value_fault("touches", fault.into()));
    }
    Ok(met)
}

/// The nodes that a tool of a body may touch, and those that it may not: see [`nodes_of`]. A tool that cuts or
/// removes touches none.
pub(super) fn touchable(
    body: &Body,
    index: usize,
    built: &BodyModel,
) -> Result<(Vec<u32>, Vec<u32>), FindGroupError> {
    match body.tools.get(index) {
        Some(tool) if !body.is_cut_by(index) => nodes_of(tool, built),
        _ => Ok(Default::default()),
    }
}

/// The nodes of a tool's surface or group that it may touch, and those that it may not, because they are fixed or
/// moved.
pub(super) fn nodes_of(
    tool: &Tool,
    built: &BodyModel,
) -> Result<(Vec<u32>, Vec<u32>), FindGroupError> {
    let mesh = &built.mesh;
    let mut nodes = match &tool.touches {
        None => built.surface().nodes.clone(),
        Some(name) => mesh.group_nodes(mesh.group(name)?),
    };
    nodes.sort_unstable();
    nodes.dedup();
    let moved = moved_nodes(built);
    let is_met = |node: &u32| {
        built.model.cell_of_node(*node).is_some() && moved.binary_search(node).is_err()
    };
    Ok(nodes.into_iter().partition(is_met))
}

fn cell(model: &Model, node: u32) -> Option<TouchedCell> {
    let cell = model.cell_of_node(node)?;
    let first = 3 * cell as usize;
    Some(TouchedCell {
        cell,
        rest: model.mesh().points[node as usize],
        free: [0, 1, 2].map(|axis| !model.pinned()[first + axis]),
    })
}

fn shape(tool: &Tool) -> Result<Shape, ShapeError> {
    let parts = tool.parts.iter().map(|part| {
        let convex = match part.shape {
            ToolShape::Sphere { radius } => Convex::sphere(radius)?,
            ToolShape::Capsule { radius, length } => Convex::capsule(radius, length)?,
            ToolShape::Plane => Convex::Plane,
            ToolShape::Box { size } => Convex::cuboid(size)?,
            ToolShape::Blade { length } => Convex::edge(length)?,
        };
        let pose = Pose::new(part.at, part.rotation);
        Ok(Part { convex, pose })
    });
    Shape::several(parts.collect::<Result<_, _>>()?)
}

fn motion(tool: &Tool, place: &Place) -> Result<Motion, SceneError> {
    let pose = |start: &ToolStart| Pose::new(start.position, start.rotation);
    Ok(match &tool.path {
        ToolPath::Hold(start) => Motion::Held(pose(start)),
        ToolPath::Velocity(start, velocity) => Motion::Steady {
            start: pose(start),
            velocity: *velocity,
        },
        ToolPath::Table(written) => {
            let fault = |fault| place.value_fault("table", fault);
            let poses =
                PoseTable::read(place.scene(), written).map_err(|error| fault(error.into()))?;
            let rows = poses.times.iter().zip(poses.positions).zip(poses.rotations);
            let rows = rows.map(|((t, position), rotation_vector)| Row {
                t: *t,
                position,
                rotation_vector,
            });
            let rows: Vec<Row> = rows.collect();
            let is_far = |row: &&Row| row.position.iter().any(|x| x.abs() > FARTHEST);
            if let Some(row) = rows.iter().find(is_far) {
                let (t, position) = (row.t, row.position);
                return Err(fault(ToolFault::Far { t, position }.into()));
            }
            let table = Table::new(rows);
            Motion::Table(table.map_err(|error| fault(ToolFault::from(error).into()))?)
        }
    })
}

/// Depth of a tool in the body at the beginning: tag and depth (m) of the deepest node, if it exceeds rounding.
pub(super) fn inside(
    tools: &Tools,
    index: usize,
    built: &BodyModel,
    initial: &State,
) -> Option<(u64, f64)> {
    let pose = tools.pose(initial, Inputs::none(), index);
    let deepest = tools.deepest(&initial.u, &pose, index)?;
    let size = built.model.extent().unwrap_or(0.0);
    if deepest.gap >= -ROUNDING * size {
        return None;
    }
    let cell = tools.touched_cells()[deepest.place].cell;
    let node = built.model.nodes()[cell as usize];
    Some((built.mesh.node_tags[node as usize], -deepest.gap))
}

/// Share of the body's size below which a tool is too thin for the rounding of positions.
const THINNEST: f64 = 1e-9;

/// Refuses a tool with a part that is too thin; the error has the index of the part and the fault.
fn check_width(tool: &sinew_tools::Tool, built: &BodyModel) -> Result<(), (usize, ToolFault)> {
    let Some(body) = built.model.extent() else {
        return Ok(());
    };
    for (number, part) in tool.shape.parts().iter().enumerate() {
        let half_width = part.convex.half_width();
        if half_width < THINNEST * body {
            return Err((number, ToolFault::Tiny { half_width, body }));
        }
    }
    Ok(())
}

fn check_start(
    tools: &Tools,
    index: usize,
    tool: &Tool,
    built: &BodyModel,
    initial: &State,
) -> Result<(), ToolFault> {
    if let Some((node, depth)) = inside(tools, index, built, initial) {
        return match tool.starts_inside {
            StartsInside::Refuse => Err(ToolFault::Inside { node, depth }),
            StartsInside::Push => Ok(()),
        };
    }
    let found = &tools.tools()[index];
    let pose = found.motion.at(initial.t(), Inputs::none());
    let parts = found.shape.parts().iter();
    let bounded = parts.filter(|part| part.convex != Convex::Plane);
    let middles: Vec<[f64; 3]> = bounded
        .map(|part| pose.then(&part.pose).position())
        .collect();
    let mut u = vec![[0.0; 3]; built.mesh.points.len()];
    built
        .model
        .displacements_at(initial.t(), &initial.u, &mut u)?;
    match holds_one(&built.mesh, &u, &middles) {
        Some(tet) => Err(ToolFault::Within { tet }),
        None => Ok(()),
    }
}

/// Tag of the tetrahedron that contains one of these points (m), with displacements (m) of all nodes.
fn holds_one(mesh: &TetMesh, u: &[[f64; 3]], points: &[[f64; 3]]) -> Option<u64> {
    let places = mesh.points.iter().zip(u);
    let places: Vec<[f64; 3]> = places
        .map(|(point, u)| std::array::from_fn(|axis| point[axis] + u[axis]))
        .collect();
    let is_near = |point: &[f64; 3]| {
        (0..3).all(|axis| {
            let along = || places.iter().map(|place| place[axis]);
            along().any(|x| x <= point[axis]) && along().any(|x| x >= point[axis])
        })
    };
    let near: Vec<[f64; 3]> = points.iter().copied().filter(is_near).collect();
    if near.is_empty() {
        return None;
    }
    let deformed = TetMesh {
        points: places,
        ..mesh.clone()
    };
    near.into_iter().find_map(|point| {
        let (tet, shares) = deformed.tet_at(point)?;
        let is_inside = shares.iter().all(|share| *share >= -ROUNDING);
        is_inside.then(|| mesh.tet_tags[tet as usize])
    })
}

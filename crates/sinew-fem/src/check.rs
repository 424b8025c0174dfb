//! Checks of a problem before anything is built.

use nalgebra::Vector3;
use sinew_mesh::{Group, GroupMembers, TetMesh};

use crate::error::{Cause, FemError, Item};
use crate::springs::EDGES;
use crate::{Law, LoadKind, Problem};

/// Volume over longest edge cubed below which a tetrahedron counts as flat: rounding of the
/// coordinates alone can give this much.
const FLAT: f64 = 1e-14;

/// Checks every number of the problem.
pub(crate) fn numbers(problem: &Problem) -> Result<(), FemError> {
    for (index, region) in problem.regions.iter().enumerate() {
        let item = Item::Region(index);
        let positive =
            |quantity, found: f64, expected| require(item, quantity, found, expected, found > 0.0);
        positive("density", region.density, "a finite density above 0 kg/m3")?;
        match region.law {
            Law::Linear {
                youngs_modulus,
                poissons_ratio: nu,
            } => {
                positive("youngs_modulus", youngs_modulus, MODULUS)?;
                let inside = nu > -1.0 && nu < 0.5;
                let expected = "a number above -1 and below 0.5";
                require(item, "poissons_ratio", nu, expected, inside)?;
            }
            Law::Springs {
                youngs_modulus,
                damping_ratio,
                ..
            } => {
                positive("youngs_modulus", youngs_modulus, MODULUS)?;
                let fits = damping_ratio >= 0.0;
                let expected = "a finite number, 0 or above";
                require(item, "damping_ratio", damping_ratio, expected, fits)?;
            }
        }
    }
    let damping = [
        (
            "mass",
            problem.damping.mass,
            "a finite rate, 0 or above, in 1/s",
        ),
        (
            "stiffness",
            problem.damping.stiffness,
            "a finite time, 0 or above, in s",
        ),
    ];
    for (quantity, found, expected) in damping {
        require(Item::Damping, quantity, found, expected, found >= 0.0)?;
    }
    for (index, load) in problem.loads.iter().enumerate() {
        let item = Item::Load(index);
        match load.kind {
            LoadKind::Traction(value) => finite(item, "traction", &value)?,
            LoadKind::Pressure(value) => finite(item, "pressure", &[value])?,
            LoadKind::Force(value) => finite(item, "force", &value)?,
        }
        load.ramp
            .check()
            .map_err(|error| FemError::new(item, error.into()))?;
    }
    problem
        .gravity
        .map_or(Ok(()), |value| finite(Item::Gravity, "gravity", &value))
}

const MODULUS: &str = "a finite modulus above 0 Pa";

fn finite(item: Item, quantity: &'static str, values: &[f64]) -> Result<(), FemError> {
    for &found in values {
        require(item, quantity, found, "finite numbers", true)?;
    }
    Ok(())
}

fn require(
    item: Item,
    quantity: &'static str,
    found: f64,
    expected: &'static str,
    fits: bool,
) -> Result<(), FemError> {
    if found.is_finite() && fits {
        return Ok(());
    }
    Err(FemError::new(
        item,
        Cause::Value {
            quantity,
            found,
            expected,
        },
    ))
}

/// Checks that every tetrahedron has a positive volume and returns the volumes (m^3).
pub(crate) fn volumes(mesh: &TetMesh) -> Result<Vec<f64>, FemError> {
    let volumes = mesh.signed_volumes();
    let flat = |index: usize| {
        let vertices = mesh.tets[index].map(|node| Vector3::from(mesh.points[node as usize]));
        let lengths = EDGES.map(|[a, b]| (vertices[b] - vertices[a]).norm());
        let edge = lengths.into_iter().fold(0.0, f64::max);
        // A volume that is not a number counts as flat too.
        let solid = volumes[index].abs() > FLAT * edge.powi(3);
        (!solid).then_some(edge)
    };
    if let Some((index, edge)) = (0..volumes.len()).find_map(|i| flat(i).map(|edge| (i, edge))) {
        let cause = Cause::Flat {
            tag: mesh.tet_tags[index],
            volume: volumes[index],
            edge,
        };
        return Err(FemError::new(Item::Mesh, cause));
    }
    let count = volumes.iter().filter(|volume| **volume < 0.0).count();
    match volumes.iter().position(|volume| *volume < 0.0) {
        None => Ok(volumes),
        Some(index) => Err(FemError::new(
            Item::Mesh,
            Cause::Inverted {
                tag: mesh.tet_tags[index],
                volume: volumes[index],
                count,
            },
        )),
    }
}

/// The region of each tetrahedron.
pub(crate) fn regions(mesh: &TetMesh, problem: &Problem) -> Result<Vec<usize>, FemError> {
    let mut region_of = vec![None; mesh.tets.len()];
    for (index, region) in problem.regions.iter().enumerate() {
        let item = Item::Region(index);
        let all: Vec<u32>;
        let members = match &region.group {
            None => {
                all = (0..mesh.tets.len() as u32).collect();
                &all
            }
            Some(name) => match group(mesh, name, item)? {
                Group {
                    members: GroupMembers::Tets(tets),
                    ..
                } => tets,
                other => return Err(dimension(item, other, "a group of tetrahedra")),
            },
        };
        for &tet in members {
            let slot: &mut Option<usize> = &mut region_of[tet as usize];
            if let Some(first) = slot.replace(index) {
                let cause = Cause::RegionsOverlap {
                    tag: mesh.tet_tags[tet as usize],
                    first: first + 1,
                };
                return Err(FemError::new(item, cause));
            }
        }
    }
    let count = region_of.iter().filter(|region| region.is_none()).count();
    if let Some(first) = region_of.iter().position(Option::is_none) {
        let tag = mesh.tet_tags[first];
        return Err(FemError::new(Item::Mesh, Cause::NoRegion { count, tag }));
    }
    Ok(region_of.into_iter().flatten().collect())
}

/// A group of the mesh by name.
pub(crate) fn group<'a>(mesh: &'a TetMesh, name: &str, item: Item) -> Result<&'a Group, FemError> {
    mesh.group(name)
        .map_err(|error| FemError::new(item, error.into()))
}

/// The complaint about a group of the wrong kind.
pub(crate) fn dimension(item: Item, group: &Group, expected: &'static str) -> FemError {
    let cause = Cause::GroupDimension {
        group: group.name.clone(),
        dim: group.dim,
        expected,
    };
    FemError::new(item, cause)
}

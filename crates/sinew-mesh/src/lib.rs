//! Tetrahedral meshes with named groups: .msh, .vtu, .vtk, .mesh and .inp in, .msh and .vtu out, checks and repairs, structured
//! generators.
//!
//! A file is read into a [`Mesh`]: all its cells, tags, groups and warnings, in the arrangement of meshio.
//! [`Mesh::check`] finds defects that make a simulation fail, [`info::MeshInfo`] sums a mesh up, [`write_msh`] and
//! [`vtu::write_vtu`] write it. [`Mesh::to_tet_mesh`] turns it into the [`TetMesh`] that a simulation needs. This crate
//! contains no mechanics.
//!
//! ```
//! use sinew_mesh::{GroupMembers, read_msh, structured, write_msh41_ascii};
//!
//! // A cube of 2 x 2 x 2 hexahedra, each cut into six tetrahedra, with its groups.
//! let cube = structured::cube(2, 0.1, structured::Split::Mirrored)?;
//! let mut file = Vec::new();
//! write_msh41_ascii(&cube.to_mesh(), &mut file)?;
//!
//! // Reading takes bytes; `read_mesh_file` takes a path, whose extension tells the format.
//! let mesh = read_msh(&file)?;
//! for warning in &mesh.warnings {
//!     eprintln!("{warning}");
//! }
//! for set in mesh.cell_sets() {
//!     eprintln!("{}: {} cells", set.name, set.blocks.iter().map(Vec::len).sum::<usize>());
//! }
//!
//! // The mesh of a simulation: tetrahedra, groups by name, outward surfaces.
//! let tissue = mesh.to_tet_mesh()?;
//! assert_eq!(tissue, cube);
//! let top = tissue.group("top")?;
//! assert_eq!(tissue.group_nodes(top).len(), 9);
//! if let GroupMembers::Triangles(triangles) = &top.members {
//!     assert_eq!(tissue.outward_triangles(triangles)?.len(), 8);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod abaqus;
mod advice;
mod bounds;
mod cell_type;
mod check;
mod data_range;
mod duplicates;
mod file;
pub mod info;
mod joints;
mod label_groups;
mod linearise;
mod medit;
mod mesh;
mod msh;
mod physical_tags;
mod reading;
mod selection;
pub mod structured;
mod tet_mesh;
mod tet_shape;
mod unstructured;
pub mod vector;
mod vtk;
pub mod vtu;
mod warning;

pub use abaqus::read_abaqus;
pub use cell_type::CellType;
pub use check::{CheckLimits, EdgeLengths, Extreme, Finding, MeshCheck, Part, SharedFace};
pub use file::{
    MeshFileError, MeshFormat, NotAMesh, converted_extensions, read_mesh, read_mesh_file,
    read_mesh_of, read_msh_file,
};
pub use joints::{JointFinding, Joints, Places};
pub use label_groups::{LabelError, LabelGroup};
pub use linearise::Linearised;
pub use medit::read_medit;
pub use mesh::{
    CellBlock, CellData, CellIndex, CellNodeData, CellSet, Entity, Mesh, PeriodicLink, PointData,
};
pub use msh::{MshEncoding, MshVersion, WriteMshError, read_msh, write_msh, write_msh41_ascii};
pub use physical_tags::PhysicalTags;
pub use reading::MeshError;
pub use selection::{Condition, DataValues, Selection, SelectionError};
pub use tet_mesh::{
    AddGroupError, BoundarySurface, CutBody, CutMesh, FindGroupError, Group, GroupMembers,
    MovedNode, NodeData, RefineError, Split, SplitFollower, SurfaceError, TetData, TetDataError,
    TetMesh, TetMeshError,
};
pub use vtk::read_vtk;
pub use warning::{Position, Warning};

//! Tetrahedral meshes with named groups: gmsh .msh in and out, structured generators

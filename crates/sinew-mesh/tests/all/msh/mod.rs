//! Files of gmsh.

mod encodings;
mod malformed;
mod memory;
mod meshio_files;
mod mutation;
mod reading;
mod round_trip;
mod version_1;
mod writing;

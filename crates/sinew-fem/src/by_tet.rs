//! Properties of materials that differ from tetrahedron to tetrahedron.

use std::sync::Arc;

use sinew_mesh::{TetData, TetMesh};

use crate::Problem;
use crate::error::{Cause, FemError, Item};
use crate::frame::{Axes, Frame, UnitVectors, frame, unit};
use crate::from_mesh::{DataError, FromMesh};
use crate::shares::Shares;
use crate::tissue::{Direction, Tissue};

/// Properties per tetrahedron, read from the mesh's data and checked.
#[derive(Debug, Default)]
pub(crate) struct ByTet {
    regions: Vec<RegionByTet>,
    /// Factor of the region's density in each tetrahedron; `None` if no region takes its density from the mesh.
    densities: Option<Vec<f64>>,
}

/// Properties per tetrahedron of a region; arrays are over all tetrahedra of the mesh.
#[derive(Clone, Debug)]
pub(crate) struct RegionByTet {
    /// The least and the largest factor of Young's modulus.
    pub(crate) moduli: [f64; 2],
    /// The stiffness of each tetrahedron, of the largest.
    pub(crate) shares: Shares,
    /// The direction of each family of fibres as unit vectors; `None` if it is the same in all tetrahedra.
    pub(crate) directions: Vec<Option<UnitVectors>>,
    /// The material's axes, if its law has some.
    pub(crate) axes: Option<Axes>,
    /// The least and the largest factor of the density.
    pub(crate) densities: [f64; 2],
}

impl Default for RegionByTet {
    fn default() -> Self {
        Self {
            moduli: [1.0; 2],
            shares: Shares::default(),
            directions: Vec::new(),
            axes: None,
            densities: [1.0; 2],
        }
    }
}

impl ByTet {
    /// Reads the properties that the data of a mesh give, whose tetrahedra are in the regions `region_of`.
    pub(crate) fn new(
        mesh: &TetMesh,
        problem: &Problem,
        region_of: &[u32],
    ) -> Result<Self, FemError> {
        let regions = vec![RegionByTet::default(); problem.regions.len()];
        let mut by_tet = Self {
            regions,
            densities: None,
        };
        let mut moduli = None;
        let mut directions: [Option<Vec<[f64; 3]>>; Tissue::MOST_FAMILIES] = Default::default();
        for (index, region) in problem.regions.iter().enumerate() {
            let FromMesh {
                youngs_modulus,
                density,
            } = &region.from_mesh;
            let members = Members {
                mesh,
                region_of,
                index,
            };
            let at = |quantity: &'static str| {
                move |error: DataError| {
                    FemError::new(Item::Region(index), Cause::Data { quantity, error })
                }
            };
            let of_region = &mut by_tet.regions[index];
            if let Some(name) = youngs_modulus {
                let all = moduli.get_or_insert_with(|| vec![1.0; mesh.tets.len()]);
                let modulus = region.law.youngs_modulus();
                let expected = "a finite modulus above 0 Pa";
                of_region.moduli = members
                    .positive(name, (modulus, expected), all)
                    .map_err(at("youngs_modulus"))?;
                let [_, largest] = of_region.moduli;
                members.tets().for_each(|tet| all[tet] /= largest);
            }
            if let Some(name) = density {
                let all = by_tet
                    .densities
                    .get_or_insert_with(|| vec![1.0; mesh.tets.len()]);
                let expected = "a finite density above 0 kg/m3";
                of_region.densities = members
                    .positive(name, (region.density, expected), all)
                    .map_err(at("density"))?;
            }
            for (family, all) in region.tissue.fibres.iter().zip(&mut directions) {
                if let Direction::Data(name) = &family.direction {
                    let all = all.get_or_insert_with(|| vec![[0.0; 3]; mesh.tets.len()]);
                    members.directions(name, all).map_err(at("direction"))?;
                }
            }
            if let Some(axes) = &region.tissue.axes {
                of_region.axes = Some(members.axes(axes).map_err(at("axes"))?);
            }
        }
        let moduli: Option<Arc<[f64]>> = moduli.map(Arc::from);
        let directions = directions.map(|all| all.map(UnitVectors::from));
        for ((index, region), of_region) in
            problem.regions.iter().enumerate().zip(&mut by_tet.regions)
        {
            let members = Members {
                mesh,
                region_of,
                index,
            };
            if let (Some(_), Some(all)) = (&region.from_mesh.youngs_modulus, &moduli) {
                of_region.shares = Shares::new(Arc::clone(all), members.tets());
            }
            let families = region.tissue.fibres.iter().zip(&directions);
            of_region.directions = families
                .map(|(family, all)| match family.direction {
                    Direction::Everywhere(_) => None,
                    Direction::Data(_) => all.clone(),
                })
                .collect();
        }
        Ok(by_tet)
    }

    /// The properties of a region.
    pub(crate) fn region(&self, index: usize) -> &RegionByTet {
        &self.regions[index]
    }

    /// Factor of the density of a tetrahedron's region; 1 if the mesh gives none.
    pub(crate) fn density(&self, tet: usize) -> f64 {
        self.densities.as_ref().map_or(1.0, |all| all[tet])
    }
}

/// The tetrahedra of a region.
#[derive(Clone, Copy)]
struct Members<'a> {
    mesh: &'a TetMesh,
    region_of: &'a [u32],
    index: usize,
}

impl<'a> Members<'a> {
    fn tets(self) -> impl Iterator<Item = usize> + use<'a> {
        let of_region = self.region_of.iter().enumerate();
        let is_own =
            move |(tet, region): (usize, &u32)| (*region as usize == self.index).then_some(tet);
        of_region.filter_map(is_own)
    }

    /// The data with a name, which must have `expected` values per tetrahedron, and some for each tetrahedron of the
    /// region.
    fn data(self, name: &str, expected: usize) -> Result<&'a TetData, DataError> {
        let data = self.mesh.data(name)?;
        let name = || name.to_owned();
        if data.components != expected {
            return Err(DataError::Components {
                name: name(),
                found: data.components,
                expected,
            });
        }
        let mut without = self.tets().filter(|tet| {
            let row = values(data, *tet);
            row.is_empty() || row.iter().all(|value| value.is_nan())
        });
        match without.next() {
            None => Ok(data),
            Some(first) => Err(DataError::NoValue {
                name: name(),
                count: 1 + without.count(),
                tag: self.tag(first),
            }),
        }
    }

    /// Writes factors of a property, which make it finite and above 0; returns the least and the largest.
    fn positive(
        self,
        name: &str,
        (property, expected): (f64, &'static str),
        out: &mut [f64],
    ) -> Result<[f64; 2], DataError> {
        let data = self.data(name, 1)?;
        let [mut least, mut largest] = [f64::INFINITY, 0.0_f64];
        for tet in self.tets() {
            for factor in values(data, tet) {
                let found = property * factor;
                if !(found.is_finite() && found > 0.0) {
                    return Err(DataError::Value {
                        name: name.to_owned(),
                        tag: self.tag(tet),
                        found: *factor,
                        expected,
                    });
                }
                out[tet] = *factor;
                least = least.min(*factor);
                largest = largest.max(*factor);
            }
        }
        Ok([least, largest])
    }

    /// Writes directions as unit vectors.
    fn directions(self, name: &str, out: &mut [[f64; 3]]) -> Result<(), DataError> {
        let data = self.data(name, 3)?;
        for tet in self.tets() {
            if let [x, y, z] = *values(data, tet) {
                let refused = || DataError::Direction {
                    name: name.to_owned(),
                    tag: self.tag(tet),
                    found: [x, y, z],
                };
                out[tet] = unit([x, y, z]).ok_or_else(refused)?;
            }
        }
        Ok(())
    }

    /// The axes from their first two directions.
    fn axes(self, directions: &[Direction; 2]) -> Result<Axes, DataError> {
        if let [Direction::Everywhere(first), Direction::Everywhere(second)] = directions {
            // Checked before.
            let frame = frame(*first, *second).unwrap_or_default();
            return Ok(Axes::Everywhere(Box::new(frame)));
        }
        let mut all = Vec::new();
        for direction in directions {
            all.push(match direction {
                Direction::Everywhere(_) => vec![direction.unit(); self.mesh.tets.len()],
                Direction::Data(name) => {
                    let mut vectors = vec![[0.0; 3]; self.mesh.tets.len()];
                    self.directions(name, &mut vectors)?;
                    vectors
                }
            });
        }
        let mut frames = vec![Frame::default(); self.mesh.tets.len()];
        for tet in self.tets() {
            let parallel = || DataError::Parallel {
                tag: self.tag(tet),
                found: [all[0][tet], all[1][tet]],
            };
            frames[tet] = frame(all[0][tet], all[1][tet]).ok_or_else(parallel)?;
        }
        Ok(Axes::Each(frames.into()))
    }

    fn tag(self, tet: usize) -> u64 {
        let ordinal = tet as u64 + 1;
        self.mesh.tet_tags.get(tet).copied().unwrap_or(ordinal)
    }
}

/// The values of a tetrahedron; empty if the data given are too short.
fn values(data: &TetData, tet: usize) -> &[f64] {
    let width = data.components;
    data.values
        .get(tet * width..(tet + 1) * width)
        .unwrap_or_default()
}

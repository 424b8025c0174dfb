//! A material at a point.

use super::error::HomogeneousError;
use crate::frame::frame;
use crate::hyperelastic::fibres::Fibres;
use crate::hyperelastic::{Deformation, Hyperelastic, LawError, SMALLEST_VOLUME_RATIO, Tensor};
use crate::tetra;
use crate::tissue::Direction;
use crate::{Law, Region};

/// The material of a region at a point, with its moduli as stated: instantaneous or long-term ones if stress
/// relaxes.
#[derive(Clone, Debug)]
pub struct Solid {
    matrix: Matrix,
    fibres: Vec<(Fibres, [f64; 3])>,
    /// The material's axes by rows, if its law has axes other than those of coordinates.
    axes: Option<Tensor<f64>>,
}

/// The material without its fibres.
#[derive(Clone, Debug)]
enum Matrix {
    /// Lame's constants (Pa) of small strain.
    Linear {
        lambda: f64,
        mu: f64,
    },
    Large(Hyperelastic),
}

impl Solid {
    /// The material of a region, whose directions are stated: no data of a mesh give them ([`Region::at_tetrahedron`]).
    ///
    /// # Errors
    ///
    /// [`HomogeneousError`] for springs, and for a law whose parameters are not allowed.
    pub fn of(region: &Region) -> Result<Self, HomogeneousError> {
        let matrix = match &region.law {
            Law::Springs { .. } => return Err(HomogeneousError::Springs),
            Law::Linear {
                youngs_modulus,
                poissons_ratio,
            } => {
                let (lambda, mu) = tetra::lame(*youngs_modulus, *poissons_ratio);
                Matrix::Linear { lambda, mu }
            }
            Law::Hyperelastic { id, parameters } => {
                let law: Result<_, LawError> = Hyperelastic::new(id, parameters);
                Matrix::Large(law?)
            }
        };
        let families = region.tissue.fibres.iter();
        let fibres = families
            .map(|family| (family.fibres, family.direction.unit()))
            .collect();
        let stated = |axes: &[Direction; 2]| {
            let [first, second] = axes.each_ref().map(Direction::unit);
            frame(first, second).map(Tensor)
        };
        let axes = region.tissue.axes.as_ref().and_then(stated);
        Ok(Self {
            matrix,
            fibres,
            axes,
        })
    }

    /// True if the law is one of small strain, for which nominal stress and Cauchy stress are the same.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        matches!(self.matrix, Matrix::Linear { .. })
    }

    /// True if its stress depends on the direction of the pull.
    #[must_use]
    pub fn has_directions(&self) -> bool {
        let has_axes = matches!(&self.matrix, Matrix::Large(law) if law.has_axes());
        has_axes || !self.fibres.is_empty()
    }

    /// Lame's constants (lambda, mu) (Pa) at rest, without fibres.
    #[must_use]
    pub fn lame(&self) -> (f64, f64) {
        match &self.matrix {
            Matrix::Linear { lambda, mu } => (*lambda, *mu),
            Matrix::Large(law) => law.lame(),
        }
    }

    /// A tensor in the axes of the material.
    fn in_axes(&self, tensor: Tensor<f64>) -> Tensor<f64> {
        match self.axes {
            Some(axes) => tensor.in_axes(axes),
            None => tensor,
        }
    }

    /// A tensor that is given in the axes of the material.
    fn out_of_axes(&self, tensor: Tensor<f64>) -> Tensor<f64> {
        match self.axes {
            Some(axes) => tensor.out_of_axes(axes),
            None => tensor,
        }
    }

    /// First Piola-Kirchhoff stress (Pa) from the gradient of the displacement; `None` if the law is not defined.
    pub(super) fn stress(&self, h: Tensor<f64>) -> Option<Tensor<f64>> {
        let deformation = Deformation::of(h);
        let isotropic = match &self.matrix {
            Matrix::Linear { lambda, mu } => isotropic(h, *lambda, *mu),
            Matrix::Large(law) => {
                let in_axes = self.in_axes(h);
                if deformation.volume_ratio <= SMALLEST_VOLUME_RATIO || !law.is_defined_at(in_axes)
                {
                    return None;
                }
                self.out_of_axes(law.stress(in_axes))
            }
        };
        let stress = self.fibres.iter().fold(isotropic, |sum, (fibres, along)| {
            sum + fibres.stress(&fibres.at(&deformation, *along))
        });
        is_finite(stress).then_some(stress)
    }

    /// Change of [`Self::stress`] by a change of F.
    pub(super) fn tangent(&self, h: Tensor<f64>, change: Tensor<f64>) -> Tensor<f64> {
        let isotropic = match &self.matrix {
            Matrix::Linear { lambda, mu } => isotropic(change, *lambda, *mu),
            Matrix::Large(law) => {
                self.out_of_axes(law.tangent(self.in_axes(h), self.in_axes(change)))
            }
        };
        let deformation = Deformation::of(h);
        self.fibres.iter().fold(isotropic, |sum, (fibres, along)| {
            sum + fibres.tangent(&fibres.at(&deformation, *along), change)
        })
    }
}

/// `lambda tr(eps) I + 2 mu eps`, eps being the symmetric part.
fn isotropic(h: Tensor<f64>, lambda: f64, mu: f64) -> Tensor<f64> {
    Tensor::diagonal(lambda * h.trace()).plus(2.0 * mu, h.symmetric())
}

fn is_finite(tensor: Tensor<f64>) -> bool {
    tensor.0.iter().flatten().all(|entry| entry.is_finite())
}

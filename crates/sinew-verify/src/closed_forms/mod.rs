//! Closed forms of laws: the required figures, and those computed by the code here.
//!
//! E = 3500 Pa and nu = .45 throughout, C1 : C2 = 4 : 1.

mod figures;
mod material;

use figures::{CONFINED, DILATION, EIGENVALUES, INCOMPRESSIBLE, INVERSION, SHEAR, TWIST, UNIAXIAL};
use material::{least_eigenvalue, pulled, stretched};

use sinew_fem::hyperelastic::{Hyperelastic, Tensor};

use crate::bodies::YOUNGS_MODULUS;
use crate::check::Asked;
use crate::error::LabError;

const POISSONS_RATIO: f64 = 0.45;

/// Largest error that passes, relative to the required figure, or to Young's modulus if that is 0.
const TOLERANCE: f64 = 1e-8;

/// A figure of a law that is known from another source.
pub(crate) struct ClosedForm {
    /// The law's id.
    pub(crate) law: &'static str,
    /// The deformation and the quantity, with its unit.
    pub(crate) case: String,
    /// Requirement for the figure.
    pub(crate) asked: Asked,
    /// Computed value.
    pub(crate) got: f64,
}

struct ClosedForms(Vec<ClosedForm>);

impl ClosedForms {
    fn add(&mut self, law: &'static str, case: String, asked: f64, got: f64) {
        let scale = if asked == 0.0 {
            YOUNGS_MODULUS
        } else {
            asked.abs()
        };
        self.0.push(ClosedForm {
            law,
            case,
            asked: Asked::value(asked, TOLERANCE * scale),
            got,
        });
    }
}

/// All closed forms.
///
/// # Errors
///
/// [`LabError`] if one cannot be computed; wrong figures are no error.
pub(crate) fn all() -> Result<Vec<ClosedForm>, LabError> {
    let mut list = ClosedForms(Vec::new());
    uniaxial(&mut list)?;
    shear(&mut list)?;
    dilation(&mut list)?;
    confined(&mut list)?;
    incompressible(&mut list)?;
    inversion(&mut list)?;
    eigenvalues(&mut list)?;
    Ok(list.0)
}

fn law(id: &str) -> Result<Hyperelastic, LabError> {
    let parameters = Hyperelastic::parameters(id, YOUNGS_MODULUS, POISSONS_RATIO)?;
    Ok(Hyperelastic::new(id, &parameters)?)
}

fn uniaxial(list: &mut ClosedForms) -> Result<(), LabError> {
    for (id, stretch, lateral, stress) in UNIAXIAL.iter().copied() {
        let [t, _, p] = pulled(&law(id)?, stretch);
        let case = |what: &str| format!("uniaxial stress, stretch {stretch}: {what}");
        list.add(id, case("lateral stretch"), lateral, t);
        list.add(id, case("nominal stress (Pa)"), stress, p);
    }
    Ok(())
}

fn shear(list: &mut ClosedForms) -> Result<(), LabError> {
    for (id, shear, s12, difference, p21) in SHEAR.iter().copied() {
        let h = Tensor([[0.0, shear, 0.0], [0.0; 3], [0.0; 3]]);
        let p = law(id)?.stress(h);
        let cauchy = p.times_transposed(h + Tensor::identity());
        let case = |what: &str| format!("simple shear {shear}: {what} (Pa)");
        list.add(id, case("Cauchy stress s12"), s12, cauchy.0[0][1]);
        let found = cauchy.0[0][0] - cauchy.0[1][1];
        list.add(id, case("s11 - s22"), difference, found);
        list.add(id, case("nominal stress P21"), p21, p.0[1][0]);
    }
    Ok(())
}

fn dilation(list: &mut ClosedForms) -> Result<(), LabError> {
    for (id, figures) in DILATION.iter().copied() {
        for (stretch, asked) in [0.8, 0.9, 1.1, 1.25].into_iter().zip(figures) {
            let p = law(id)?.stress(stretched([stretch; 3]));
            let case = format!("dilation, stretch {stretch}: P11 (Pa)");
            list.add(id, case, asked, p.0[0][0]);
        }
    }
    Ok(())
}

fn confined(list: &mut ClosedForms) -> Result<(), LabError> {
    let id = "neo-hookean";
    let law = law(id)?;
    for (stretch, asked) in CONFINED.iter().copied() {
        let p = law.stress(stretched([stretch, 1.0, 1.0]));
        let case = format!("confined compression, stretch {stretch}: P11 (Pa)");
        list.add(id, case, asked, p.0[0][0]);
    }
    let change = law.tangent(Tensor::zero(), along_x());
    let case = "confined compression at rest: modulus (Pa)".to_owned();
    list.add(id, case, 13275.862068965518, change.0[0][0]);
    Ok(())
}

fn incompressible(list: &mut ClosedForms) -> Result<(), LabError> {
    for (id, figures) in INCOMPRESSIBLE.iter().copied() {
        for (stretch, asked) in [0.7, 1.5, 2.0].into_iter().zip(figures) {
            let lateral = 1.0 / f64::sqrt(stretch);
            let p = law(id)?.stress(stretched([stretch, lateral, lateral]));
            // The pressure that leaves the sides without force.
            let found = p.0[0][0] - p.0[1][1] * lateral / stretch;
            let case = format!("incompressible uniaxial stress, stretch {stretch}: P11 (Pa)");
            list.add(id, case, asked, found);
        }
    }
    Ok(())
}

fn inversion(list: &mut ClosedForms) -> Result<(), LabError> {
    for (id, stresses, energies) in INVERSION.iter().copied() {
        let law = law(id)?;
        for &(stretch, asked) in stresses {
            let p = law.stress(stretched([stretch, 1.0, 1.0]));
            let case = format!("inversion diag({stretch}, 1, 1): P11 (Pa)");
            list.add(id, case, asked, p.0[0][0]);
        }
        let ends = [("F = 0", [0.0; 3]), ("diag(-1, 1, 1)", [-1.0, 1.0, 1.0])];
        for ((name, stretches), asked) in ends.into_iter().zip(energies) {
            let found = law.energy(stretched(stretches));
            let case = format!("inversion {name}: energy (J/m^3)");
            list.add(id, case, asked, found);
        }
    }
    Ok(())
}

fn eigenvalues(list: &mut ClosedForms) -> Result<(), LabError> {
    let states = [[0.7, 1.0, 1.0], [2.0, 1.0, 1.0], [0.8; 3]];
    for (id, figures) in EIGENVALUES.iter().copied() {
        for (stretches, asked) in states.into_iter().zip(figures) {
            let found = least_eigenvalue(&law(id)?, stretched(stretches));
            let [a, b, c] = stretches;
            let case = format!("diag({a}, {b}, {c}): smallest eigenvalue of the tangent over mu");
            list.add(id, case, asked, found);
        }
    }
    let id = "corotational";
    let mu = law(id)?.lame().1;
    for (stretches, asked) in TWIST.iter().copied() {
        let root = 0.5_f64.sqrt();
        let twist = Tensor([[0.0, root, 0.0], [-root, 0.0, 0.0], [0.0; 3]]);
        let change = law(id)?.tangent(stretched(stretches), twist);
        let [a, b, c] = stretches;
        let case = format!("diag({a}, {b}, {c}): eigenvalue of the twist about z over mu");
        list.add(id, case, asked, twist.contracted(change) / mu);
    }
    Ok(())
}

fn along_x() -> Tensor<f64> {
    Tensor([[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]])
}

//! Closed forms of laws, fibres and relaxation: what is asked, and what the code here gives.
//!
//! E = 3500 Pa and nu = .45 throughout, C1 : C2 = 4 : 1.

mod figures;
mod form;
mod material;
mod memory;

use figures::{
    ACROSS, ALONG, CONFINED, DILATION, EIGENVALUES, INCOMPRESSIBLE, INVERSION, OBLIQUE, SHEAR,
    TWIST, UNIAXIAL,
};
use form::{YOUNGS_MODULUS, table};
use material::{Material, stretched};

pub use form::{ClosedForm, ClosedFormError};

use sinew_fem::hyperelastic::fibres::Fibres;
use sinew_fem::hyperelastic::{Hyperelastic, Tensor};

const POISSONS_RATIO: f64 = 0.45;

const ENERGY: &str = "differences of the energy in 50 digits (xtask/python/law_figures.py)";

/// All closed forms.
///
/// # Errors
///
/// [`ClosedFormError`] where one cannot be computed; wrong figures are no error.
pub fn all() -> Result<Vec<ClosedForm>, ClosedFormError> {
    let mut list = Vec::new();
    uniaxial(&mut list)?;
    shear(&mut list)?;
    dilation(&mut list)?;
    confined(&mut list)?;
    incompressible(&mut list)?;
    inversion(&mut list)?;
    eigenvalues(&mut list)?;
    fibres(&mut list)?;
    memory::relaxation(&mut list)?;
    Ok(list)
}

fn law(id: &str) -> Result<Material, ClosedFormError> {
    let parameters = Hyperelastic::parameters(id, YOUNGS_MODULUS, POISSONS_RATIO)?;
    Ok(Material::new(Hyperelastic::new(id, &parameters)?))
}

fn uniaxial(list: &mut Vec<ClosedForm>) -> Result<(), ClosedFormError> {
    let mut table = table(list, 1e-8, ENERGY);
    for (id, stretch, lateral, stress) in UNIAXIAL.iter().copied() {
        let [t, _, p] = law(id)?.pulled(stretch);
        let case = |what: &str| format!("uniaxial stress, stretch {stretch}: {what}");
        table.add(id, case("lateral stretch"), lateral, t);
        table.add(id, case("nominal stress (Pa)"), stress, p);
    }
    Ok(())
}

fn shear(list: &mut Vec<ClosedForm>) -> Result<(), ClosedFormError> {
    let mut table = table(list, 1e-8, ENERGY);
    for (id, shear, s12, difference, p21) in SHEAR.iter().copied() {
        let h = Tensor([[0.0, shear, 0.0], [0.0; 3], [0.0; 3]]);
        let p = law(id)?.stress(h);
        let cauchy = p.times_transposed(h + Tensor::identity());
        let case = |what: &str| format!("simple shear {shear}: {what} (Pa)");
        table.add(id, case("Cauchy stress s12"), s12, cauchy.0[0][1]);
        let found = cauchy.0[0][0] - cauchy.0[1][1];
        table.add(id, case("s11 - s22"), difference, found);
        table.add(id, case("nominal stress P21"), p21, p.0[1][0]);
    }
    Ok(())
}

fn dilation(list: &mut Vec<ClosedForm>) -> Result<(), ClosedFormError> {
    let mut table = table(list, 1e-8, ENERGY);
    for (id, figures) in DILATION.iter().copied() {
        for (stretch, asked) in [0.8, 0.9, 1.1, 1.25].into_iter().zip(figures) {
            let p = law(id)?.stress(stretched([stretch; 3]));
            let case = format!("dilation, stretch {stretch}: P11 (Pa)");
            table.add(id, case, asked, p.0[0][0]);
        }
    }
    Ok(())
}

fn confined(list: &mut Vec<ClosedForm>) -> Result<(), ClosedFormError> {
    let source = "P = mu (l - 1/l) + lambda (l - 1); modulus at rest lambda + 2 mu";
    let mut table = table(list, 1e-8, source);
    let id = "neo-hookean";
    let material = law(id)?;
    for (stretch, asked) in CONFINED.iter().copied() {
        let p = material.stress(stretched([stretch, 1.0, 1.0]));
        let case = format!("confined compression, stretch {stretch}: P11 (Pa)");
        table.add(id, case, asked, p.0[0][0]);
    }
    let change = material.tangent(Tensor::zero(), along_x());
    let case = "confined compression at rest: modulus (Pa)".to_owned();
    table.add(id, case, 13275.862068965518, change.0[0][0]);
    Ok(())
}

fn incompressible(list: &mut Vec<ClosedForm>) -> Result<(), ClosedFormError> {
    let source = "P = 2 (l - l^-2) (C1 + C2/l) (Treloar, The Physics of Rubber Elasticity, 1975)";
    let mut table = table(list, 1e-8, source);
    for (id, figures) in INCOMPRESSIBLE.iter().copied() {
        for (stretch, asked) in [0.7, 1.5, 2.0].into_iter().zip(figures) {
            let lateral = 1.0 / f64::sqrt(stretch);
            let p = law(id)?.stress(stretched([stretch, lateral, lateral]));
            // The pressure that leaves the sides without force.
            let found = p.0[0][0] - p.0[1][1] * lateral / stretch;
            let case = format!("incompressible uniaxial stress, stretch {stretch}: P11 (Pa)");
            table.add(id, case, asked, found);
        }
    }
    Ok(())
}

fn inversion(list: &mut Vec<ClosedForm>) -> Result<(), ClosedFormError> {
    let mut table = table(list, 1e-8, ENERGY);
    for (id, stresses, energies) in INVERSION.iter().copied() {
        let material = law(id)?;
        for &(stretch, asked) in stresses {
            let p = material.stress(stretched([stretch, 1.0, 1.0]));
            let case = format!("inversion diag({stretch}, 1, 1): P11 (Pa)");
            table.add(id, case, asked, p.0[0][0]);
        }
        let ends = [("F = 0", [0.0; 3]), ("diag(-1, 1, 1)", [-1.0, 1.0, 1.0])];
        for ((name, stretches), asked) in ends.into_iter().zip(energies) {
            let found = material.energy(stretched(stretches));
            let case = format!("inversion {name}: energy (J/m^3)");
            table.add(id, case, asked, found);
        }
    }
    Ok(())
}

fn eigenvalues(list: &mut Vec<ClosedForm>) -> Result<(), ClosedFormError> {
    let mut table = table(list, 1e-8, ENERGY);
    let states = [[0.7, 1.0, 1.0], [2.0, 1.0, 1.0], [0.8; 3]];
    for (id, figures) in EIGENVALUES.iter().copied() {
        for (stretches, asked) in states.into_iter().zip(figures) {
            let found = law(id)?.least_eigenvalue(stretched(stretches));
            let [a, b, c] = stretches;
            let case = format!("diag({a}, {b}, {c}): smallest eigenvalue of the tangent over mu");
            table.add(id, case, asked, found);
        }
    }
    table.source = "2 mu + 2 (lambda (tr S - 3) - 2 mu)/(s_i + s_j) (Smith, de Goes and Kim, ACM \
                    Transactions on Graphics 38(1), 2019)";
    let id = "corotational";
    let mu = law(id)?.mu();
    for (stretches, asked) in TWIST.iter().copied() {
        let root = 0.5_f64.sqrt();
        let twist = Tensor([[0.0, root, 0.0], [-root, 0.0, 0.0], [0.0; 3]]);
        let change = law(id)?.tangent(stretched(stretches), twist);
        let [a, b, c] = stretches;
        let case = format!("diag({a}, {b}, {c}): eigenvalue of the twist about z over mu");
        table.add(id, case, asked, twist.contracted(change) / mu);
    }
    Ok(())
}

fn fibres(list: &mut Vec<ClosedForm>) -> Result<(), ClosedFormError> {
    let mut table = table(list, 1e-7, ENERGY);
    let with = |stiffening, direction| -> Result<Material, ClosedFormError> {
        let fibres = Fibres::new(stiffening)?;
        Ok(law("neo-hookean")?.with_fibres(fibres, direction))
    };
    for (name, stiffening, stretch, lateral, stress) in ALONG.iter().copied() {
        let [t, _, p] = with(stiffening, [1.0, 0.0, 0.0])?.pulled(stretch);
        let case = |what: &str| format!("along the fibres, stretch {stretch}: {what}");
        table.add(name, case("lateral stretch"), lateral, t);
        table.add(name, case("nominal stress (Pa)"), stress, p);
    }
    for (name, stiffening, [along, across, stress]) in ACROSS.iter().copied() {
        let [y, z, p] = with(stiffening, [0.0, 1.0, 0.0])?.pulled(0.9);
        let case = |what: &str| format!("across the fibres, stretch .9: {what}");
        table.add(name, case("stretch along them"), along, y);
        table.add(name, case("other stretch"), across, z);
        table.add(name, case("nominal stress (Pa)"), stress, p);
    }
    let half = 0.5_f64.sqrt();
    for (name, stiffening, [p12, p21, p11, p22]) in OBLIQUE.iter().copied() {
        let h = Tensor([[0.0, 0.5, 0.0], [0.0; 3], [0.0; 3]]);
        let p = with(stiffening, [half, half, 0.0])?.stress(h).0;
        let case = |what: &str| format!("fibres at 45 degrees, simple shear .5: {what} (Pa)");
        table.add(name, case("P12"), p12, p[0][1]);
        table.add(name, case("P21"), p21, p[1][0]);
        table.add(name, case("P11"), p11, p[0][0]);
        table.add(name, case("P22"), p22, p[1][1]);
    }
    Ok(())
}

fn along_x() -> Tensor<f64> {
    Tensor([[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]])
}

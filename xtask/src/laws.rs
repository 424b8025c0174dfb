//! `cargo xtask laws`: energies in 50-digit arithmetic, computed by mpmath from formulas of the literature, compared
//! with the laws here.

use std::process::Stdio;

use serde_json::{Value, json};
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::hyperelastic::{
    Deformation, Hyperelastic, HyperelasticLaw, LawParameter, NeoHookean, Parameters, Tensor,
    sample_deformations,
};
use sinew_scene::output::{OutputFolder, say};

use crate::failure::Failure;
use crate::python::{Packages, Python, last_line};
use crate::repository::root;

const PACKAGES: Packages = Packages {
    needed_by: "laws",
    folder: "laws",
    names: &["mpmath==1.4.1"],
    beside_libraries: false,
};

/// Number of deformations for each law.
const SAMPLES: usize = 40;

const FILE: &str = "laws.json";

pub(crate) fn run() -> Result<(), Failure> {
    let python = Python::with(&PACKAGES, &root().join("target"))?;
    let mut cases = Vec::new();
    for &id in Hyperelastic::IDS {
        cases.push(of_law(id)?);
    }
    cases.extend(of_fibres()?);
    let folder = OutputFolder::new(root().join("target/laws"), &[]);
    folder.check(&[FILE.to_owned()])?;
    let written = folder.write(FILE, Value::from(cases).to_string().as_bytes())?;
    let output = python
        .command()
        .arg(root().join("xtask/python/compare_laws.py"))
        .arg(&written)
        .stdin(Stdio::null())
        .output()
        .map_err(Failure::chore)?;
    let said = String::from_utf8_lossy(&output.stdout);
    say(said.trim_end())?;
    match (output.status.success(), said.is_empty()) {
        (true, _) => Ok(()),
        (false, false) => Err(Failure::Chore(
            "laws differ from their energies in 50 digits".to_owned(),
        )),
        (false, true) => Err(Failure::Chore(last_line(&output))),
    }
}

fn flat(tensor: Tensor<f64>) -> Value {
    tensor.0.concat().into()
}

/// A law's energies, stresses and tangents.
fn of_law(id: &str) -> Result<Value, Failure> {
    let parameters = Hyperelastic::parameters(id, 3500.0, 0.45).map_err(Failure::chore)?;
    let law = Hyperelastic::new(id, &parameters).map_err(Failure::chore)?;
    let samples = law.samples().into_iter().take(SAMPLES);
    let samples = samples.map(|[h, change]| {
        json!({
            "h": flat(h),
            "change": flat(change),
            "energy": law.energy(h),
            "stress": flat(law.stress(h)),
            "tangent": flat(law.tangent(h, change)),
        })
    });
    let mut case = json!({
        "law": id,
        "youngs_modulus": 3500.0,
        "poissons_ratio": "0.45",
        "scale": 3500.0,
        "samples": samples.collect::<Vec<_>>(),
    });
    let moduli = [LawParameter::YOUNGS_MODULUS, LawParameter::POISSONS_RATIO];
    let is_own = |name: &str| moduli.iter().all(|known| known.name != name);
    for (name, values) in parameters.iter().filter(|(name, _)| is_own(name)) {
        case[name] = match values {
            [value] => json!(value),
            list => json!(list),
        };
    }
    Ok(case)
}

/// The same for fibres without a matrix.
fn of_fibres() -> Result<Vec<Value>, Failure> {
    let direction = [0.6, 0.0, -0.8];
    let eta = 2000.0;
    let (k1, k2, dispersion) = (1000.0, 0.3, 0.1);
    let exponential = Fibres::new(Stiffening::Exponential { k1, k2, dispersion });
    let exponential = exponential.map_err(Failure::chore)?;
    let quadratic = Fibres::new(Stiffening::Quadratic { eta }).map_err(Failure::chore)?;
    let exponents = |name: &str, split: bool| json!({ "law": name, "k1": k1, "k2": k2, "dispersion": dispersion, "split": split });
    let sampled = NeoHookean::new(&Parameters::new(3500.0, 0.45)).map_err(Failure::chore)?;
    let families = [
        (quadratic, json!({ "law": "quadratic fibres", "eta": eta })),
        (exponential, exponents("exponential fibres", false)),
        (
            exponential.split(),
            exponents("exponential fibres, split", true),
        ),
    ];
    let cases = families.map(|(fibres, mut case)| {
        let samples = sample_deformations(sampled).take(SAMPLES);
        let samples = samples.map(|[h, change]| {
            let at = fibres.at(&Deformation::of(h), direction);
            json!({
                "h": flat(h),
                "change": flat(change),
                "energy": fibres.energy(&at),
                "stress": flat(fibres.stress(&at)),
                "tangent": flat(fibres.tangent(&at, change)),
            })
        });
        case["direction"] = direction.to_vec().into();
        case["scale"] = eta.into();
        case["samples"] = samples.collect::<Vec<_>>().into();
        case
    });
    Ok(cases.into())
}

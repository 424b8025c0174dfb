//! Networks of springs.

use sinew_fem::springs::springs;
use sinew_fem::{Element, Model, NetworkModulus, SpringRule};
use sinew_mesh::structured::{Split, cube};

use crate::bodies::{self, YOUNGS_MODULUS, of_law};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::places::on_surface;
use crate::subject::Subject;
use crate::vector::{difference, norm};

pub(super) const SUBJECT: Subject = Subject {
    id: "springs",
    title: "Networks of springs",
    says: "Springs along the edges of a cube of 0.1 m with 10 cells a side, E = 3500 Pa: stiffness of those within the body, and the moduli of \
           the continuum that they stand for, over the modulus asked for.",
    checks,
    quoted: &[],
};

const LLOYD: Source = Source::ClosedForm(
    "k = sum 2 sqrt 2/25 E (12 V/sqrt 2)^(1/3), Lloyd, Szekely and Harders, IEEE TVCG 13, 2007",
);
const VAN_GELDER: Source =
    Source::ClosedForm("k = sum E V/l^2, Van Gelder, J. Graph. Tools 3, 1998");

fn checks() -> Vec<Check> {
    let kinds = ["along an axis", "across a face", "across a cell"];
    let of = |rule, stiffness: [f64; 3], source, name: &str| {
        let figures = kinds.into_iter().zip(stiffness);
        let figures =
            figures.map(|(kind, k)| (format!("spring {kind} (N/m)"), Asked::value(k, 0.005)));
        let moduli = moduli(rule).into_iter();
        let case = format!("{name}, Kuhn");
        let figures: Vec<_> = figures.chain(moduli).collect();
        Check::several(case, figures, source, move |_| stiffness_and_moduli(rule))
    };
    vec![
        of(
            SpringRule::Lloyd,
            [26.67, 17.78, 26.67],
            LLOYD,
            "Lloyd's rule",
        ),
        of(
            SpringRule::VanGelder,
            [35.00, 35.0 / 3.0, 35.0 / 3.0],
            VAN_GELDER,
            "Van Gelder's rule",
        ),
    ]
}

/// Names and values of the moduli of a rule.
fn moduli(rule: SpringRule) -> [(String, Asked); 3] {
    let (mean, softest, stiffest) = match rule {
        SpringRule::Lloyd => (Asked::value(1.270, 0.0005), 0.39, 2.86),
        SpringRule::VanGelder => (Asked::value(1.0, 1e-12), 0.35, 1.66),
    };
    [
        ("Voigt's mean of E over E".to_owned(), mean),
        (
            "softest direction over E".to_owned(),
            Asked::value(softest, 0.005),
        ),
        (
            "stiffest direction over E".to_owned(),
            Asked::value(stiffest, 0.005),
        ),
    ]
}

fn stiffness_and_moduli(rule: SpringRule) -> Result<Vec<f64>, LabError> {
    let mesh = cube(10, 0.1, Split::Kuhn)?;
    let surface = on_surface(&mesh);
    let all = springs(&mesh.points, mesh.tets.iter(), YOUNGS_MODULUS, rule);
    let mut found = Vec::new();
    for (squared, count) in [(1.0_f64, 3630), (2.0, 3300), (3.0, 1000)] {
        let length = 0.01 * squared.sqrt();
        let (mut along, mut softest, mut stiffest) = (0, f64::INFINITY, 0.0_f64);
        for spring in &all {
            let [a, b] = spring.nodes.map(|node| mesh.points[node as usize]);
            if (norm(difference(a, b)) / length - 1.0).abs() >= 1e-9 {
                continue;
            }
            along += 1;
            if spring.nodes.iter().all(|node| !surface[*node as usize]) {
                softest = softest.min(spring.stiffness);
                stiffest = stiffest.max(spring.stiffness);
            }
        }
        // Those of a kind are all there, and as stiff as each other.
        let is_whole = along == count && stiffest - softest <= 1e-9 * stiffest;
        found.push(if is_whole { stiffest } else { f64::NAN });
    }
    let problem = of_law(bodies::springs(rule), Element::P1);
    let model = Model::build(&mesh, &problem)?;
    let nothing = NetworkModulus {
        voigt: f64::NAN,
        softest: f64::NAN,
        stiffest: f64::NAN,
    };
    let modulus = model.report().regions[0].network.unwrap_or(nothing);
    found.extend(
        [modulus.voigt, modulus.softest, modulus.stiffest].map(|value| value / YOUNGS_MODULUS),
    );
    Ok(found)
}

//! A block that is bonded to two plates and pressed by 30 %.

use sinew_core::Ramp;
use sinew_fem::{Course, Element, Model, Moving};
use sinew_mesh::structured::{Split, cube};

use crate::check::{Asked, Check};
use crate::error::LabError;
use crate::kinds::Kind;
use crate::quasi_static::{SLOW, follow};
use crate::sources::PROTOTYPE;
use crate::subject::{Quoted, Subject};
use crate::tissue;

pub(super) const SUBJECT: Subject = Subject {
    id: "bonded-block",
    title: "A block bonded to two plates, pressed by 30 %",
    says: "A Kuhn cube of edge 1, neo-hookean with E = 1, top and bottom held in all directions, the top moved down; the force on the top. 10-node \
           tetrahedra with the mean volume of each element, 4 cells a side, are the reference: their figures are quoted, not computed. Plain \
           tetrahedra with nu = .499 are six times too stiff.",
    checks,
    quoted: &[
        Quoted::new(
            "10-node tetrahedra with mean volumes, 4 cells a side",
            "30 %, nu .45/.499",
            "-.4785/-.5169",
        ),
        Quoted::new(
            "10-node tetrahedra with mean volumes, 4 cells a side",
            "1 %, nu .499",
            "-.012582",
        ),
    ],
};

/// Poisson's ratio, element, cells per side, compression (a fraction), force.
const FORCES: &[(f64, Kind, usize, f64, f64)] = &[
    (0.45, Kind::P1, 4, 0.3, -0.6118),
    (0.45, Kind::P1, 8, 0.3, -0.5485),
    (0.45, Kind::Fbar, 4, 0.3, -0.5530),
    (0.45, Kind::Fbar, 8, 0.3, -0.5127),
    (0.45, Kind::Edge(1.0), 4, 0.3, -0.5111),
    (0.45, Kind::Edge(1.0), 8, 0.3, -0.4901),
    (0.499, Kind::P1, 4, 0.3, -3.3075),
    (0.499, Kind::P1, 8, 0.3, -1.6178),
    (0.499, Kind::Fbar, 4, 0.3, -0.6407),
    (0.499, Kind::Fbar, 8, 0.3, -0.5762),
    (0.499, Kind::Edge(1.0), 4, 0.3, -0.5642),
    (0.499, Kind::Edge(1.0), 8, 0.3, -0.5361),
    (0.499, Kind::Edge(0.9), 8, 0.3, -0.5411),
    (0.499, Kind::P1, 4, 0.01, -0.075_382),
    (0.499, Kind::Fbar, 4, 0.01, -0.013_986),
    (0.499, Kind::Edge(1.0), 4, 0.01, -0.012_908),
];

fn checks() -> Vec<Check> {
    let rows = FORCES.iter().map(|&(nu, kind, cells, press, force)| {
        let case = format!(
            "{kind}, {cells} cells a side, nu = {nu}, {} %",
            100.0 * press
        );
        let asked = Asked::relative(force, 0.02);
        Check::one(case, "force on the top", asked, PROTOTYPE, move |_| {
            force_on_top(nu, kind.element(None), cells, press)
        })
    });
    let mut checks: Vec<Check> = rows.collect();
    for (nu, reference) in [(0.45, -0.4785), (0.499, -0.5169)] {
        let figures = [
            (
                "force of 8 cells a side over theirs",
                Asked::value(1.0, 0.05),
            ),
            (
                "the same, extrapolated from 4 and 8 cells by order 2",
                Asked::value(1.0, 0.02),
            ),
        ];
        let case = format!("fbar-edge, edge_share 1, beside 10-node tetrahedra, nu = {nu}, 30 %");
        let check = Check::several(case, figures, PROTOTYPE, move |_| {
            let element = Kind::Edge(1.0).element(None);
            let coarse = force_on_top(nu, element, 4, 0.3)?;
            let fine = force_on_top(nu, element, 8, 0.3)?;
            Ok([fine, fine + (fine - coarse) / 3.0]
                .map(|force| force / reference)
                .into())
        });
        checks.push(check.noted(
            "2 % of the reference are reached in the limit only: at 8 cells a side the prototype itself is off by 2.4 and 3.7 %",
        ));
    }
    checks
}

fn force_on_top(nu: f64, element: Element, cells: usize, press: f64) -> Result<f64, LabError> {
    let law = tissue::law("neo-hookean", 1.0, nu);
    let mut problem = tissue::standing(law, element);
    problem.moves = vec![Moving::new(
        "top",
        [Course::new([0.0, 0.0, -press / SLOW], Ramp::Linear)],
    )];
    let model = Model::build(&cube(cells, 1.0, Split::Kuhn)?, &problem)?;
    let states = follow(&model, 12)?;
    let (state, _) = states.last().ok_or_else(LabError::no_body)?;
    let still = vec![0.0; state.v.len()];
    let [_, _, force] = model.reaction(state.t(), &state.u, &still, &"top".into())?;
    Ok(force)
}

//! A beam that is bent far by a force at its tip, in four equal increments.

use sinew_core::Ramp;
use sinew_fem::{Element, LoadKind, LoadSpec, Model, On};
use sinew_mesh::structured::{Split, block};

use crate::bodies::held;
use crate::check::{Asked, Check};
use crate::error::LabError;
use crate::places::nodes_where;
use crate::quasi_static::{SLOW, follow};
use crate::sources::PROTOTYPE_OF_MOTIONS;
use crate::subject::Subject;
use crate::tissue;

pub(super) const SUBJECT: Subject = Subject {
    id: "bent-beam",
    title: "A beam that is bent far, by Newton's method",
    says: "Ten times as long as thick, 20 x 2 x 2 mirrored cells, nu = .3, held at its root, a force across its tip in four equal parts; \
           lengths over that of the beam. Each part is one equilibrium to 1e-8 of the forces, from that before. The prototype states a \
           force of .65 times 3 E I/L^2, with which the tip rises by .3121 (corotational) and .3122 (neo-hookean); its three digits of rise \
           and way belong to 8/7 of that, which is the force here.",
    checks,
    quoted: &[],
};

/// Force over 3 E I/L^2.
const FORCE: f64 = 0.65 * 8.0 / 7.0;

/// Law, rise of the tip and its displacement along the beam, both over the length, if known.
const TIPS: &[(&str, Option<[f64; 2]>)] = &[
    ("corotational", Some([0.347_27, -0.074_70])),
    ("neo-hookean", Some([0.347_46, f64::NAN])),
    ("stvk", None),
    ("stable-neo-hookean", None),
];

fn checks() -> Vec<Check> {
    let rows = TIPS.iter().map(|&(id, tip)| {
        let parts = [1, 2, 3, 4].map(|part| {
            let figure = format!("Newton iterations of part {part}");
            (figure, Asked::value(7.0, 1.0))
        });
        let names = ["rise of the tip", "way of the tip along the beam"];
        let tips = tip
            .into_iter()
            .flat_map(move |tip| names.into_iter().zip(tip));
        let tips = tips.filter(|(_, figure)| figure.is_finite());
        let tips: Vec<_> = tips
            .map(|(name, figure)| (name.to_owned(), Asked::value(figure, 1e-4)))
            .collect();
        let known = tips.len();
        let figures = parts.into_iter().chain(tips);
        let check = Check::several(id, figures, PROTOTYPE_OF_MOTIONS, move |_| {
            let (iterations, tip) = bent(id)?;
            let mut figures: Vec<f64> = iterations.into_iter().map(|count| count as f64).collect();
            figures.extend(&tip[..known]);
            Ok(figures)
        });
        check.noted("at 8/7 of the force that the prototype states")
    });
    rows.collect()
}

/// Newton iterations of each increment, and rise and displacement of the tip, the mean of its nodes.
fn bent(id: &'static str) -> Result<(Vec<u64>, [f64; 2]), LabError> {
    const THICK: f64 = 0.1;
    let mesh = block([20, 2, 2], [1.0, THICK, THICK], Split::Mirrored)?;
    let tip = nodes_where(&mesh, |[x, _, _]| x > 1.0 - 1e-9);
    let root = nodes_where(&mesh, |[x, _, _]| x < 1e-9);
    let youngs_modulus = tissue::YOUNGS_MODULUS;
    let inertia = THICK.powi(4) / 12.0;
    let mut problem = tissue::free(tissue::law(id, youngs_modulus, 0.3), Element::P1);
    problem.fixed = vec![held(On::Nodes(root), [true; 3])];
    problem.loads = vec![
        LoadSpec::new(
            On::Nodes(tip.clone()),
            LoadKind::Force([0.0, 0.0, FORCE * 3.0 * youngs_modulus * inertia]),
        )
        .with_ramp(Ramp::Table {
            times: vec![0.0, SLOW],
            values: vec![0.0, 1.0],
        }),
    ];
    let model = Model::build(&mesh, &problem)?;
    let states = follow(&model, 4)?;
    let (last, _) = states.last().ok_or_else(LabError::no_body)?;
    let mut field = vec![[0.0; 3]; mesh.points.len()];
    model.to_nodes(&last.u, &mut field)?;
    let mean = |axis: usize| {
        let sum: f64 = tip.iter().map(|node| field[*node as usize][axis]).sum();
        sum / tip.len() as f64
    };
    let iterations = states.iter().map(|(_, count)| *count).collect();
    Ok((iterations, [mean(2), mean(0)]))
}

//! The program of a scene's integrator as JSON.

use serde_json::{Value, json};
use sinew_cnn::{
    Clamp, Forces, LoadAt, Loads, OwnTerm, Product, Program, Quotient, Sweep, Update, Weight, When,
};
use sinew_core::{Acceleration, VelocityTime};

/// The program, or `null` and why it is absent. Loads are counted from 1.
pub(super) fn object(id: &str, dt: f64, program: Option<&Program>, because: &'static str) -> Value {
    let reason = program.is_none().then_some(because);
    json!({
        "integrator": id,
        "dt_s": dt,
        "part_s": program.map(|program| dt / f64::from(program.repeats)),
        "program": program.map(of_program),
        "reason": reason,
    })
}

fn of_program(program: &Program) -> Value {
    let sweeps = |sweeps: &[Sweep]| -> Vec<Value> {
        sweeps
            .iter()
            .map(|sweep| of_sweep(program, sweep))
            .collect()
    };
    let entry = program.entry.iter();
    let traffic = program.traffic();
    json!({
        "registers": program.registers(),
        "entry": entry.map(|update| of_update(program, update)).collect::<Vec<_>>(),
        "start": sweeps(&program.start),
        "step": sweeps(&program.step),
        "repeats": program.repeats,
        "velocity": match program.velocity {
            VelocityTime::Same => "end",
            VelocityTime::MiddleOfStep => "middle",
            VelocityTime::MeanOverStep => "mean over the step",
        },
        "acceleration": match program.acceleration {
            Acceleration::None => None,
            Acceleration::Same => Some("end"),
            Acceleration::Kick => Some("kick"),
        },
        "limits_m_s": program.limits.as_deref(),
        "p_inverse_per_kg": program.blocks.as_ref().map(|blocks| {
            let of_cell = blocks.entries().chunks(blocks.layers() * blocks.layers());
            of_cell.collect::<Vec<_>>()
        }),
        "moments": program.moments.as_deref().map(|moments| json!({
            "times_s": moments.times,
            "weights": moments.weights,
        })),
        "a_step": {
            "products": program.products_a_step(),
            "passes": program.passes_a_step(),
            "of_the_caller": {
                "vectors_read": traffic.read,
                "vectors_written": traffic.written,
                "products": traffic.products,
            },
        },
    })
}

fn of_sweep(program: &Program, sweep: &Sweep) -> Value {
    let product =
        |product: &Product| json!({ "factor": product.factor, "of": program.name(product.source) });
    let own = sweep.own.iter().map(
        |OwnTerm {
             register,
             plain,
             per_mass,
         }| {
            json!({ "of": program.name(*register), "plain": plain, "per_mass": per_mass })
        },
    );
    let (stiffness, dashpots, internal) = match &sweep.forces {
        Forces::Products {
            stiffness,
            dashpots,
        } => (
            stiffness.as_ref().map(product),
            dashpots.as_ref().map(product),
            None,
        ),
        Forces::Internal { u, v } => {
            let of = [program.name(*u), program.name(*v)];
            (None, None, Some(of))
        }
    };
    json!({
        "when": match sweep.when {
            When::Always => json!("always"),
            When::LoadChanges(load) => json!({ "load_changes": load + 1 }),
            When::LoadsJump => json!("loads_jump"),
        },
        "loads": match sweep.loads {
            Loads::None => Value::Null,
            Loads::All { factor, at } => json!({ "factor": factor, "at": of_instant(at) }),
            Loads::HalfJump => json!("half_jump"),
            Loads::One(load) => json!({ "load": load + 1 }),
        },
        "minus_stiffness": stiffness,
        "minus_dashpots": dashpots,
        "minus_internal_force": internal,
        "own": own.collect::<Vec<_>>(),
        "over": match sweep.quotient {
            Quotient::Plain => Value::Null,
            Quotient::Mass => json!("mass"),
            Quotient::Blocks => json!("blocks"),
        },
        "updates": sweep.updates.iter().map(|update| of_update(program, update)).collect::<Vec<_>>(),
    })
}

fn of_instant(at: LoadAt) -> Value {
    match at {
        LoadAt::StartOf => json!("start"),
        LoadAt::Within(share) => json!({ "share_of_step": share }),
        LoadAt::Around => json!("around"),
        LoadAt::From => json!("from"),
        LoadAt::Smooth => json!("smooth"),
    }
}

fn of_update(program: &Program, update: &Update) -> Value {
    let terms = update.terms.iter().map(|term| match term.weight {
        Weight::Number(weight) => json!({ "of": program.name(term.register), "weight": weight }),
        Weight::OfLoad { load, moment } => {
            json!({ "of": program.name(term.register), "moment": moment, "of_load": load + 1 })
        }
    });
    json!({
        "target": program.name(update.target),
        "terms": terms.collect::<Vec<_>>(),
        "of_q": update.of_q,
        "clamp": match update.clamp {
            None => Value::Null,
            Some(Clamp::Component(limit)) => json!({ "component": limit }),
            Some(Clamp::Vector { from, factor }) => json!({
                "vector_from": from.map(|from| program.name(from)),
                "times_limit": factor,
            }),
        },
        "last_step_only": update.last_only,
    })
}

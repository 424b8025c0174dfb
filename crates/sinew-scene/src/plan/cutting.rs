//! The section about cuts.

use std::sync::Arc;

use sinew_core::LinearSystem;
use sinew_core::spectrum::Spectrum;
use sinew_fem::Model;

use crate::number::short;
use crate::scene::{Blade, Body, Cutting, LoosePieces};
use crate::simulation::BodyModel;

/// Cutting tools, and the bound of stable steps under cuts; empty for a body that is not cut.
pub(super) fn lines(body: &Body, built: &BodyModel) -> Vec<String> {
    let Some(cutting) = &body.cutting else {
        return Vec::new();
    };
    vec![what(body, cutting), step(built)]
}

fn what(body: &Body, cutting: &Cutting) -> String {
    let name = |tool: usize| {
        let tool = body.tools.get(tool);
        tool.map_or("", |tool| tool.name.as_str())
    };
    let mut text = match &cutting.blade {
        Blade::None => "by commands".to_owned(),
        Blade::Table(path) => format!("by {}", path.display()),
        Blade::Tool(tool) => format!("by `{}`", name(*tool)),
    };
    if let Some(tool) = cutting.remove {
        text.push_str(&format!(", and `{}` takes away what is in it", name(tool)));
    }
    if cutting.snap > 0.0 {
        let snap = short(cutting.snap);
        text.push_str(&format!(
            ", nodes within {snap} of an edge are moved onto cuts"
        ));
    }
    if cutting.toughness > 0.0 {
        let toughness = short(cutting.toughness);
        text.push_str(&format!(", {toughness} J/m2 of the blade's work"));
    }
    match cutting.pieces {
        LoosePieces::Fall => text,
        LoosePieces::Freeze => format!("{text}, loose pieces rest where they came off"),
        LoosePieces::Remove => format!("{text}, loose pieces are taken away"),
    }
}

fn step(built: &BodyModel) -> String {
    let operators = built.model.operators();
    let own = Model::build_on(Arc::clone(&built.mesh), &built.problem);
    match (operators.element_bounds(), own) {
        (Some(bounds), Ok(own)) => format!(
            "2/omega of single tetrahedra bounds steps before and after any cut: {} s; that of the whole body is {} s",
            short(2.0 / bounds.omega_max),
            short(Spectrum::of(own.operators()).critical_step())
        ),
        _ => "no bound by single tetrahedra holds for this law or element: stable steps are estimated again after each cut".to_owned(),
    }
}

//! Quantities as text.

use sinew_measure::convergence::{Quantity, Subject, When};

pub(super) fn subject(quantity: &Quantity) -> String {
    let subject = match &quantity.subject {
        Subject::Displacement => "u, all nodes".to_owned(),
        Subject::Probe(name) => name.clone(),
        Subject::Force(name) => format!("force on {name}"),
        Subject::ElasticEnergy => "elastic energy".to_owned(),
    };
    match quantity.when {
        When::Run => subject,
        When::Rest => format!("{subject}, at rest"),
    }
}

pub(super) fn unit(subject: &Subject) -> &'static str {
    match subject {
        Subject::Displacement | Subject::Probe(_) => "m",
        Subject::Force(_) => "N",
        Subject::ElasticEnergy => "J",
    }
}

//! Variants that are measured on each body.

use sinew_machines::{Kind, PrecisionName};

/// Machine, precision and threads of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variant {
    pub(super) kind: Kind,
    pub(super) precision: PrecisionName,
    pub(super) threads: usize,
}

/// All machines, precisions and numbers of threads.
pub(super) fn variants() -> Vec<Variant> {
    let most = sinew_machines::Threads::All.most();
    let mut variants = Vec::new();
    for kind in [Kind::GENERAL, Kind::REPEATED] {
        for precision in [PrecisionName::F64, PrecisionName::F32] {
            let several = (most > 1).then_some(most);
            for threads in [Some(1), several].into_iter().flatten() {
                variants.push(Variant {
                    kind,
                    precision,
                    threads,
                });
            }
        }
    }
    variants
}

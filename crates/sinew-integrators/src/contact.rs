//! Methods whose steps tools can push.

use crate::cnn::{CnnStabilised, CnnSymplectic};
use crate::explicit::{CentralDifference, SymplecticEuler};
use crate::{Explicit, Scheme};

/// Their ids, in words.
pub(crate) fn methods_with_contact() -> String {
    let ids = [
        <CentralDifference as Explicit>::ID,
        <SymplecticEuler as Explicit>::ID,
        <CnnSymplectic as Explicit>::ID,
    ];
    let quoted = ids.map(|id| format!("`{id}`")).join(", ");
    let blocks = <CnnStabilised as Scheme>::ID;
    format!("{quoted}, or `{blocks}` with one block for each cell")
}

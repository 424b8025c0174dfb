//! Differences of tables.

use std::path::Path;

use super::outcome::{CompareError, Comparison, Difference, damaged, read, relative};
use super::places;
use crate::csv::Table;
use crate::tables::{ENERGY, PROBES};

/// Columns that belong to one quantity: a vector's components, or one column.
struct Quantity {
    name: String,
    unit: String,
    columns: Vec<[usize; 2]>,
}

/// Ends of the names of the components of vectors and tensors.
const COMPONENTS: [&str; 9] = ["_x", "_y", "_z", "_xx", "_yy", "_zz", "_xy", "_yz", "_zx"];

/// Compares a table that both results may have.
pub(super) fn compare(
    comparison: &mut Comparison,
    name: &'static str,
    one: &Path,
    other: &Path,
) -> Result<(), CompareError> {
    match (one.join(name).exists(), other.join(name).exists()) {
        (true, true) => {}
        (false, false) => return Ok(()),
        _ => {
            comparison.left_out.push(format!("only one has {name}"));
            return Ok(());
        }
    }
    if name == PROBES {
        let (one, other) = (read(one, name)?, read(other, name)?);
        let texts = [&one, &other].map(|bytes| String::from_utf8_lossy(bytes));
        places::probes(comparison, &texts[0], &texts[1]);
    }
    let (one, other) = (table(one, name)?, table(other, name)?);
    let quantities = quantities(&one, &other);
    let alone = |a: &Table, b: &Table| {
        a.names
            .iter()
            .filter(|name| !b.names.contains(name))
            .count()
    };
    let alone = alone(&one, &other) + alone(&other, &one);
    if alone > 0 {
        comparison
            .left_out
            .push(format!("{name}: {alone} columns are in one of them only"));
    }
    let mut beyond = 0;
    let mut found: Vec<(f64, f64, f64)> = vec![(0.0, 0.0, 0.0); quantities.len()];
    for row in &one.rows {
        let Some(others) = other.at(row[0]) else {
            beyond += 1;
            continue;
        };
        for (quantity, (largest, t, size)) in quantities.iter().zip(&mut found) {
            let columns = quantity.columns.iter();
            let length = |of: &dyn Fn(&[usize; 2]) -> f64| {
                columns.clone().map(|c| of(c).powi(2)).sum::<f64>().sqrt()
            };
            let difference = length(&|[a, b]| row[*a] - others[*b]);
            *size = size.max(length(&|[a, _]| row[*a]));
            if difference > *largest || difference.is_nan() {
                (*largest, *t) = (difference, row[0]);
            }
        }
    }
    if beyond > 0 {
        comparison.left_out.push(format!(
            "{name}: {beyond} rows of the first are beyond those of the second"
        ));
    }
    if name == ENERGY {
        // Energies are parts of one balance: what remains of it is small beside them, not beside itself.
        let size = found.iter().map(|(.., size)| *size).fold(0.0, f64::max);
        found.iter_mut().for_each(|(.., own)| *own = size);
    }
    let differences = quantities.into_iter().zip(found);
    comparison.differences.extend(
        differences.map(|(quantity, (largest, t, size))| Difference {
            of: name,
            what: quantity.name,
            unit: quantity.unit,
            largest,
            relative: relative(largest, size),
            t,
            node: None,
        }),
    );
    Ok(())
}

/// The quantities that both tables have.
fn quantities(one: &Table, other: &Table) -> Vec<Quantity> {
    let mut quantities: Vec<Quantity> = Vec::new();
    for (place, column) in one.names.iter().enumerate().skip(1) {
        let Some(counterpart) = other.names.iter().position(|name| name == column) else {
            continue;
        };
        let (name, unit) = match column.strip_suffix("_m_per_s") {
            Some(name) => (name, "m/s"),
            None => column.rsplit_once('_').unwrap_or((column, "")),
        };
        let component = COMPONENTS
            .iter()
            .find_map(|component| name.strip_suffix(component));
        let name = component.unwrap_or(name);
        match quantities.iter_mut().find(|quantity| quantity.name == name) {
            Some(quantity) => quantity.columns.push([place, counterpart]),
            None => quantities.push(Quantity {
                name: name.to_owned(),
                unit: unit.to_owned(),
                columns: vec![[place, counterpart]],
            }),
        }
    }
    quantities
}

fn table(folder: &Path, name: &str) -> Result<Table, CompareError> {
    let content = read(folder, name)?;
    let table = Table::parse(&String::from_utf8_lossy(&content));
    table.map_err(|reason| damaged(&folder.join(name), reason))
}

//! The definition of a sweep, taken literally in f64.

use sinew_sparse::sweep::{CellMap, Clamp, Fields, Precision, Quotient};

use super::rows::Case;

/// The vectors of all cells: by vector, cell and layer.
pub(crate) struct Dense<'a, T> {
    case: &'a Case<T>,
    values: Vec<Vec<Vec<f64>>>,
}

impl<'a, T: Precision> Dense<'a, T> {
    /// The vectors at the beginning of a test.
    pub(crate) fn of(case: &'a Case<T>) -> Self {
        let layers = 0..case.layers;
        let cell = |field, cell| {
            layers
                .clone()
                .map(|layer| case.value(field, layer, cell))
                .collect()
        };
        let field = |field| (0..case.cells()).map(|at| cell(field, at)).collect();
        let values = (0..case.fields()).map(field).collect();
        Self { case, values }
    }

    /// Runs a sweep; returns the number of values that a clamp bounded.
    pub(crate) fn sweep(&mut self, map: &CellMap<T>) -> u64 {
        let q: Vec<Vec<f64>> = (0..self.case.cells())
            .map(|cell| self.q(map, cell))
            .collect();
        let mut reached = 0;
        for (cell, q) in q.iter().enumerate() {
            for update in &map.updates {
                let mut value: Vec<f64> = q.iter().map(|q| update.of_q.to_f64() * q).collect();
                for (weight, field) in &update.terms {
                    for (value, term) in value.iter_mut().zip(self.at(*field, cell)) {
                        *value += weight.to_f64() * term;
                    }
                }
                reached += match update.clamp {
                    None => 0,
                    Some(Clamp::Component(limit)) => bound_components(&mut value, limit.to_f64()),
                    Some(Clamp::Vector {
                        from,
                        factor,
                        limits,
                    }) => {
                        let from = from
                            .map_or(vec![0.0; value.len()], |from| self.at(from, cell).to_vec());
                        let limit = factor.to_f64() * self.at(limits, cell)[0];
                        bound_vector(&mut value, &from, limit)
                    }
                };
                self.values[update.target as usize][cell] = value;
            }
        }
        reached
    }

    fn at(&self, field: u32, cell: usize) -> &[f64] {
        &self.values[field as usize][cell]
    }

    fn q(&self, map: &CellMap<T>, cell: usize) -> Vec<f64> {
        let layers = self.case.layers;
        let mut rho = vec![0.0; layers];
        if let Some(forces) = map.forces {
            rho.copy_from_slice(self.at(forces, cell));
        }
        for product in &map.products {
            for (column, block) in self.case.matrices[product.matrix].row_blocks(cell) {
                let x = self.at(product.source, column);
                for i in 0..layers {
                    for j in 0..layers {
                        rho[i] -= product.factor.to_f64() * block[layers * i + j] * x[j];
                    }
                }
            }
        }
        let mass = |field: u32, layer: usize| self.at(field, cell)[layer];
        for own in &map.own {
            for (layer, rho) in rho.iter_mut().enumerate() {
                let m = match map.quotient {
                    Quotient::Plain { mass: field, .. } | Quotient::Blocks { mass: field, .. } => {
                        mass(field, layer)
                    }
                    Quotient::Mass { inverse } => 1.0 / mass(inverse, layer),
                };
                let factor = own.plain.to_f64() + own.per_mass.to_f64() * m;
                *rho += factor * self.at(own.field, cell)[layer];
            }
        }
        match map.quotient {
            Quotient::Plain { .. } => rho,
            Quotient::Mass { inverse } => rho
                .iter()
                .enumerate()
                .map(|(layer, rho)| rho * mass(inverse, layer))
                .collect(),
            Quotient::Blocks { rows, .. } => (0..layers)
                .map(|i| {
                    let row = self.at(rows + i as u32, cell).iter();
                    row.zip(&rho).map(|(entry, rho)| entry * rho).sum()
                })
                .collect(),
        }
    }

    /// The largest difference at a cell, over all vectors, relative to the largest value.
    pub(crate) fn difference(&self, case: &Case<T>, found: &mut Fields<T>) -> f64 {
        let (mut off, mut size): (f64, f64) = (0.0, 0.0);
        for (field, cells) in self.values.iter().enumerate() {
            for (cell, layers) in cells.iter().enumerate() {
                for (layer, expected) in layers.iter().enumerate() {
                    let difference = expected - case.found(found, field, layer, cell);
                    assert!(!difference.is_nan());
                    off = off.max(difference.abs());
                    size = size.max(expected.abs());
                }
            }
        }
        off / size
    }
}

fn bound_components(values: &mut [f64], limit: f64) -> u64 {
    let mut reached = 0;
    for value in values {
        if value.abs() >= limit {
            *value = limit.copysign(*value);
            reached += 1;
        }
    }
    reached
}

fn bound_vector(values: &mut [f64], from: &[f64], limit: f64) -> u64 {
    let pairs = values.iter().zip(from);
    let length = pairs
        .map(|(x, from)| (x - from).powi(2))
        .sum::<f64>()
        .sqrt();
    if length <= limit {
        return 0;
    }
    for (x, from) in values.iter_mut().zip(from) {
        *x = from + (*x - from) * limit / length;
    }
    values.len() as u64
}

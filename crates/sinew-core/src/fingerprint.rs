//! Fingerprints, by which another process recognises a body.

use sinew_sparse::BlockMatrix;

use crate::hash::Hash;
use crate::operators::LinearOperators;
use crate::system::{Equations, System};

impl<'s> dyn System + 's {
    /// Fingerprint by which another process recognises a body: of its masses and layers, the number
    /// of its internal variables and its matrices or its law. Loads do not change it. A body
    /// built in the same way has the same fingerprint; that of matrices is computed once.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Hash::new();
        let counts = [
            self.dofs(),
            self.layers().count(),
            self.internal_variables(),
        ];
        for count in counts {
            hash.add(&(count as u64).to_le_bytes());
        }
        match self.as_linear() {
            Some(linear) => {
                let of_matrices = linear.operators().derived(OfMatrices::new);
                hash.add(&of_matrices.0.to_le_bytes());
            }
            None => {
                add_numbers(&mut hash, self.mass());
                if let Equations::Forces(law) = self.equations() {
                    hash.add(&law.fingerprint().to_le_bytes());
                }
            }
        }
        hash.value()
    }
}

struct OfMatrices(u64);

impl OfMatrices {
    fn new(operators: &LinearOperators) -> Self {
        let mut hash = Hash::new();
        add_numbers(&mut hash, operators.mass());
        let damping = operators.damping();
        add_numbers(&mut hash, &[damping.mass, damping.stiffness]);
        add_matrix(&mut hash, operators.stiffness());
        if let Some(extra) = &damping.extra {
            add_matrix(&mut hash, extra);
        }
        Self(hash.value())
    }
}

fn add_numbers(hash: &mut Hash, numbers: &[f64]) {
    for number in numbers {
        hash.add(&number.to_le_bytes());
    }
}

fn add_matrix(hash: &mut Hash, matrix: &BlockMatrix) {
    for row in 0..matrix.pattern().cells() {
        for (column, block) in matrix.row_blocks(row) {
            for place in [row, column] {
                hash.add(&(place as u64).to_le_bytes());
            }
            add_numbers(hash, block);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{Damping, Layers, LinearModel, LinearSystem, Load, Pattern, Ramp};

    /// A chain of three masses, with something changed.
    fn chain(change: usize) -> LinearModel {
        let differs = |number: usize| f64::from(u8::from(change == number));
        let elements = match change {
            1 => vec![vec![0, 1], vec![1, 2], vec![0, 2]],
            _ => vec![vec![0, 1], vec![1, 2]],
        };
        let pattern = Arc::new(Pattern::from_elements(3, elements).unwrap());
        let mut stiffness = BlockMatrix::zeros(Arc::clone(&pattern), Layers::One);
        let k = 200.0 + 1e-9 * differs(2);
        stiffness.add_element(&[0, 1], &[k, -k, -k, k]).unwrap();
        let damping = Damping {
            mass: differs(3),
            stiffness: differs(4),
            extra: (change == 5).then(|| Arc::new(stiffness.clone())),
        };
        let mass = vec![0.5, 0.3, 0.7 + differs(6)];
        let operators = LinearOperators::new(mass, stiffness, damping, Vec::new()).unwrap();
        LinearModel::new(operators)
    }

    fn of(model: &LinearModel) -> u64 {
        (model as &dyn System).fingerprint()
    }

    #[test]
    fn a_body_built_again_is_known_and_any_other_is_not() {
        let own = of(&chain(0));
        assert_eq!(own, of(&chain(0)));
        for change in 1..=6 {
            assert_ne!(own, of(&chain(change)), "change {change}");
        }
    }

    #[test]
    fn other_loads_leave_it() {
        let model = chain(0);
        let own = of(&model);
        let load = Load {
            ramp: Ramp::Step,
            entries: vec![(0, 1.0)],
        };
        let loaded = LinearSystem::operators(&model)
            .with_loads(vec![load])
            .unwrap();
        assert_eq!(own, of(&LinearModel::new(loaded)));
    }
}

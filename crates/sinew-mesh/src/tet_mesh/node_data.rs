//! Values at nodes.

/// Values at the nodes, from one array of the file (`$NodeData` of gmsh, point data of VTK).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NodeData {
    /// Name of the array.
    pub name: String,
    /// Number of the time step.
    pub step: i32,
    /// Values per node.
    pub components: usize,
    /// `components` values for each node in turn; NaN if the file gives none.
    pub values: Vec<f64>,
}

impl NodeData {
    /// The values of each node in turn.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> + Clone {
        self.values.chunks_exact(self.components.max(1))
    }

    /// The same at these nodes.
    pub(super) fn at(&self, nodes: impl Iterator<Item = usize>) -> NodeData {
        let width = self.components.max(1);
        let rows = nodes.filter_map(|node| self.values.get(node * width..(node + 1) * width));
        NodeData {
            values: rows.flatten().copied().collect(),
            name: self.name.clone(),
            ..*self
        }
    }

    /// Adds a node with the values of another.
    pub(super) fn copy(&mut self, node: usize) {
        let width = self.components.max(1);
        if (node + 1) * width <= self.values.len() {
            self.values
                .extend_from_within(node * width..(node + 1) * width);
        }
    }

    /// The same with a node in the middle of each edge: the mean of both ends or, if all values are whole numbers and
    /// so may be labels, the common value of both ends, and NaN if they differ.
    pub(super) fn refined(&self, edges: &[[u32; 2]]) -> NodeData {
        let may_be_labels = self.values.iter().all(|x| x.is_nan() || x.fract() == 0.0);
        let middle = |a: f64, b: f64| match may_be_labels {
            true if a == b => a,
            true => f64::NAN,
            false => f64::midpoint(a, b),
        };
        let mut data = self.clone();
        let width = self.components.max(1);
        for [a, b] in edges {
            for component in 0..width {
                let value = |node: &u32| self.values.get(*node as usize * width + component);
                data.values
                    .extend(value(a).zip(value(b)).map(|(a, b)| middle(*a, *b)));
            }
        }
        data
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refined(values: &[f64]) -> Vec<f64> {
        let data = NodeData {
            components: 1,
            values: values.to_vec(),
            ..NodeData::default()
        };
        data.refined(&[[0, 1], [1, 2]]).values[3..].to_vec()
    }

    #[test]
    fn a_label_between_two_others_is_none() {
        assert_eq!(refined(&[0.5, 1.0, 3.0]), [0.75, 2.0]);
        let labels = refined(&[1.0, 1.0, 3.0]);
        assert_eq!(labels[0], 1.0);
        assert!(labels[1].is_nan());
    }
}

//! Cellular neural networks of linear structural systems: templates A, B, C and the saturated output

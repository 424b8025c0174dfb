//! Cases x integrators x steps: error, cost and stability verdicts, as JSON, tables, SVG and HTML.

pub mod results;

//! Instances of parts in an assembly.

use super::lines::{Data, coordinate};
use super::part::Part;
use crate::reading::fault::Fault;

/// An instance, of which a file may have one.
#[derive(Default)]
pub(super) struct Instance {
    pub(super) name: String,
    pub(super) part: String,
    pub(super) offset: usize,
    pub(super) translation: [f64; 3],
    /// Lines of data that have been read: the first one is a translation, the second a rotation.
    pub(super) lines: usize,
    /// Nodes, elements and sets that are defined inside the instance.
    pub(super) own: Part,
}

impl Instance {
    /// Reads a line of data after `*INSTANCE`.
    pub(super) fn data(&mut self, data: Data<'_>) -> Result<(), Fault> {
        self.lines += 1;
        if self.lines == 1 {
            let coordinates = self.translation.iter_mut().zip(data.fields());
            for (value, field) in coordinates {
                *value = coordinate(field, "the translation")?;
            }
            return Ok(());
        }
        let angle = data.fields().nth(6);
        let angle = angle
            .map(|field| coordinate(field, "the angle"))
            .transpose()?;
        if angle.is_some_and(|angle| angle != 0.0) {
            let problem = "the instance is turned";
            let advice = "give the part the orientation of the instance; a scene turns a mesh by rotate = { .. } in [mesh]";
            return Err(Fault::unsupported(data.offset, problem, advice));
        }
        Ok(())
    }
}

//! Messages between a page and the simulation.
//!
//! A page sends text, a JSON object for each command, and four bytes of credit for each picture that it has drawn: the
//! microseconds until it draws again, little-endian. It receives text, a JSON object for each event, and binary
//! pictures; the surfaces of pictures are sent before the first of them.

mod command;
mod event;
mod frame;

pub(crate) use command::{Field, Order, Said, Shape};
pub(crate) use event::{
    Event, Hertz, IntegratorFacts, LoadFacts, NumberFacts, OptionFacts, PaneFacts, PartFacts,
    Scenery, Stability, StepFacts, ToolFacts,
};
pub(crate) use frame::{
    APPLIED_AT, CutHead, FrameHead, FrameWriter, NONE, PaneHead, SectionHead, SurfaceShape,
    ToolHead, is_frame, topology,
};

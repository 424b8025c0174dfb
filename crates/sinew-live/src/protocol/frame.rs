//! Pictures in binary, little-endian, each part at a multiple of eight bytes.
//!
//! A topology is the surface of each pane's body at rest, and is sent before the first picture that belongs to it. A picture is a head of 32 bytes, then
//! for each pane its numbers, its tools, its points, and the corners of the triangles of a section, three for each. `page/src/frames.js` reads both.

/// Kind of a topology.
const TOPOLOGY: u32 = 0;

/// Kind of a picture.
const PICTURE: u32 = 1;

/// True if a message is a picture.
pub(crate) fn is_frame(message: &[u8]) -> bool {
    message.starts_with(&PICTURE.to_le_bytes())
}

/// Offset of the number of the last command in a picture, which differs for each client.
pub(crate) const APPLIED_AT: usize = 8;

/// Number of bytes of the head of a picture.
const HEAD: usize = 32;

/// Number of bytes of the numbers of a pane.
const PANE: usize = 240;

/// Number of bytes of a tool.
const TOOL: usize = 136;

/// The surface of a pane's body at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceShape<'a> {
    /// Positions (m) of its points.
    pub(crate) points: &'a [[f64; 3]],
    /// Outward triangles between points.
    pub(crate) triangles: &'a [[u32; 3]],
    /// Number of triangles, the first ones, that belong to the body before all cuts.
    pub(crate) outer: usize,
    /// Corresponding point of the other pane's surface for each point, or [`NONE`].
    pub(crate) twins: &'a [u32],
}

/// Marks a node or a point without a counterpart in another body or surface.
pub(crate) const NONE: u32 = u32::MAX;

/// The surfaces of all panes for the pictures of this epoch.
pub(crate) fn topology(epoch: u32, surfaces: &[SurfaceShape<'_>]) -> Vec<u8> {
    let size = |surface: &SurfaceShape<'_>| {
        rounded_up(16 + 16 * surface.points.len() + 12 * surface.triangles.len())
    };
    let mut out = Vec::with_capacity(16 + surfaces.iter().map(size).sum::<usize>());
    for number in [TOPOLOGY, epoch, surfaces.len() as u32, 0] {
        out.extend(number.to_le_bytes());
    }
    for surface in surfaces {
        let counts = [
            surface.points.len(),
            surface.triangles.len(),
            surface.outer,
            0,
        ];
        for count in counts {
            out.extend((count as u32).to_le_bytes());
        }
        for coordinate in surface.points.as_flattened() {
            out.extend((*coordinate as f32).to_le_bytes());
        }
        let corners = surface.triangles.as_flattened();
        for number in corners.iter().chain(surface.twins) {
            out.extend(number.to_le_bytes());
        }
        out.resize(rounded_up(out.len()), 0);
    }
    out
}

/// Head of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameHead {
    /// Number of the picture.
    pub(crate) frame: u32,
    /// Topology to which its points belong.
    pub(crate) epoch: u32,
    /// Number of panes.
    pub(crate) panes: u32,
    /// Field shown as colours.
    pub(crate) field: u32,
    /// Simulated time over wall time.
    pub(crate) pace: f64,
}

/// Numbers of a pane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PaneHead {
    /// Number of steps so far.
    pub(crate) step: u64,
    /// Simulated time (s).
    pub(crate) t: f64,
    /// Step (s).
    pub(crate) dt: f64,
    /// Kinetic energy (J).
    pub(crate) kinetic: f64,
    /// Elastic energy (J).
    pub(crate) elastic: f64,
    /// Work of tools (J).
    pub(crate) tool_work: f64,
    /// Work of loads (J).
    pub(crate) load_work: f64,
    /// Time of a step (ms).
    pub(crate) ms_per_step: f64,
    /// Relative distance from the trusted run; NaN without a trusted run.
    pub(crate) error: f64,
    /// Time (s) by which the trusted run is behind.
    pub(crate) lag: f64,
    /// Share of velocities at their limit since the last picture.
    pub(crate) saturated: f64,
    /// Kinetic energy of the last quarter of a second over that of the quarter before; NaN right after a disturbance,
    /// for example while a tool is steered.
    pub(crate) settling: f64,
    /// Colours of the three lights, two bits each.
    pub(crate) lights: u32,
    /// Reasons of the three lights, eight bits each.
    pub(crate) reasons: u32,
    /// Number of inverted tetrahedra.
    pub(crate) inverted: u32,
    /// Number of points at which tools press.
    pub(crate) contacts: u32,
    /// Energy minus that at the beginning and the work since then (J); NaN if the energy is unknown.
    pub(crate) balance: f64,
    /// Nodes and tetrahedra of the current body.
    pub(crate) nodes: u32,
    pub(crate) tets: u32,
    /// Totals of all cuts.
    pub(crate) cuts: CutHead,
    /// Force (N) with which the user pulls the tissue without a tool, the mean since the last picture.
    pub(crate) pull: [f64; 3],
    /// The place (m) of that tissue; NaN if there is none.
    pub(crate) grip: [f64; 3],
    /// The section with the values inside.
    pub(crate) section: SectionHead,
}

/// A section by a plane across an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SectionHead {
    /// The axis; 3 if there is no section.
    pub(crate) axis: u32,
    /// Number of its triangles.
    pub(crate) triangles: u32,
    /// Coordinate (m) of the plane.
    pub(crate) at: f64,
}

impl Default for SectionHead {
    fn default() -> Self {
        Self {
            axis: 3,
            triangles: 0,
            at: 0.0,
        }
    }
}

/// Totals of all cuts of a body since the beginning.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CutHead {
    /// Area (m2) at rest.
    pub(crate) area: f64,
    /// Energy (J) added by cuts; NaN if unknown.
    pub(crate) energy: f64,
    /// Work (J) of the blade for new surface.
    pub(crate) blade_work: f64,
    /// Nodes that were added.
    pub(crate) new_nodes: u32,
    /// Pieces of the body.
    pub(crate) pieces: u32,
    /// Number of tetrahedra that were removed.
    pub(crate) removed: u32,
    /// Number of changes of the body.
    pub(crate) changes: u32,
}

/// A tool.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ToolHead {
    /// Position (m), then rotation vector (rad).
    pub(crate) pose: [f64; 6],
    /// Force on it (N), the mean since the last picture.
    pub(crate) force: [f64; 3],
    /// Depth (m) in the body at rest.
    pub(crate) depth: f64,
    /// Distance (m) of the surface's nearest point, negative inside.
    pub(crate) gap: f64,
    /// Steered pose: position (m), then rotation vector (rad).
    pub(crate) hand: [f64; 6],
}

/// A writer of a picture.
#[derive(Debug)]
pub(crate) struct FrameWriter(Vec<u8>);

impl FrameWriter {
    /// Begins a picture of `points` points in each pane, and `tools` tools in all of them, whose length is known in
    /// advance.
    pub(crate) fn new(head: &FrameHead, points: &[usize], tools: usize) -> Self {
        let of_pane = |points: &usize| PANE + TOOL * tools + rounded_up(16 * points);
        let mut out = Vec::with_capacity(HEAD + points.iter().map(of_pane).sum::<usize>());
        for number in [PICTURE, head.frame, 0, head.epoch, head.panes, head.field] {
            out.extend(number.to_le_bytes());
        }
        out.extend(head.pace.to_le_bytes());
        Self(out)
    }

    /// Writes the numbers of a pane.
    pub(crate) fn pane(&mut self, head: &PaneHead, points: usize, tools: usize) {
        let begins = self.0.len();
        self.0.extend(head.step.to_le_bytes());
        let numbers = [
            head.t,
            head.dt,
            head.kinetic,
            head.elastic,
            head.tool_work,
            head.load_work,
            head.ms_per_step,
            head.error,
            head.lag,
            head.saturated,
            head.settling,
        ];
        self.numbers(&numbers);
        let counts = [
            head.lights,
            head.reasons,
            head.inverted,
            head.contacts,
            points as u32,
            tools as u32,
        ];
        for count in counts {
            self.0.extend(count.to_le_bytes());
        }
        let CutHead {
            area,
            energy,
            blade_work,
            new_nodes,
            pieces,
            removed,
            changes,
        } = head.cuts;
        self.numbers(&[head.balance, area, energy, blade_work]);
        for count in [head.nodes, head.tets, new_nodes, pieces, removed, changes] {
            self.0.extend(count.to_le_bytes());
        }
        self.numbers(&head.pull);
        self.numbers(&head.grip);
        let SectionHead {
            axis,
            triangles,
            at,
        } = head.section;
        for number in [axis, triangles] {
            self.0.extend(number.to_le_bytes());
        }
        self.numbers(&[at]);
        debug_assert_eq!(self.0.len(), begins + PANE);
    }

    /// A tool.
    pub(crate) fn tool(&mut self, tool: &ToolHead) {
        self.numbers(&tool.pose);
        self.numbers(&tool.force);
        self.numbers(&[tool.depth, tool.gap]);
        self.numbers(&tool.hand);
    }

    /// Writes the positions (m) of the points, or of corners of a section, and their colours.
    pub(crate) fn points(&mut self, places: impl Iterator<Item = [f32; 3]>, colours: &[f32]) {
        for coordinate in places.flatten() {
            self.0.extend(coordinate.to_le_bytes());
        }
        for colour in colours {
            self.0.extend(colour.to_le_bytes());
        }
        self.0.resize(rounded_up(self.0.len()), 0);
    }

    /// Returns the message.
    pub(crate) fn finish(self) -> Vec<u8> {
        self.0
    }

    fn numbers(&mut self, numbers: &[f64]) {
        for number in numbers {
            self.0.extend(number.to_le_bytes());
        }
    }
}

fn rounded_up(bytes: usize) -> usize {
    bytes.next_multiple_of(8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_takes_the_room_that_it_was_given_and_its_parts_lie_where_they_are_read() {
        let head = FrameHead {
            frame: 5,
            epoch: 2,
            panes: 2,
            field: 1,
            pace: 0.5,
        };
        let mut writer = FrameWriter::new(&head, &[3, 3], 1);
        let room = writer.0.capacity();
        for pane in 0..2 {
            let numbers = PaneHead {
                step: 9,
                t: 1.5,
                lights: 7,
                balance: -0.5,
                cuts: CutHead {
                    area: 0.75,
                    changes: 4,
                    ..CutHead::default()
                },
                grip: [0.0, 0.0, 2.5],
                ..PaneHead::default()
            };
            writer.pane(&numbers, 3, 1);
            writer.tool(&ToolHead {
                depth: 0.25,
                ..ToolHead::default()
            });
            writer.points([[pane as f32; 3]; 3].into_iter(), &[4.0; 3]);
        }
        let out = writer.finish();
        assert_eq!((out.len(), out.capacity()), (room, room));
        let f64_at = |at: usize| f64::from_le_bytes(out[at..at + 8].try_into().unwrap());
        let u32_at = |at: usize| u32::from_le_bytes(out[at..at + 4].try_into().unwrap());
        let f32_at = |at: usize| f32::from_le_bytes(out[at..at + 4].try_into().unwrap());
        assert_eq!([0, 4, 8, 12, 16, 20].map(u32_at), [1, 5, 0, 2, 2, 1]);
        assert_eq!(f64_at(24), 0.5);
        for (pane, at) in [HEAD, HEAD + PANE + TOOL + 48].into_iter().enumerate() {
            assert_eq!(f64_at(at + 8), 1.5);
            assert_eq!(u32_at(at + 96), 7);
            assert_eq!([at + 112, at + 116].map(u32_at), [3, 1]);
            assert_eq!([at + 120, at + 128].map(f64_at), [-0.5, 0.75]);
            assert_eq!(u32_at(at + 172), 4);
            assert_eq!(f64_at(at + 216), 2.5);
            assert_eq!([at + 224, at + 228].map(u32_at), [3, 0]);
            assert_eq!(f64_at(at + PANE + 72), 0.25);
            assert_eq!(f32_at(at + PANE + TOOL), pane as f32);
            assert_eq!(f32_at(at + PANE + TOOL + 36), 4.0);
        }
    }

    #[test]
    fn surfaces_of_several_panes_lie_behind_each_other() {
        let of_three = SurfaceShape {
            points: &[[0.5; 3]; 3],
            triangles: &[[0, 1, 2]],
            outer: 1,
            twins: &[1, 0, NONE],
        };
        let of_one = SurfaceShape {
            points: &[[0.25; 3]],
            triangles: &[],
            outer: 0,
            twins: &[0],
        };
        let out = topology(7, &[of_three, of_one]);
        assert_eq!((out.len(), out.capacity()), (16 + 80 + 32, out.len()));
        let u32_at = |at: usize| u32::from_le_bytes(out[at..at + 4].try_into().unwrap());
        assert_eq!([0, 4, 8].map(u32_at), [TOPOLOGY, 7, 2]);
        let first = [16, 20, 24, 72, 76, 80, 84, 88].map(u32_at);
        assert_eq!(first, [3, 1, 1, 1, 2, 1, 0, NONE]);
        let second = [96, 100, 104, 112].map(u32_at);
        assert_eq!(second, [1, 0, 0, 0.25_f32.to_bits()]);
    }
}

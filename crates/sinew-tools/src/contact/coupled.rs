//! Coupled contacts of a step: their detection and solution.

use sinew_core::{Meeting, State};

use super::count::Count;
use super::links::{Link, LinkedNode, Links, Rule};
use super::meet::way_of;
use super::node::Compliance;
use super::record::{OF_HELD, OF_PAIR, OF_VELOCITY, Record, swing};
use super::room::Room;
use super::tool::Corner;
use super::tool_step::{ToolStep, Way, holder, is_near};
use super::tools::Tools;
use crate::shape::TriangleTouch;
use crate::swept_box::around;
use crate::vector::{Vector, add, between, scaled, sub};

/// Largest number of rounds of finding contacts and solving for their forces: tissue pushed back by one surface may
/// meet another.
const MOST_ROUNDS: usize = 8;

/// Share of a pass within which a contact counts as existing at its beginning.
const BEGINNING: f64 = 1e-6;

/// Largest number of contacts of a triangle with a part of a tool in a step.
const MOST_ON_TRIANGLE: usize = 4;

/// Number of rounds that check the end position of a body that its contacts rotate.
const ROUNDS_OF_BODIES: usize = 2;

impl Tools {
    /// Finds the coupled contacts of a step, and the displacements of tissue and tools under them; in several passes
    /// if a tool smaller than the surface triangles moves far, so that no triangle is missed.
    pub(super) fn link(
        &self,
        room: &mut Room,
        meeting: &Meeting<'_>,
        state: &State,
        record: &mut Record<'_>,
    ) {
        room.links.clear();
        let passes = room.passes_between_nodes(&self.tools, record.tools);
        for pass in 1..=passes {
            let shares = [pass - 1, pass].map(|done| f64::from(done) / f64::from(passes));
            if passes > 1 {
                room.pass(&self.tools, shares);
            }
            room.links.begin_pass();
            let ways = Ways {
                tools: self,
                meeting,
                state,
                shares,
            };
            let search = Search {
                tools: self,
                ways,
                held: record.held,
                velocities: record.velocities,
                pairs: record.pairs,
            };
            if pass == 1 {
                search.find_lips(&mut room.links);
            }
            self.rounds(room, &search);
            let count = Count {
                tools: self,
                steps: &room.steps,
                dt: meeting.dt,
            };
            let way = |place: u32| ways.pass(place as usize, &room.links);
            count.of_links(&room.links, way, record);
        }
        if passes > 1 {
            room.pass(&self.tools, [0.0, 1.0]);
        }
        self.keep_pairs(state, meeting, record.pairs);
    }

    /// Finds the contacts of a pass and solves for their forces.
    fn rounds(&self, room: &mut Room, search: &Search<'_>) {
        let has_bodies = self.counts.bodies > 0;
        let least = if has_bodies { ROUNDS_OF_BODIES } else { 1 };
        let ways = search.ways;
        let Ways { meeting, state, .. } = ways;
        for round in 0..MOST_ROUNDS {
            // Contact turns and moves bodies alone.
            if round == 0 || has_bodies {
                room.look(&self.cells, state, meeting);
            }
            let is_new = search.all(room, round == 0);
            if !is_new && (room.links.is_empty() || round >= least) {
                break;
            }
            let stood = |place: u32| ways.stood(place as usize, ways.shares[1]);
            let swing = |place: u32| search.swing(place as usize);
            room.links.look(&room.steps, meeting.dt, stood, swing);
            room.links.solve(&mut room.steps);
            room.follow(&self.tools);
        }
    }
}

/// The paths of cells in a pass of a step.
#[derive(Clone, Copy)]
struct Ways<'a> {
    tools: &'a Tools,
    meeting: &'a Meeting<'a>,
    state: &'a State,
    /// The shares of the step at the beginning and the end of the pass.
    shares: [f64; 2],
}

impl Ways<'_> {
    /// The path (m) of a cell in the step, without contact.
    fn whole(&self, place: usize) -> Way {
        let touched = &self.tools.cells[place];
        let to = touched.at(&self.state.u);
        let back = way_of(self.meeting, self.state, touched.cell);
        (sub(to, back), to)
    }

    /// Position (m) of a cell at a share of the step, without contact.
    fn stood(&self, place: usize, share: f64) -> Vector {
        let (from, to) = self.whole(place);
        if share == 1.0 {
            to
        } else {
            between(from, to, share)
        }
    }

    /// The path (m) of a cell in the pass, with the contact displacement so far.
    fn pass(&self, place: usize, links: &Links) -> Way {
        let [from, to] = self.shares.map(|share| self.stood(place, share));
        (add(from, links.before[place]), add(to, links.moved[place]))
    }

    fn compliance(&self, place: usize) -> Compliance {
        let touched = &self.tools.cells[place];
        let inverse = self.meeting.inverse_block(touched.cell as usize);
        Compliance::new(inverse, touched.free, self.meeting.dt)
    }
}

/// A search for contacts in a pass of a step.
struct Search<'a> {
    tools: &'a Tools,
    ways: Ways<'a>,
    held: &'a [[f64; OF_HELD]],
    /// Velocities (m/s) before the step, if known.
    velocities: &'a [[f64; OF_VELOCITY]],
    /// History of each pair of cut-face nodes.
    pairs: &'a [[f64; OF_PAIR]],
}

impl Search<'_> {
    /// Displacement (m) of a cell along which friction does work, without contact.
    fn swing(&self, place: usize) -> Vector {
        let (from, to) = self.ways.whole(place);
        let kept = self.velocities.get(place);
        swing(self.ways.meeting, kept, sub(to, from))
    }

    /// Adds new contacts; returns true if there are any. In the first round only triangles that touch at the beginning
    /// are added: the forces of these may prevent contact with the others.
    fn all(&self, room: &mut Room, is_first: bool) -> bool {
        let count = |links: &Links| links.all.len() + links.lips.len();
        let before = count(&room.links);
        self.of_lips(&mut room.links);
        for near in 0..room.near.len() {
            let place = room.near[near] as usize;
            if !room.links.is_linked(place) {
                // A node at a cut face that a tool pushes may push the opposite face.
                let is_lip = self.tools.is_lip[place];
                let tools = if is_lip { u64::MAX } else { self.tools.linking };
                self.at_node(room, place, tools);
            }
        }
        let is_left = self.of_triangles(room, is_first);
        let mut next = 0;
        while let Some(place) = room.links.places.get(next) {
            self.at_node(room, *place as usize, u64::MAX);
            next += 1;
        }
        is_left || count(&room.links) > before
    }

    /// Finds the normals of cut faces at the beginning of the step.
    fn find_lips(&self, links: &mut Links) {
        let at = |corner: Corner| corner.at(|place| self.ways.whole(place as usize).0);
        self.tools.lips.find_normals(at, &mut links.normals);
    }

    /// Adds the pairs of cut-face nodes that come into contact.
    fn of_lips(&self, links: &mut Links) {
        let [_, share] = self.ways.shares;
        for (number, pair) in (0..).zip(&self.tools.lips.pairs) {
            if links.knows_lips(number) {
                continue;
            }
            let from = pair
                .nodes
                .map(|node| node.at(|place| self.ways.whole(place as usize).0));
            let stood = |place: u32| self.ways.stood(place as usize, share);
            let end = |place: u32| add(stood(place), links.moved[place as usize]);
            let stood = pair.nodes.map(|node| node.at(stood));
            let end = pair.nodes.map(|node| node.at(end));
            let compliance = |place: u32| self.ways.compliance(place as usize);
            let ways = [from, stood, end];
            let earlier = self.pairs.get(number as usize).copied().unwrap_or_default();
            let met = self
                .tools
                .lips
                .meet(number, &links.normals, (earlier, ways), compliance);
            if let Some(link) = met {
                links.add_lips(link);
            }
        }
    }

    /// Adds the contacts of a node with some tools, one bit each.
    fn at_node(&self, room: &mut Room, place: usize, tools: u64) {
        let (from, end) = self.ways.pass(place, &room.links);
        let held = self.held.get(place);
        if let (Some(tool), Some([_, x, y, z])) = (holder(&room.steps, held), held) {
            if tools >> tool & 1 == 1 && !room.links.knows(place, (tool, 0)) {
                let link = Link::of_node(
                    (place as u32, self.ways.compliance(place)),
                    (tool, 0),
                    ([*x, *y, *z], 0.0),
                    (Rule::Held, 0.0),
                );
                room.links.add(link);
            }
            return;
        }
        let tools = tools & self.tools.tools_at[place];
        if !is_near(&room.steps, tools, (from, end)) {
            return;
        }
        let Room { steps, links, .. } = room;
        for (number, step) in steps.iter().enumerate() {
            if tools >> number & 1 == 0 {
                continue;
            }
            for (part, touch) in step.touches((from, end)) {
                if links.knows(place, (number, part)) {
                    continue;
                }
                let pose = &self.tools.tools[number].shape.parts()[part].pose;
                let link = Link::of_node(
                    (place as u32, self.ways.compliance(place)),
                    (number, part),
                    (pose.to_world(touch.point), touch.below),
                    (Rule::Outside(pose.turned(touch.normal)), step.friction),
                );
                links.add(link);
            }
        }
    }

    /// Adds the contacts of triangles, or only those at the beginning of the pass; returns true if it skipped others.
    fn of_triangles(&self, room: &mut Room, at_beginning: bool) -> bool {
        let Room {
            steps,
            links,
            sides,
            ..
        } = room;
        if sides.corners() == 0 {
            return false;
        }
        // Only contact moves them within a pass.
        match at_beginning {
            true => sides.begin(|place| self.ways.pass(place, links)),
            false => sides.take(links.linked(), |place| self.ways.pass(place, links)),
        }
        let mut is_left = false;
        for (number, tool) in self.tools.tools.iter().enumerate() {
            if tool.triangles.is_empty() {
                continue;
            }
            let step = &steps[number];
            let bounds = around(step.bounds());
            // Nothing but contact makes a round differ from the first, except that bodies move.
            let is_anew = at_beginning || step.body.is_some();
            match is_anew {
                true => sides.look(number, bounds.as_ref(), 0..sides.corners()),
                false => sides.look(number, bounds.as_ref(), links.linked()),
            }
            for triangle in &tool.triangles {
                let corners = self.tools.corners.of[*triangle as usize].map(|place| place as usize);
                let [a, b, c] = corners.map(|place| sides.of_tool(number)[place]);
                if a & b & c != 0 {
                    continue;
                }
                let is_moved = || {
                    let mut corners = corners.iter();
                    corners.any(|place| links.is_linked(*place))
                };
                if !is_anew && !sides.is_left[*triangle as usize] && !is_moved() {
                    continue;
                }
                let ways = corners.map(|place| sides.ways[place]);
                let (from, end) = (ways.map(|way| way.0), ways.map(|way| way.1));
                // What contacts of rounds before have moved may be in the tool elsewhere.
                if links.is_on(*triangle) {
                    for (part, touch, below) in step.triangle_overlaps(&from, &end) {
                        let known = links.of_triangle(*triangle, (number, part));
                        if (1..MOST_ON_TRIANGLE).contains(&known) {
                            self.add_triangle(
                                links,
                                step,
                                (number, part, *triangle),
                                (&touch, below),
                            );
                        }
                    }
                }
                for (part, touch, below) in step.triangle_touches(&from, &end) {
                    if at_beginning && touch.share > BEGINNING {
                        is_left = true;
                        sides.is_left[*triangle as usize] = true;
                    } else if links.of_triangle(*triangle, (number, part)) == 0 {
                        self.add_triangle(links, step, (number, part, *triangle), (&touch, below));
                    }
                }
            }
        }
        is_left
    }

    fn add_triangle(
        &self,
        links: &mut Links,
        step: &ToolStep,
        (number, part, triangle): (usize, usize, u32),
        (touch, below): (&TriangleTouch, f64),
    ) {
        let corners = self.tools.triangles[triangle as usize].corners;
        let mut still = [0.0; 3];
        let mut nodes = [None; 3];
        for ((corner, weight), node) in corners.iter().zip(touch.weights).zip(&mut nodes) {
            match corner {
                Corner::Held(at) => still = add(still, scaled(*at, weight)),
                Corner::Cell(place) if weight > 0.0 => {
                    *node = Some(LinkedNode {
                        place: *place,
                        weight,
                        compliance: self.ways.compliance(*place as usize),
                    });
                }
                Corner::Cell(_) => {}
            }
        }
        let nodes = nodes.into_iter().flatten();
        let Some(first) = nodes.clone().next() else {
            return;
        };
        let pose = &self.tools.tools[number].shape.parts()[part].pose;
        let of_first = Link::of_node(
            (first.place, first.compliance),
            (number, part),
            (pose.to_world(touch.point), below),
            (Rule::Outside(pose.turned(touch.normal)), step.friction),
        );
        let link = of_first.of_triangle(triangle, nodes, still);
        // Triangles that share an edge or a node meet a tool there as one.
        if !links.knows_alike(&link) {
            links.add(link);
        }
    }
}

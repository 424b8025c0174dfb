//! Contacts that act on each other within a step, since they share a tool that is a dynamic body, or a node.

use super::body_step::BodyStep;
use super::lips::{LipLink, Lips};
use super::node::{CONVERGED, Compliance, Constraint, MOST_SWEEPS, Stiffness};
use super::tool_step::ToolStep;
use super::twist::Twist;
use crate::vector::{Vector, add, dot, length, scaled, sub};

/// Difference of unit normals, and of positions as a share of their distance from the tool's origin, below which
/// contacts are the same.
const ALIKE: f64 = 1e-7;

/// Largest number of nodes of a contact.
const NODES: usize = 3;

/// A node of a contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkedNode {
    /// Its index among the touched cells.
    pub(super) place: u32,
    /// Its weight at the point of contact.
    pub(super) weight: f64,
    pub(super) compliance: Compliance,
}

/// Constraint of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Rule {
    /// The point does not pass the tool's surface, with this outward normal in the tool's frame.
    Outside(Vector),
    /// The point stays at its position in the tool's frame.
    Held,
}

/// A point of tissue in contact with a tool.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    nodes: [LinkedNode; NODES],
    /// The contribution (m) of fixed corners to the point of contact.
    still: Vector,
    pub(super) tool: usize,
    /// The part of the tool.
    pub(super) part: usize,
    /// The triangle; `None` for a contact of a node.
    pub(super) triangle: Option<u32>,
    /// The position (m) of the contact in the tool's frame.
    own: Vector,
    /// Depth (m) of that position inside the tool.
    below: f64,
    rule: Rule,
    /// The contact surface relative to the contact-free trial position of the step, without any force.
    constraint: Constraint,
    /// Vector (m) from the tool's origin to the contact.
    arm: Vector,
    /// The displacement of tissue relative to the tool due to a force on the contact, and its inverse.
    response: Compliance,
    stiffness: Stiffness,
    /// The force (N) on the tissue.
    pub(super) force: Vector,
    /// The previous contact of each node; `before_on` is that of the triangle. They form linked lists.
    before: [Option<u32>; NODES],
    before_on: Option<u32>,
}

/// The contacts of a step that act on each other, with the displacements that they cause.
#[derive(Debug, Default)]
pub(super) struct Links {
    pub(super) all: Vec<Link>,
    /// Indices of the cells that are part of any contact, each once.
    pub(super) places: Vec<u32>,
    /// Displacement (m) by contact, of each touched cell.
    pub(super) moved: Vec<Vector>,
    /// Displacement (m) due to contact of each touched cell before the pass.
    pub(super) before: Vec<Vector>,
    /// The last contact of each touched cell; `last_on` is that of each triangle.
    last: Vec<Option<u32>>,
    last_on: Vec<Option<u32>>,
    is_linked: Vec<bool>,
    /// Pairs of cut-face nodes in contact.
    pub(super) lips: Vec<LipLink>,
    /// The normals of cut faces at the beginning of the step, times twice their area (m^2).
    pub(super) normals: Vec<[Vector; 2]>,
    /// One flag per pair of cut-face nodes: true if the pair is in contact.
    meets: Vec<bool>,
    /// Residual of the iteration for pairs of cut-face nodes.
    pub(super) lip_residual: f64,
}

impl Links {
    /// Scratch space for `cells` cells and `triangles` triangles, and for the cut faces.
    pub(super) fn of([cells, triangles]: [usize; 2], lips: &Lips) -> Self {
        Self {
            all: Vec::with_capacity(cells),
            places: Vec::with_capacity(cells),
            moved: vec![[0.0; 3]; cells],
            before: vec![[0.0; 3]; cells],
            last: vec![None; cells],
            last_on: vec![None; triangles],
            is_linked: vec![false; cells],
            lips: Vec::with_capacity(lips.pairs.len()),
            normals: Vec::with_capacity(lips.faces()),
            meets: vec![false; lips.pairs.len()],
            lip_residual: 0.0,
        }
    }

    /// Discards the contacts of the last step.
    pub(super) fn clear(&mut self) {
        self.lip_residual = 0.0;
        self.begin_pass();
        for place in self.places.drain(..) {
            let place = place as usize;
            (self.moved[place], self.before[place]) = ([0.0; 3], [0.0; 3]);
            self.is_linked[place] = false;
        }
    }

    /// Discards the contacts of the last pass, but keeps the displacements that they caused.
    pub(super) fn begin_pass(&mut self) {
        for place in &self.places {
            let place = *place as usize;
            (self.before[place], self.last[place]) = (self.moved[place], None);
        }
        for triangle in self.all.drain(..).filter_map(|link| link.triangle) {
            self.last_on[triangle as usize] = None;
        }
        for link in self.lips.drain(..) {
            self.meets[link.pair as usize] = false;
        }
    }

    /// True if there is no contact to solve for.
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty() && self.lips.is_empty()
    }

    /// True if a pair of cut-face nodes is in contact.
    pub(super) fn knows_lips(&self, pair: u32) -> bool {
        self.meets[pair as usize]
    }

    /// Adds a pair of cut-face nodes.
    pub(super) fn add_lips(&mut self, link: LipLink) {
        self.meets[link.pair as usize] = true;
        link.nodes
            .into_iter()
            .flatten()
            .for_each(|place| self.link(place));
        self.lips.push(link);
    }

    /// Records that the cell with an index is part of a contact.
    fn link(&mut self, place: u32) {
        if !std::mem::replace(&mut self.is_linked[place as usize], true) {
            self.places.push(place);
        }
    }

    /// Indices of the cells that are part of any contact.
    pub(super) fn linked(&self) -> impl Iterator<Item = usize> {
        self.places.iter().map(|place| *place as usize)
    }

    /// True if the cell with an index is part of any contact.
    pub(super) fn is_linked(&self, place: usize) -> bool {
        self.is_linked
            .get(place)
            .is_some_and(|is_linked| *is_linked)
    }

    /// True if the cell with an index has a contact as a node, without a triangle, with a part of a tool.
    pub(super) fn knows(&self, place: usize, (tool, part): (usize, usize)) -> bool {
        let mut of_cell = self.of_cell(place as u32);
        of_cell.any(|link| link.triangle.is_none() && (link.tool, link.part) == (tool, part))
    }

    /// The contacts of which the cell with an index is a part, the last one first.
    fn of_cell(&self, place: u32) -> impl Iterator<Item = &Link> {
        let at = |number: u32| self.all.get(number as usize);
        let last = self.last[place as usize].and_then(at);
        std::iter::successors(last, move |link| {
            let mut nodes = link.nodes.iter().zip(link.before);
            let own = nodes.find(|(node, _)| node.weight != 0.0 && node.place == place);
            own?.1.and_then(at)
        })
    }

    /// True if a triangle has any contact in the pass.
    pub(super) fn is_on(&self, triangle: u32) -> bool {
        self.last_on[triangle as usize].is_some()
    }

    /// Number of contacts of a triangle with a part of a tool.
    pub(super) fn of_triangle(&self, triangle: u32, (tool, part): (usize, usize)) -> usize {
        let at = |number: u32| self.all.get(number as usize);
        let last = self.last_on[triangle as usize].and_then(at);
        let on_triangle = std::iter::successors(last, |link| link.before_on.and_then(at));
        let is_it = |link: &&Link| (link.tool, link.part) == (tool, part);
        on_triangle.filter(is_it).count()
    }

    /// True if a node of a contact is part of another contact at the same position on a tool and with the same normal.
    pub(super) fn knows_alike(&self, link: &Link) -> bool {
        let Rule::Outside(normal) = link.rule else {
            return false;
        };
        let is_alike = |other: &Link| {
            (other.tool, other.part) == (link.tool, link.part)
                && matches!(other.rule, Rule::Outside(of) if length(sub(of, normal)) < ALIKE)
                && length(sub(other.own, link.own))
                    < ALIKE * length(link.own).max(length(other.own))
        };
        link.nodes()
            .any(|node| self.of_cell(node.place).any(is_alike))
    }

    /// Adds a contact.
    pub(super) fn add(&mut self, mut link: Link) {
        let number = self.all.len() as u32;
        for (node, before) in link.nodes.iter().zip(&mut link.before) {
            if node.weight != 0.0 {
                self.link(node.place);
                *before = self.last[node.place as usize].replace(number);
            }
        }
        if let Some(triangle) = link.triangle {
            link.before_on = self.last_on[triangle as usize].replace(number);
        }
        self.all.push(link);
    }

    /// Evaluates each contact again at the positions to which tools and tissue have been moved so far. `stood` gives
    /// the contact-free position of a node by its index, and `swing` the displacement (m) along which its friction
    /// works in a step of `dt` (s).
    pub(super) fn look(
        &mut self,
        tools: &[ToolStep],
        dt: f64,
        stood: impl Fn(u32) -> Vector,
        swing: impl Fn(u32) -> Vector,
    ) {
        let Self { all, moved, .. } = self;
        for link in all {
            let tool = &tools[link.tool];
            let mut at = link.still;
            for node in link.nodes() {
                let now = add(stood(node.place), moved[node.place as usize]);
                at = add(at, scaled(now, node.weight));
            }
            link.look(tool, at);
            let so_far = link.displacement(moved, tool.body.as_ref());
            link.constraint.stick = add(link.constraint.stick, so_far);
            link.constraint.gap = -dot(link.constraint.normal, link.constraint.stick);
            let own = link.nodes().fold([0.0; 3], |sum, node| {
                add(sum, scaled(swing(node.place), node.weight))
            });
            link.constraint.swing = sub(own, tool.swing(link.place(tool), dt));
        }
    }

    /// Solves for all forces by projected Gauss and Seidel's iteration (Jourdan, Alart and Jean 1998): each contact in
    /// turn is solved exactly for the forces of the others. Each tool gets the residual of its contacts, and so do all
    /// cut faces together: the largest change of a displacement in the last sweep, as a share of the largest
    /// displacement due to a contact.
    pub(super) fn solve(&mut self, tools: &mut [ToolStep]) {
        self.lip_residual = 0.0;
        if self.is_empty() {
            return;
        }
        for _ in 0..MOST_SWEEPS {
            tools.iter_mut().for_each(|tool| tool.residual = 0.0);
            self.lip_residual = 0.0;
            let mut largest: f64 = 0.0;
            for link in &mut self.lips {
                let change = link.update(&mut self.moved);
                self.lip_residual = self.lip_residual.max(change);
                largest = largest.max(link.push());
            }
            for link in &mut self.all {
                let tool = &mut tools[link.tool];
                let change = link.update(&self.moved, tool.body.as_ref());
                largest = largest.max(length(link.response.displacement(link.force)));
                if change == [0.0; 3] {
                    continue;
                }
                let left = length(link.response.displacement(change));
                tool.residual = tool.residual.max(left);
                for node in link.nodes() {
                    let by = node.compliance.displacement(scaled(change, node.weight));
                    let moved = &mut self.moved[node.place as usize];
                    *moved = add(*moved, by);
                }
                if let Some(body) = &mut tool.body {
                    let by = body.response(link.arm, change);
                    body.pushed = body.pushed.minus(by);
                }
            }
            if self.lip_residual > 0.0 {
                self.lip_residual /= largest;
            }
            let mut left = self.lip_residual;
            for tool in tools.iter_mut().filter(|tool| tool.residual > 0.0) {
                tool.residual /= largest;
                left = left.max(tool.residual);
            }
            if left <= CONVERGED {
                break;
            }
        }
    }
}

impl Link {
    /// A contact of one node with a tool, at a position (m) in its frame.
    pub(super) fn of_node(
        node: (u32, Compliance),
        (tool, part): (usize, usize),
        (own, below): (Vector, f64),
        (rule, friction): (Rule, f64),
    ) -> Self {
        let (place, compliance) = node;
        let node = LinkedNode {
            place,
            weight: 1.0,
            compliance,
        };
        let idle = LinkedNode {
            weight: 0.0,
            ..node
        };
        Self {
            nodes: [node, idle, idle],
            still: [0.0; 3],
            tool,
            part,
            triangle: None,
            own,
            below,
            rule,
            constraint: Constraint {
                normal: [0.0; 3],
                gap: 0.0,
                stick: [0.0; 3],
                friction,
                swing: [0.0; 3],
            },
            arm: [0.0; 3],
            response: compliance,
            stiffness: Stiffness::default(),
            force: [0.0; 3],
            before: [None; NODES],
            before_on: None,
        }
    }

    /// A contact of a triangle with a tool, made from that of its first node: all nodes with their weights, and the
    /// contribution (m) of fixed corners.
    pub(super) fn of_triangle(
        self,
        triangle: u32,
        nodes: impl Iterator<Item = LinkedNode>,
        still: Vector,
    ) -> Self {
        let mut link = Self {
            triangle: Some(triangle),
            still,
            ..self
        };
        link.nodes.iter_mut().for_each(|node| node.weight = 0.0);
        for (own, node) in link.nodes.iter_mut().zip(nodes) {
            *own = node;
        }
        link
    }

    /// The contribution (m) of fixed corners to the point of contact.
    pub(super) fn still(&self) -> Vector {
        self.still
    }

    /// The nodes of the contact.
    pub(super) fn nodes(&self) -> impl Iterator<Item = &LinkedNode> {
        self.nodes.iter().filter(|node| node.weight != 0.0)
    }

    pub(super) fn is_held(&self) -> bool {
        self.rule == Rule::Held
    }

    /// The position (m) of contact on the tool at its end pose.
    pub(super) fn place(&self, tool: &ToolStep) -> Vector {
        tool.now.to_world(self.own)
    }

    /// Depth (m) in the tool that remains for tissue at a point (m).
    pub(super) fn depth(&self, tool: &ToolStep, at: Vector) -> f64 {
        match self.rule {
            Rule::Outside(normal) => {
                self.below + dot(tool.now.turned(normal), sub(self.place(tool), at))
            }
            Rule::Held => 0.0,
        }
    }

    fn look(&mut self, tool: &ToolStep, at: Vector) {
        let after = &tool.now;
        let place = after.to_world(self.own);
        self.arm = sub(place, after.position());
        self.constraint.stick = sub(place, at);
        if let Rule::Outside(normal) = self.rule {
            self.constraint.normal = after.turned(normal);
        }
        let mut response = Compliance::default();
        for node in self.nodes() {
            response = response.plus(&node.compliance, node.weight * node.weight);
        }
        if let Some(body) = &tool.body {
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            // Symmetric: its columns are its rows.
            let block = axes.map(|axis| body.response(self.arm, axis).at(self.arm));
            response = response.plus(&Compliance::yielding(block), 1.0);
        }
        self.response = response;
        self.stiffness = response.factor();
    }

    /// The displacement (m) of tissue relative to the tool due to all forces.
    fn displacement(&self, moved: &[Vector], body: Option<&BodyStep>) -> Vector {
        let mut sum = [0.0; 3];
        for node in self.nodes() {
            sum = add(sum, scaled(moved[node.place as usize], node.weight));
        }
        let pushed = body.map_or(Twist::default(), |body| body.pushed);
        sub(sum, pushed.at(self.arm))
    }

    /// Updates the force of the contact for the given forces of the others; returns its change (N).
    fn update(&mut self, moved: &[Vector], body: Option<&BodyStep>) -> Vector {
        let all = self.displacement(moved, body);
        let by_others = sub(all, self.response.displacement(self.force));
        let seen = self.constraint.behind(by_others);
        let force = match self.rule {
            Rule::Outside(_) => {
                let force = |displacement| self.stiffness.force(displacement);
                self.response.of_one_by(force, &seen)
            }
            Rule::Held => self.stiffness.force(seen.stick),
        };
        let change = sub(force, self.force);
        self.force = force;
        change
    }
}

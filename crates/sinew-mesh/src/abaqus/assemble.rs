//! The mesh of the only part of a file's bodies.

use super::keywords::Model;
use super::part::Part;
use super::sets::Groups;
use crate::mesh::{CellBlock, Mesh};
use crate::physical_tags::PhysicalTags;
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;
use crate::reading::tag_index::TagIndex;

pub(super) fn mesh(model: &Model, remarks: &mut Remarks) -> Result<Mesh, Fault> {
    let body = Body::of(model)?;
    let part = body.part;
    let node_index = index(&part.node_labels, &part.node_offsets, "node", |a, b| {
        part.points.get(a) == part.points.get(b)
    })?;
    let mut mesh = Mesh {
        points: part
            .points
            .iter()
            .map(|point| [0, 1, 2].map(|axis| sum(point, &body.translation, axis)))
            .collect(),
        node_tags: part.node_labels.clone(),
        skipped_sections: model.skipped.clone(),
        ..Mesh::default()
    };
    for elements in part
        .blocks
        .iter()
        .filter(|elements| !elements.labels.is_empty())
    {
        let mut connectivity = Vec::with_capacity(elements.nodes.len());
        let count = elements.kind.node_count();
        for (place, label) in elements.nodes.iter().enumerate() {
            let node = node_index.get(*label).ok_or_else(|| {
                let offset = elements.offsets.get(place / count).copied().unwrap_or(0);
                let own = elements.labels.get(place / count).copied().unwrap_or(0);
                let problem = format!("it has node {label}, which *NODE does not list");
                let fault = Fault::new(offset, problem, "the label of a node");
                fault.inside(format!("element {own}")).inside("*ELEMENT")
            })?;
            connectivity.push(node);
        }
        mesh.cells.push(CellBlock {
            element_tags: elements.labels.clone(),
            ..CellBlock::new(elements.kind, connectivity)
        });
    }
    let labels: Vec<u64> = part
        .blocks
        .iter()
        .flat_map(|block| &block.labels)
        .copied()
        .collect();
    let offsets: Vec<usize> = part
        .blocks
        .iter()
        .flat_map(|block| &block.offsets)
        .copied()
        .collect();
    let element_index = index(&labels, &offsets, "element", |_, _| false)?;
    for block in &mut mesh.cells {
        block.physical = PhysicalTags::uniform(&[], block.len());
    }
    let parts = [part, body.of_instance, &model.of_assembly];
    let mut groups = Groups::new(&node_index, &element_index, &parts, remarks);
    for part in parts {
        groups.add(part, &mut mesh)?;
    }
    groups.finish(&mut mesh);
    Ok(mesh)
}

fn sum(point: &[f64; 3], translation: &[f64; 3], axis: usize) -> f64 {
    let [point, translation] = [point, translation].map(|vector| vector.get(axis));
    point.copied().unwrap_or(0.0) + translation.copied().unwrap_or(0.0)
}

/// The part that is the body, and its position.
struct Body<'m> {
    part: &'m Part,
    /// Sets that are defined in the instance of the part.
    of_instance: &'m Part,
    translation: [f64; 3],
}

impl<'m> Body<'m> {
    fn of(model: &'m Model) -> Result<Body<'m>, Fault> {
        let at_rest = |part| Body {
            part,
            of_instance: &model.nothing,
            translation: [0.0; 3],
        };
        match model.instances.as_slice() {
            [] => {
                let mut parts = model
                    .parts
                    .iter()
                    .chain([&model.outside])
                    .filter(|part| part.has_mesh());
                match (parts.next(), parts.next()) {
                    (None, _) => Ok(at_rest(&model.outside)),
                    (Some(part), None) => Ok(at_rest(part)),
                    (Some(_), Some(_)) => {
                        let problem =
                            "the file has several parts with nodes and no instance of them";
                        Err(Fault::unsupported(0, problem, ONE))
                    }
                }
            }
            [instance] => {
                if instance.own.has_mesh() {
                    return Ok(Body {
                        part: &instance.own,
                        of_instance: &model.nothing,
                        translation: instance.translation,
                    });
                }
                let named = |part: &&Part| part.name.eq_ignore_ascii_case(&instance.part);
                let part = model.parts.iter().find(named).ok_or_else(|| {
                    let problem = format!(
                        "instance \"{}\" is of part \"{}\", which the file does not have",
                        instance.name, instance.part
                    );
                    Fault::new(instance.offset, problem, "the name of a part")
                })?;
                Ok(Body {
                    part,
                    of_instance: &instance.own,
                    translation: instance.translation,
                })
            }
            [_, second, ..] => {
                let problem = format!("the assembly has {} instances", model.instances.len());
                Err(Fault::unsupported(second.offset, problem, ONE))
            }
        }
    }
}

const ONE: &str =
    "a body is one part with one instance: in Abaqus/CAE, Merge/Cut Instances makes one of several";

/// The index of labels. A label that occurs again is refused unless `is_same` is true for both indices.
fn index(
    labels: &[u64],
    offsets: &[usize],
    what: &str,
    is_same: impl Fn(usize, usize) -> bool,
) -> Result<TagIndex, Fault> {
    let mut index = TagIndex::of_range(labels);
    if index.is_complete() {
        return Ok(index);
    }
    for (place, &label) in labels.iter().enumerate() {
        match index.get(label) {
            Some(first) if !is_same(first as usize, place) => {
                let offset = offsets.get(place).copied().unwrap_or(0);
                let problem = format!("{what} {label} occurs again");
                return Err(Fault::new(offset, problem, format!("each {what} once")));
            }
            Some(_) => {}
            None => {
                let number = u32::try_from(place).map_err(|_| {
                    Fault::new(0, format!("there are more than 2^32 {what}s"), "fewer")
                })?;
                index.insert(label, number);
            }
        }
    }
    Ok(index)
}

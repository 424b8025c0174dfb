//! `$Periodic` and `$GhostElements`.

use super::header::{Encoding, Format, Version, with_source};
use super::physical_names::dimension;
use super::source::{Record, Source, TagKind, Text};
use crate::mesh::PeriodicLink;
use crate::reading::cursor::Cursor;
use crate::reading::fault::Fault;

/// `$Periodic` without its last line.
pub(super) fn read(cursor: &mut Cursor<'_>, format: Format) -> Result<Vec<PeriodicLink>, Fault> {
    match (format.version, format.encoding) {
        (Version::V41, _) => with_source!(format, cursor, source => read_links(source, V41)),
        (Version::V40, Encoding::Binary(_)) => {
            // gmsh counts links as a size_t, meshio as an int. The section ends where it should for one of them.
            let start = cursor.clone();
            let as_gmsh = with_source!(format, cursor, source => read_links(source, V40_BYTES));
            let mut after = cursor.clone();
            after.skip_blanks();
            if as_gmsh.is_ok() && after.rest().starts_with(b"$EndPeriodic") {
                return as_gmsh;
            }
            let mut other = start;
            let counted_by_int = Layout {
                count_of_links: TagKind::Int,
                ..V40_BYTES
            };
            let as_meshio =
                with_source!(format, &mut other, source => read_links(source, counted_by_int));
            if as_meshio.is_ok() {
                *cursor = other;
                return as_meshio;
            }
            as_gmsh
        }
        // In version 2 it is text even in binary files.
        _ => read_text_links(cursor),
    }
}

/// The encoding of the numbers of links.
#[derive(Clone, Copy)]
struct Layout {
    count_of_links: TagKind,
    node_tags: TagKind,
    affine_has_count: bool,
}

const V41: Layout = Layout {
    count_of_links: TagKind::Size,
    node_tags: TagKind::Size,
    affine_has_count: true,
};

const V40_BYTES: Layout = Layout {
    count_of_links: TagKind::Size,
    node_tags: TagKind::Int,
    affine_has_count: false,
};

const COUNT_OF_LINKS: &str = "the number of links";
const COUNT_OF_PAIRS: &str = "the number of node pairs";

fn read_links(source: &mut impl Source, layout: Layout) -> Result<Vec<PeriodicLink>, Fault> {
    let count = source.tag(layout.count_of_links, COUNT_OF_LINKS)?;
    let least = Record {
        ints: 3,
        sizes: 1,
        ..Record::default()
    };
    source.room_for(count, COUNT_OF_LINKS, least)?;
    let mut links = Vec::new();
    for number in 1..=count {
        let link =
            read_link(source, layout).map_err(|fault| fault.in_record("link", number, count))?;
        links.push(link);
    }
    Ok(links)
}

fn read_link(source: &mut impl Source, layout: Layout) -> Result<PeriodicLink, Fault> {
    let mut link = read_entities(source)?;
    let pairs = if layout.affine_has_count {
        let offset = source.next_offset();
        match source.size("the size of the affine transformation")? {
            0 => {}
            16 => link.affine = read_affine(source)?,
            other => {
                let problem = format!("the affine transformation has {other} numbers");
                return Err(Fault::new(offset, problem, "0 or 16"));
            }
        }
        source.size(COUNT_OF_PAIRS)?
    } else {
        // Version 4.0: -1 announces a transformation.
        match source.size(COUNT_OF_PAIRS)? {
            u64::MAX => {
                link.affine = read_affine(source)?;
                source.size(COUNT_OF_PAIRS)?
            }
            pairs => pairs,
        }
    };
    read_pairs(source, pairs, layout.node_tags, &mut link)?;
    Ok(link)
}

fn read_entities(source: &mut impl Source) -> Result<PeriodicLink, Fault> {
    let offset = source.next_offset();
    let dim = dimension(source.int("the dimension")?, offset)?;
    Ok(PeriodicLink {
        dim,
        entity: source.int("the tag of the dependent entity")?,
        master: source.int("the tag of the master entity")?,
        affine: Vec::new(),
        node_tags: Vec::new(),
    })
}

fn read_affine(source: &mut impl Source) -> Result<Vec<f64>, Fault> {
    (0..16)
        .map(|_| source.finite("an entry of the affine transformation"))
        .collect()
}

fn read_pairs(
    source: &mut impl Source,
    pairs: u64,
    kind: TagKind,
    link: &mut PeriodicLink,
) -> Result<(), Fault> {
    let count = source.room_for(pairs, COUNT_OF_PAIRS, Record::tags(kind, 2))?;
    link.node_tags.reserve_exact(count);
    for number in 1..=pairs {
        let mut pair = || Ok([source.node_tag(kind)?, source.node_tag(kind)?]);
        let pair = pair().map_err(|fault: Fault| fault.in_record("pair", number, pairs))?;
        link.node_tags.push(pair);
    }
    Ok(())
}

/// Versions 2 and 4.0 as text: a line that starts with `Affine` (gmsh) or -1 (meshio) may precede the number of pairs.
fn read_text_links(cursor: &mut Cursor<'_>) -> Result<Vec<PeriodicLink>, Fault> {
    let mut source = Text::new(cursor);
    let count = source.size(COUNT_OF_LINKS)?;
    source.room_for(count, COUNT_OF_LINKS, Record::ints(4))?;
    let mut links = Vec::new();
    for number in 1..=count {
        let link =
            read_text_link(cursor).map_err(|fault| fault.in_record("link", number, count))?;
        links.push(link);
    }
    Ok(links)
}

fn read_text_link(cursor: &mut Cursor<'_>) -> Result<PeriodicLink, Fault> {
    let mut link = read_entities(&mut Text::new(cursor))?;
    let mut ahead = cursor.clone();
    if matches!(ahead.token(COUNT_OF_PAIRS)?.text, b"Affine" | b"-1") {
        *cursor = ahead;
        link.affine = read_affine(&mut Text::new(cursor))?;
    }
    let source = &mut Text::new(cursor);
    let pairs = source.size(COUNT_OF_PAIRS)?;
    read_pairs(source, pairs, TagKind::Size, &mut link)?;
    Ok(link)
}

/// `$GhostElements` without its last line. Ghosts repeat the cells of other partitions; they are not cells themselves.
pub(super) fn read_ghosts(source: &mut impl Source, version: Version) -> Result<u64, Fault> {
    let what = "the number of ghost elements";
    let count = source.size(what)?;
    let tag_kind = match version {
        Version::V41 => TagKind::Size,
        _ => TagKind::Int,
    };
    source.room_for(count, what, Record::ints(2))?;
    for number in 1..=count {
        let mut row = || {
            source.tag(tag_kind, "the element tag")?;
            source.int("the partition")?;
            source.int_list("ghost partitions")
        };
        row().map_err(|fault| fault.in_record("ghost element", number, count))?;
    }
    Ok(count)
}

//! Messages about joints.

use super::Joints;
use super::places::Places;

/// Kinds of findings about joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum JointFinding {
    /// Parts touch without common nodes.
    Touching,
    /// Faces within a part lie on others without being the same.
    Mismatched,
    /// Blocks of tetrahedra are joined by single nodes or edges only.
    Hinges,
    /// Tetrahedra that share a face overlap.
    Tangled,
}

impl Joints {
    /// True if all tetrahedra that seem to be connected are connected.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        self.findings().is_empty()
    }

    /// Findings that need attention, one sentence each, with places and a remedy.
    #[must_use]
    pub fn findings(&self) -> Vec<(JointFinding, String)> {
        let mut findings = Vec::new();
        let mut say = |places: &Places, kind: JointFinding, words: &dyn Fn() -> String| {
            if !places.is_empty() {
                findings.push((kind, words()));
            }
        };
        let merge = match self.mergeable {
            0 => "mesh them as one body (gmsh: `Coherence;`)".to_owned(),
            nodes => format!(
                "`sinew mesh check --fix merge-nodes` joins them by {nodes} nodes, or mesh them as one body (gmsh: `Coherence;`)"
            ),
        };
        say(&self.touching, JointFinding::Touching, &|| {
            format!(
                "parts that touch and do not hold together: faces of different parts lie on each other without common nodes: {}; {merge}",
                self.touching
            )
        });
        say(&self.touching_partly, JointFinding::Touching, &|| {
            format!(
                "parts that touch and do not hold together: faces of a part lie on faces of another that have other corners: {}; {}",
                self.touching_partly,
                if self.touching.is_empty() && self.hanging.is_empty() {
                    &merge
                } else {
                    "mesh them as one body (gmsh: `Coherence;`)"
                }
            )
        });
        say(&self.mismatched, JointFinding::Mismatched, &|| {
            let kind = match self.hanging.total {
                0 => "they are split along different diagonals".to_owned(),
                nodes => format!("{nodes} nodes hang on faces or edges of others"),
            };
            format!(
                "faces within a part that lie on others without being the same: {}; {kind}, so the tissue is open there: generate the mesh again with matching faces",
                self.mismatched
            )
        });
        say(&self.hinges, JointFinding::Hinges, &|| {
            format!(
                "hinges: {} blocks of tetrahedra hang together by single nodes or edges, without a common face: {}; they turn there without resistance: mesh them as one body, or as parts",
                self.hinged_blocks, self.hinges
            )
        });
        say(&self.tangled, JointFinding::Tangled, &|| {
            format!(
                "tangled mesh: faces of which both tetrahedra are on the same side, so that they overlap: {}; this cannot be repaired: generate the mesh again",
                self.tangled
            )
        });
        findings
    }
}

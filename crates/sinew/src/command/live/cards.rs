//! The cards of the start page: what it says of each scene.

use super::papers_cube;

/// A scene of the start page with its description and its picture.
pub(super) struct Card {
    /// Name of the scene: a ready one, or the paper's cube.
    pub(super) name: &'static str,
    /// The heading under which it is shown.
    pub(super) group: &'static str,
    /// Description of the scene.
    pub(super) about: &'static str,
    /// Advice for the user's first moves.
    pub(super) hint: &'static str,
    /// Description of the picture.
    pub(super) alt: &'static str,
    /// The picture.
    pub(super) picture: &'static [u8],
}

const INSTRUMENTS: &str = "With an instrument";
const ORGANS: &str = "Organs and tissue";
const KNOWN: &str = "Shapes with a known answer";
const FAILS: &str = "Where a method fails";

macro_rules! picture {
    ($file:literal) => {
        include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/ready/pictures/",
            $file
        ))
    };
}

/// All cards, in the order of the page.
pub(super) const CARDS: &[Card] = &[
    Card {
        name: "press",
        group: INSTRUMENTS,
        about: "A ball presses the top of a held cube by 15 mm, with friction, and stays. Its force is drawn beside Hertz's curve.",
        hint: "The ball goes down by itself; drag it to press with your own hand.",
        alt: "A steel ball pressed halfway into the top of a cube of tissue",
        picture: picture!("press.png"),
    },
    Card {
        name: "retract",
        group: INSTRUMENTS,
        about: "A flat jaw comes down, grasps what it touches, lifts it by 11.5 mm, moves it aside and lets go.",
        hint: "The jaw moves by itself; drag it to lead it, and what it has grasped follows.",
        alt: "A steel jaw that lifts a tip out of a block of tissue",
        picture: picture!("retract.png"),
    },
    Card {
        name: "needle-push",
        group: INSTRUMENTS,
        about: "A blunt needle dents a soft block by 7 mm and is withdrawn.",
        hint: "The needle moves by itself; drag it to push with your own hand.",
        alt: "A blunt steel needle on a block of tissue",
        picture: picture!("needle-push.png"),
    },
    Card {
        name: "slit",
        group: INSTRUMENTS,
        about: "A strip is stretched by a tenth, and a blade slits it to its middle. The slit opens.",
        hint: "The blade cuts by itself; press C for a blade of your own, then drag across the strip.",
        alt: "A flat strip, cut from one edge to its middle, with the stress around the end of the cut",
        picture: picture!("slit.png"),
    },
    Card {
        name: "handle",
        group: INSTRUMENTS,
        about: "A plate with mass, on a spring, moves down on a bar of the same stiffness: each takes half of the path.",
        hint: "The plate moves by itself; drag it to press the bar.",
        alt: "A wide steel plate on a bar of tissue",
        picture: picture!("handle.png"),
    },
    Card {
        name: "organ",
        group: ORGANS,
        about: "An organ of the size of a liver, with a stiffer tumour, at rest under its own weight. A load taps its top.",
        hint: "Drag on the organ to pull it, and beside it to turn the view.",
        alt: "An organ of two rounded lobes, displaced the most where its top is tapped",
        picture: picture!("organ.png"),
    },
    Card {
        name: "incision",
        group: ORGANS,
        about: "A cut is pulled open under gravity by a retractor on each side.",
        hint: "Drag on the lips of the cut to pull them.",
        alt: "A block with a cut in its top, and the stress around the cut",
        picture: picture!("incision.png"),
    },
    Card {
        name: "layers",
        group: ORGANS,
        about: "Skin, fat and muscle under a flat pressure, between walls along which they slide.",
        hint: "Drag on the skin to pull it, or change the pressure under Loads.",
        alt: "A block of three layers: skin, yellow fat, dark red muscle",
        picture: picture!("layers.png"),
    },
    Card {
        name: "vessel",
        group: ORGANS,
        about: "A tube widens under the pressure of a pulse.",
        hint: "Change the pressure under Loads, or drag on the wall.",
        alt: "An upright tube, widened the most between its held ends",
        picture: picture!("vessel.png"),
    },
    Card {
        name: "artery",
        group: ORGANS,
        about: "A ring of an artery by the law of Holzapfel, Gasser and Ogden: two families of fibres in a soft matrix.",
        hint: "Change the pressure of the blood under Loads; time passes slowly here.",
        alt: "A ring of an artery, with the stress along its inner side",
        picture: picture!("artery.png"),
    },
    Card {
        name: "muscle",
        group: ORGANS,
        about: "20 kPa in the belly, 200 kPa at the tendons, fibres along the curved outline. It is held stretched, then let go.",
        hint: "Watch it spring back, or drag on its belly.",
        alt: "A spindle-shaped muscle, displaced the most at its free end",
        picture: picture!("muscle.png"),
    },
    Card {
        name: "organ-pressed",
        group: ORGANS,
        about: "The organ as tissue that hardly changes its volume. A load presses its top by a third of its height and lets go.",
        hint: "Drag on the organ to pull it; time passes slowly here.",
        alt: "The organ with a deep dent in its top",
        picture: picture!("organ-pressed.png"),
    },
    Card {
        name: "organ-fibres",
        group: ORGANS,
        about: "The pressed organ with fibres along x. They are stretched where it bulges, and hold it.",
        hint: "Drag on the organ to pull it; time passes slowly here.",
        alt: "The organ sagging, displaced the most at the top of the larger lobe",
        picture: picture!("organ-fibres.png"),
    },
    Card {
        name: "held-cube",
        group: KNOWN,
        about: "A sudden load on a cube that is held on four sides. It swings and comes to rest.",
        hint: "Drag on its top to pull it, and try Compare for a second method.",
        alt: "A cube, displaced the most in the middle of its top",
        picture: picture!("held-cube.png"),
    },
    Card {
        name: "twisted-column",
        group: KNOWN,
        about: "A column, spun about its axis: it turns by more than half a turn and comes back, and its energy is kept.",
        hint: "Watch the energy; nothing is lost.",
        alt: "A column, wound up by more than half a turn",
        picture: picture!("twisted-column.png"),
    },
    Card {
        name: "beam",
        group: KNOWN,
        about: "A force at the tip, released at 0.1 s. Linear tetrahedra are too stiff in bending: 83 % of the deflection of a beam.",
        hint: "Drag on the tip to bend it.",
        alt: "A long bar, displaced the most at its free end",
        picture: picture!("beam.png"),
    },
    Card {
        name: "creep",
        group: KNOWN,
        about: "A bar is pulled with a constant force: it stretches at once, and over some seconds twice as far.",
        hint: "Wait some seconds, or change the force under Loads.",
        alt: "An upright bar, displaced the most at its top",
        picture: picture!("creep.png"),
    },
    Card {
        name: "inclusion",
        group: KNOWN,
        about: "A stiffer ball, selected by its place, in a cube between sliding walls.",
        hint: "Drag on its top to pull it, and open a section to see where the ball is.",
        alt: "A cube whose top gives way less above the stiffer ball",
        picture: picture!("inclusion.png"),
    },
    Card {
        name: "needle",
        group: KNOWN,
        about: "A needle in its track is pushed a tenth of a millimetre deeper. Its motion is given; the force is a reaction.",
        hint: "Drag on the tissue around the needle.",
        alt: "A block, displaced only around the track of a needle",
        picture: picture!("needle.png"),
    },
    Card {
        name: "slivers",
        group: KNOWN,
        about: "Sixteen flat tetrahedra would force tiny steps; they are solved as small blocks.",
        hint: "Show the stable step of single elements under Colours.",
        alt: "A slab, displaced evenly from its bottom to its top",
        picture: picture!("slivers.png"),
    },
    Card {
        name: papers_cube::NAME,
        group: FAILS,
        about: "The published network (cnn) in steps of 20 ms, far beyond its stable step: the cube flies apart. Beside it, cnn-stabilised holds in the same steps.",
        hint: "Watch the left pane fail, and drag on the right one to pull both.",
        alt: "A cube whose top and bottom are thrown far out of place",
        picture: picture!("papers-cube.png"),
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::ready::READY;

    #[test]
    fn every_ready_scene_has_one_card_and_the_papers_cube_is_the_last() {
        let (last, others) = CARDS.split_last().unwrap();
        assert_eq!(last.name, papers_cube::NAME);
        let mut names: Vec<&str> = others.iter().map(|card| card.name).collect();
        let mut ready: Vec<&str> = READY.iter().map(|ready| ready.name).collect();
        names.sort_unstable();
        ready.sort_unstable();
        assert_eq!(names, ready);
    }

    #[test]
    fn pictures_are_small_png_files() {
        for card in CARDS {
            let head = [
                &b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"[..],
                &[0, 0, 1, 64, 0, 0, 0, 180],
            ];
            assert!(card.picture.starts_with(&head.concat()), "{}", card.name);
        }
        let bytes: usize = CARDS.iter().map(|card| card.picture.len()).sum();
        assert!(bytes < 450_000, "{bytes}");
    }
}

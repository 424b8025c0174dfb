//! Letters as strokes of a pen.
//!
//! Capitals are 10 high, small letters 7, from the baseline upwards. A stroke begins with `M x y` and continues with
//! `L x y` to a point and with `A x y rx ry from to` along an ellipse about a point. The angles are in degrees from the
//! right, and increase counter-clockwise.

/// Each letter, its width and its strokes.
const GLYPHS: &[(char, f32, &str)] = &[
    ('A', 8.0, "M0 0L4 10L8 0M1.4 3.5L6.6 3.5"),
    (
        'B',
        7.0,
        "M0 10L0 0L4.2 0A4.2 2.7 2.8 2.7 -90 90L0 5.4M0 10L3.9 10A3.9 7.7 2.3 2.3 90 -90",
    ),
    ('C', 8.2, "A4.9 5 4.9 5 45 315"),
    ('D', 7.9, "M0 0L0 10L3.4 10A3.4 5 4.5 5 90 -90L0 0"),
    ('E', 6.0, "M6 10L0 10L0 0L6 0M0 5.3L5 5.3"),
    ('F', 6.0, "M6 10L0 10L0 0M0 5.3L5 5.3"),
    ('G', 9.4, "A4.7 5 4.7 5 45 352L5.4 4.4"),
    ('H', 7.4, "M0 0L0 10M7.4 0L7.4 10M0 5.3L7.4 5.3"),
    ('I', 0.4, "M0.2 0L0.2 10"),
    ('J', 4.8, "M4.8 10L4.8 2.6A2.4 2.6 2.4 2.6 0 -170"),
    ('K', 7.0, "M0 0L0 10M6.8 10L0 3.9M2.5 6.1L7 0"),
    ('L', 5.4, "M0 10L0 0L5.4 0"),
    ('M', 9.0, "M0 0L0 10L4.5 3L9 10L9 0"),
    ('N', 7.4, "M0 0L0 10L7.4 0L7.4 10"),
    ('O', 9.4, "A4.7 5 4.7 5 0 360"),
    ('P', 6.7, "M0 0L0 10L3.9 10A3.9 7.2 2.8 2.8 90 -90L0 4.4"),
    ('Q', 9.4, "A4.7 5 4.7 5 0 360M5.8 2.8L9 -0.8"),
    (
        'R',
        7.0,
        "M0 0L0 10L3.9 10A3.9 7.2 2.8 2.8 90 -90L0 4.4M3.6 4.4L7 0",
    ),
    ('S', 6.6, "A3.3 7.4 2.8 2.6 35 270A3.3 2.4 3.2 2.4 90 -145"),
    ('T', 7.4, "M0 10L7.4 10M3.7 10L3.7 0"),
    ('U', 7.4, "M0 10L0 3.7A3.7 3.7 3.7 3.7 180 360L7.4 10"),
    ('V', 8.0, "M0 10L4 0L8 10"),
    ('W', 11.6, "M0 10L2.9 0L5.8 10L8.7 0L11.6 10"),
    ('X', 7.4, "M0 0L7.4 10M0 10L7.4 0"),
    ('Y', 7.6, "M0 10L3.8 4.8L7.6 10M3.8 4.8L3.8 0"),
    ('Z', 7.0, "M0 10L7 10L0 0L7 0"),
    ('a', 6.0, "A3 3.5 3 3.5 0 360M6 7L6 0"),
    ('b', 6.0, "M0 10L0 0A3 3.5 3 3.5 180 -180"),
    ('c', 5.4, "A3.2 3.5 3.2 3.5 48 312"),
    ('d', 6.0, "A3 3.5 3 3.5 0 360M6 10L6 0"),
    ('e', 6.2, "M0.1 3.6L6.2 3.6A3.1 3.5 3.1 3.5 2 318"),
    ('f', 4.2, "A3.5 8 2 2 70 180L1.5 0M0 6.6L3.8 6.6"),
    (
        'g',
        6.0,
        "A3 3.5 3 3.5 0 360M6 7L6 -0.3A3 -0.3 3 2.7 0 -150",
    ),
    ('h', 5.6, "M0 10L0 0M0 4.1A2.8 4.1 2.8 2.9 180 0L5.6 0"),
    ('i', 0.4, "M0.2 7L0.2 0M0.2 9.7L0.2 9.8"),
    (
        'j',
        1.8,
        "M1.6 7L1.6 -1.2A0 -1.2 1.6 1.8 0 -90M1.6 9.7L1.6 9.8",
    ),
    ('k', 5.4, "M0 10L0 0M5.2 7L0 2.6M1.9 4.2L5.4 0"),
    ('l', 0.4, "M0.2 10L0.2 0"),
    (
        'm',
        9.4,
        "M0 7L0 0M0 4.4A2.35 4.4 2.35 2.6 180 0L4.7 0M4.7 4.4A7.05 4.4 2.35 2.6 180 0L9.4 0",
    ),
    ('n', 5.6, "M0 7L0 0M0 4.1A2.8 4.1 2.8 2.9 180 0L5.6 0"),
    ('o', 6.4, "A3.2 3.5 3.2 3.5 0 360"),
    ('p', 6.0, "M0 7L0 -3M0 3.5A3 3.5 3 3.5 180 -180"),
    ('q', 6.0, "M6 7L6 -3M6 3.5A3 3.5 3 3.5 0 360"),
    ('r', 3.6, "M0 7L0 0M0 3.8A2.8 3.8 2.8 3.2 180 72"),
    ('s', 4.8, "A2.4 5.2 2.1 1.8 40 270A2.4 1.7 2.4 1.7 90 -145"),
    (
        't',
        3.8,
        "M1.5 9.2L1.5 1.8A3.3 1.8 1.8 1.8 180 285M0 6.6L3.6 6.6",
    ),
    (
        'u',
        5.6,
        "M0 7L0 2.9A2.8 2.9 2.8 2.9 180 360L5.6 7M5.6 2.9L5.6 0",
    ),
    ('v', 6.0, "M0 7L3 0L6 7"),
    ('w', 9.2, "M0 7L2.3 0L4.6 7L6.9 0L9.2 7"),
    ('x', 5.4, "M0 0L5.4 7M0 7L5.4 0"),
    ('y', 6.0, "M0 7L3.1 0M6 7L1.8 -3"),
    ('z', 5.2, "M0 7L5.2 7L0 0L5.2 0"),
    ('0', 6.4, "A3.2 5 3.2 5 0 360"),
    ('1', 6.4, "M1.3 8.2L3.9 10L3.9 0"),
    ('2', 6.4, "A3.2 7 3 3 170 -38L0.2 0L6.4 0"),
    ('3', 6.4, "A3.1 7.5 2.7 2.5 150 -90A3.1 2.5 3.1 2.5 90 -150"),
    ('4', 6.4, "M4.8 0L4.8 10L0 2.9L6.4 2.9"),
    ('5', 6.4, "M5.7 10L1.1 10L0.7 5.4A3.1 3.2 3.2 3.2 135 -150"),
    ('6', 6.4, "A5 3.2 4.9 6.7 92 180A3.2 3.2 3.1 3.2 180 -180"),
    ('7', 6.4, "M0 10L6.3 10L2.2 0"),
    ('8', 6.4, "A3.2 7.5 2.6 2.5 -90 270A3.2 2.5 3.1 2.5 90 450"),
    ('9', 6.4, "A3.2 6.8 3.1 3.2 360 0A1.4 6.8 4.9 6.7 0 -88"),
    ('.', 0.6, "M0.3 0L0.3 0.15"),
    (',', 1.0, "M0.7 0.1L0 -2"),
    (':', 0.6, "M0.3 0.5L0.3 0.6M0.3 6L0.3 6.1"),
    (';', 1.0, "M0.7 0.4L0 -2M0.7 6L0.7 6.1"),
    ('-', 3.6, "M0 4L3.6 4"),
    ('–', 5.4, "M0 4L5.4 4"),
    ('−', 5.6, "M0 4.2L5.6 4.2"),
    ('+', 5.8, "M2.9 1.3L2.9 7.1M0 4.2L5.8 4.2"),
    ('=', 5.8, "M0 2.8L5.8 2.8M0 5.8L5.8 5.8"),
    ('≥', 5.6, "M0 8.6L5.6 5.6L0 2.6M0 0.2L5.6 0.2"),
    ('≤', 5.6, "M5.6 8.6L0 5.6L5.6 2.6M0 0.2L5.6 0.2"),
    ('<', 5.6, "M5.6 7L0 4L5.6 1"),
    ('>', 5.6, "M0 7L5.6 4L0 1"),
    ('/', 4.2, "M0 -1L4.2 11"),
    ('\\', 4.2, "M0 11L4.2 -1"),
    ('|', 0.4, "M0.2 -2L0.2 11"),
    ('(', 2.4, "A5 4.5 5 7.2 130 230"),
    (')', 2.4, "A-2.6 4.5 5 7.2 50 -50"),
    ('[', 2.2, "M2.2 11L0 11L0 -2L2.2 -2"),
    (']', 2.2, "M0 11L2.2 11L2.2 -2L0 -2"),
    (
        '{',
        2.8,
        "M2.8 11L1.4 10L1.4 5.6L0 4.5L1.4 3.4L1.4 -1L2.8 -2",
    ),
    ('}', 2.8, "M0 11L1.4 10L1.4 5.6L2.8 4.5L1.4 3.4L1.4 -1L0 -2"),
    ('\'', 0.4, "M0.2 10L0.2 7.5"),
    ('’', 0.8, "M0.6 10L0.2 7.6"),
    ('"', 2.4, "M0.2 10L0.2 7.5M2.2 10L2.2 7.5"),
    ('!', 0.6, "M0.3 10L0.3 3M0.3 0L0.3 0.15"),
    (
        '?',
        5.2,
        "A2.6 7.4 2.6 2.6 165 -60L2.6 4.2L2.6 3M2.6 0L2.6 0.15",
    ),
    ('*', 4.8, "M2.4 10L2.4 5M0.2 8.8L4.6 6.2M0.2 6.2L4.6 8.8"),
    (
        '%',
        9.2,
        "A2 7.9 2 2.1 0 360M7.8 10L1.4 0M9.2 2.1A7.2 2.1 2 2.1 0 360",
    ),
    (
        '&',
        8.0,
        "M8 0L1.6 7A3.2 7.9 1.9 2.1 200 -40L1 4A3.1 2.5 3 2.5 150 350L7.6 5",
    ),
    (
        '#',
        7.4,
        "M1.6 0L3 10M4.6 0L6 10M0.4 3.2L7 3.2M0.6 6.8L7.4 6.8",
    ),
    (
        '@',
        10.0,
        "A5 4.5 2 2.4 0 360M7 6.9L7 3.4A8.4 3.4 1.4 1.4 180 360L9.8 4.6A5 4.6 4.8 5.4 0 300",
    ),
    (
        '$',
        6.6,
        "A3.3 7.2 2.8 2.2 35 270A3.3 2.6 3.2 2.4 90 -145M3.3 11L3.3 -1",
    ),
    ('_', 6.0, "M0 -1.5L6 -1.5"),
    ('^', 4.8, "M0 6.6L2.4 10L4.8 6.6"),
    ('~', 6.0, "A1.5 4 1.5 1 180 0A4.5 4 1.5 1 180 360"),
    ('`', 1.4, "M0 10L1.4 8"),
    ('°', 3.4, "A1.7 8.4 1.6 1.6 0 360"),
    ('²', 3.8, "A1.8 9.4 1.6 1.6 170 -38L0.2 5.6L3.7 5.6"),
    ('³', 3.8, "A1.8 9.7 1.5 1.3 150 -90A1.8 7 1.7 1.4 90 -150"),
    ('·', 0.6, "M0.3 4.2L0.3 4.3"),
    ('×', 4.8, "M0 1.6L4.8 6.4M0 6.4L4.8 1.6"),
    (
        'µ',
        5.6,
        "M0 7L0 -3M0 2.9A2.8 2.9 2.8 2.9 180 360L5.6 7M5.6 2.9L5.6 0",
    ),
    (' ', 2.2, ""),
];

/// Points of a whole ellipse.
const AROUND: f32 = 36.0;

/// A letter: its width and the lines of its strokes.
#[derive(Debug, Clone, Default)]
pub(super) struct Glyph {
    pub(super) width: f32,
    pub(super) lines: Vec<[[f32; 2]; 2]>,
}

/// The strokes of a letter. An unknown letter has those of a question mark, a letter with an accent those of its base
/// letter.
pub(super) fn glyph(letter: char) -> Glyph {
    let found = |letter: char| GLYPHS.iter().find(|glyph| glyph.0 == letter);
    let plain = match letter {
        'À'..='Å' => 'A',
        'È'..='Ë' => 'E',
        'Ì'..='Ï' => 'I',
        'Ò'..='Ö' => 'O',
        'Ù'..='Ü' => 'U',
        'à'..='å' => 'a',
        'ç' => 'c',
        'è'..='ë' => 'e',
        'ì'..='ï' => 'i',
        'ñ' => 'n',
        'ò'..='ö' => 'o',
        'ù'..='ü' => 'u',
        'μ' => 'µ',
        '“' | '”' => '"',
        '‘' => '\'',
        '—' => '–',
        letter if letter.is_whitespace() => ' ',
        letter => letter,
    };
    let found = found(plain).or_else(|| found('?'));
    found.map_or_else(Glyph::default, |(_, width, strokes)| Glyph {
        width: *width,
        lines: lines(strokes),
    })
}

/// The lines of strokes.
fn lines(strokes: &str) -> Vec<[[f32; 2]; 2]> {
    let mut lines = Vec::new();
    let mut at: Option<[f32; 2]> = None;
    let mut rest = strokes;
    while let Some(order) = rest.chars().next() {
        let end = rest[1..]
            .find(['M', 'L', 'A'])
            .map_or(rest.len(), |end| end + 1);
        let numbers: Vec<f32> = rest[1..end]
            .split(' ')
            .filter_map(|number| number.parse().ok())
            .collect();
        rest = &rest[end..];
        let mut go = |to: [f32; 2], at: &mut Option<[f32; 2]>| {
            lines.extend(at.map(|from| [from, to]));
            *at = Some(to);
        };
        match (order, &numbers[..]) {
            ('M', &[x, y]) => at = Some([x, y]),
            ('L', &[x, y]) => go([x, y], &mut at),
            ('A', &[x, y, wide, high, from, to]) => {
                let steps = (AROUND * (to - from).abs() / 360.0).ceil().max(1.0);
                for step in 0..=steps as usize {
                    let angle = (from + (to - from) * step as f32 / steps).to_radians();
                    go([x + wide * angle.cos(), y + high * angle.sin()], &mut at);
                }
            }
            _ => {}
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_has_strokes_within_its_width() {
        for letter in (33_u8..127).map(char::from).chain("°²³·×µ–−≥≤é".chars()) {
            let glyph = glyph(letter);
            assert!(!glyph.lines.is_empty(), "{letter}");
            let is_other = glyph.lines == self::glyph('?').lines;
            assert_eq!(is_other, letter == '?', "{letter}");
            for [x, y] in glyph.lines.into_iter().flatten() {
                let is_within =
                    (-0.2..=glyph.width + 0.2).contains(&x) && (-3.1..=12.0).contains(&y);
                assert!(is_within, "{letter}: {x} {y}, width {}", glyph.width);
            }
        }
    }

    #[test]
    fn what_has_no_strokes_of_its_own_shows_that_something_is_there() {
        assert_eq!(glyph('語').lines, glyph('?').lines);
        assert!(glyph(' ').lines.is_empty());
    }
}

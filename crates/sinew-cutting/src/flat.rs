//! Points of tissue in the plane of a sheet.

/// A point of tissue, projected onto the plane of a sheet along its normal.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Flat {
    /// Its position in the plane, from the sheet's centre.
    pub(crate) place: [f64; 2],
    /// Displacement of the point in the plane since the blade was at the beginning of the sheet, relative to that of
    /// the beginning.
    pub(crate) shift: [f64; 2],
}

impl Flat {
    /// The mean of three points.
    pub(crate) fn mean(of: [Self; 3]) -> Self {
        let mean = |part: fn(&Self) -> [f64; 2]| {
            [0, 1].map(|axis| of.iter().map(|flat| part(flat)[axis]).sum::<f64>() / 3.0)
        };
        Self {
            place: mean(|flat| flat.place),
            shift: mean(|flat| flat.shift),
        }
    }

    /// The point at a share of the segment from one to another.
    pub(crate) fn between([from, to]: [Self; 2], share: f64) -> Self {
        let part = |from: [f64; 2], to: [f64; 2]| {
            [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
        };
        Self {
            place: part(from.place, to.place),
            shift: part(from.shift, to.shift),
        }
    }
}

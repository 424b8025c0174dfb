//! Types of numbers in VTK's files, and numbers as bytes.

/// The order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ByteOrder {
    Little,
    Big,
}

/// A type of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// Reads all numbers of `N` bytes; bytes after the last whole number are left out.
fn all<const N: usize, T>(
    bytes: &[u8],
    order: ByteOrder,
    little: impl Fn([u8; N]) -> T,
    big: impl Fn([u8; N]) -> T,
) -> Vec<T> {
    let (numbers, _) = bytes.as_chunks::<N>();
    match order {
        ByteOrder::Little => numbers.iter().map(|number| little(*number)).collect(),
        ByteOrder::Big => numbers.iter().map(|number| big(*number)).collect(),
    }
}

/// Numbers of a type from bytes, turned by `$into`.
macro_rules! read_all {
    ($type:ty, $bytes:expr, $order:expr, $into:expr) => {
        all(
            $bytes,
            $order,
            |number| $into(<$type>::from_le_bytes(number)),
            |number| $into(<$type>::from_be_bytes(number)),
        )
    };
}

impl Scalar {
    /// Bytes of a number.
    pub(crate) fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::I64 | Scalar::U64 | Scalar::F64 => 8,
        }
    }

    pub(crate) fn is_integer(self) -> bool {
        !matches!(self, Scalar::F32 | Scalar::F64)
    }

    /// Numbers as f64. Whole numbers beyond 2^53 are rounded.
    pub(crate) fn doubles(self, bytes: &[u8], order: ByteOrder) -> Vec<f64> {
        match self {
            Scalar::I8 => read_all!(i8, bytes, order, f64::from),
            Scalar::U8 => read_all!(u8, bytes, order, f64::from),
            Scalar::I16 => read_all!(i16, bytes, order, f64::from),
            Scalar::U16 => read_all!(u16, bytes, order, f64::from),
            Scalar::I32 => read_all!(i32, bytes, order, f64::from),
            Scalar::U32 => read_all!(u32, bytes, order, f64::from),
            Scalar::I64 => read_all!(i64, bytes, order, |x| x as f64),
            Scalar::U64 => read_all!(u64, bytes, order, |x| x as f64),
            Scalar::F32 => read_all!(f32, bytes, order, f64::from),
            Scalar::F64 => read_all!(f64, bytes, order, |x| x),
        }
    }

    /// Whole numbers; a number beyond 63 bits becomes the largest one. `None` for types with fractions.
    pub(crate) fn integers(self, bytes: &[u8], order: ByteOrder) -> Option<Vec<i64>> {
        Some(match self {
            Scalar::I8 => read_all!(i8, bytes, order, i64::from),
            Scalar::U8 => read_all!(u8, bytes, order, i64::from),
            Scalar::I16 => read_all!(i16, bytes, order, i64::from),
            Scalar::U16 => read_all!(u16, bytes, order, i64::from),
            Scalar::I32 => read_all!(i32, bytes, order, i64::from),
            Scalar::U32 => read_all!(u32, bytes, order, i64::from),
            Scalar::I64 => read_all!(i64, bytes, order, |x| x),
            Scalar::U64 => {
                read_all!(u64, bytes, order, |x| i64::try_from(x).unwrap_or(i64::MAX))
            }
            Scalar::F32 | Scalar::F64 => return None,
        })
    }
}

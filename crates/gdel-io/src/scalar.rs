//! The numbers of binary files.

/// A type of numbers.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Scalar {
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
    F32,
    F64,
}

impl Scalar {
    /// Returns the number of bytes of a value.
    pub(super) fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::I64 | Scalar::U64 | Scalar::F64 => 8,
        }
    }

    /// Returns whether the values are whole numbers.
    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Scalar::F32 | Scalar::F64)
    }

    /// Returns whether `f32` holds every value.
    pub(super) fn is_single(self) -> bool {
        !matches!(self, Scalar::I32 | Scalar::I64 | Scalar::U32 | Scalar::U64 | Scalar::F64)
    }

    /// Decodes the value at the start of `bytes`, which hold at least one. Integers of 64 bits are
    /// rounded.
    pub(super) fn decode(self, bytes: &[u8], is_big_endian: bool) -> f64 {
        fn at<const N: usize>(bytes: &[u8], is_big_endian: bool) -> [u8; N] {
            std::array::from_fn(|i| bytes[if is_big_endian { N - 1 - i } else { i }])
        }
        match self {
            Scalar::I8 => i8::from_le_bytes(at(bytes, is_big_endian)).into(),
            Scalar::I16 => i16::from_le_bytes(at(bytes, is_big_endian)).into(),
            Scalar::I32 => i32::from_le_bytes(at(bytes, is_big_endian)).into(),
            Scalar::I64 => i64::from_le_bytes(at(bytes, is_big_endian)) as f64,
            Scalar::U8 => bytes[0].into(),
            Scalar::U16 => u16::from_le_bytes(at(bytes, is_big_endian)).into(),
            Scalar::U32 => u32::from_le_bytes(at(bytes, is_big_endian)).into(),
            Scalar::U64 => u64::from_le_bytes(at(bytes, is_big_endian)) as f64,
            Scalar::F32 => f32::from_le_bytes(at(bytes, is_big_endian)).into(),
            Scalar::F64 => f64::from_le_bytes(at(bytes, is_big_endian)),
        }
    }

    /// Parses a value in text, which may be NaN or infinite.
    pub(super) fn parse(self, word: &[u8]) -> Option<f64> {
        let text = std::str::from_utf8(word).ok()?;
        match self {
            // Parsed in its own type: rounding by way of a double could give another value.
            Scalar::F32 => text.parse::<f32>().ok().map(f64::from),
            _ => text.parse().ok(),
        }
    }
}

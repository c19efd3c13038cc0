//! The GPS times of LAZ, in the second version of their item.

use laz::{
    decoders::ArithmeticDecoder,
    decompressors::{IntegerDecompressor, IntegerDecompressorBuilder},
    models::{ArithmeticModel, ArithmeticModelBuilder},
    record::FieldDecompressor,
};
use std::io::{self, Read};

/// A sequence of times with small differences, as of one scanner of several that take turns.
#[derive(Clone, Copy, Default)]
struct Sequence {
    /// The last time: the bits of a double, as an integer.
    time: i64,
    /// The difference of which later differences are approximate multiples.
    difference: i32,
    /// Differences in a row that were no such multiple.
    extremes: u8,
}

/// The number of sequences that an encoder keeps.
const SEQUENCES: usize = 4;
/// Switches in a row that an encoder may write: three steps reach every sequence.
const MAX_SWITCHES: usize = SEQUENCES - 1;
/// Differences without a good multiple after which the last of them becomes the sequence's.
const MAX_EXTREMES: u8 = 3;

/// The symbols that are no multiples of the difference. Those after the last switch to the first,
/// second and third sequence after the current one.
const MAX_MULTIPLE: u32 = 500;
const MIN_MULTIPLE: u32 = MAX_MULTIPLE + 10;
const UNCHANGED: u32 = MIN_MULTIPLE + 1;
const NEW_SEQUENCE: u32 = MIN_MULTIPLE + 2;
const SYMBOLS: u32 = NEW_SEQUENCE + SEQUENCES as u32;

/// The decoder of the item, as in the [LASzip paper] and its reference implementation.
///
/// [LASzip paper]: https://doi.org/10.14358/PERS.79.2.209
pub(super) struct GpsTime {
    sequences: [Sequence; SEQUENCES],
    current: usize,
    newest: usize,
    /// Symbols in a sequence whose difference is zero, as in a new one.
    first_symbols: ArithmeticModel,
    symbols: ArithmeticModel,
    /// Corrections to predicted numbers, in nine contexts.
    corrections: IntegerDecompressor,
}

impl Default for GpsTime {
    fn default() -> Self {
        GpsTime {
            sequences: Default::default(),
            current: 0,
            newest: 0,
            first_symbols: ArithmeticModelBuilder::new(2 + SEQUENCES as u32).build(),
            symbols: ArithmeticModelBuilder::new(SYMBOLS).build(),
            corrections: IntegerDecompressorBuilder::new().bits(32).contexts(9).build_initialized(),
        }
    }
}

impl GpsTime {
    /// Reads one symbol and the numbers that follow it. Returns whether it was a time rather than a
    /// switch to another sequence.
    fn step<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>) -> io::Result<bool> {
        let sequence = &mut self.sequences[self.current];
        let symbol = if sequence.difference == 0 {
            match decoder.decode_symbol(&mut self.first_symbols)? {
                0 => UNCHANGED,
                1 => {
                    sequence.difference = self.corrections.decompress(decoder, 0, 0)?;
                    sequence.time = sequence.time.wrapping_add(sequence.difference.into());
                    sequence.extremes = 0;
                    return Ok(true);
                }
                symbol => NEW_SEQUENCE + symbol - 2,
            }
        } else {
            decoder.decode_symbol(&mut self.symbols)?
        };
        let (multiple, context) = match symbol {
            0 => (0, 7),
            1 => (1, 1),
            2..10 => (symbol as i32, 2),
            10..MAX_MULTIPLE => (symbol as i32, 3),
            MAX_MULTIPLE => (symbol as i32, 4),
            _ if symbol < MIN_MULTIPLE => (MAX_MULTIPLE as i32 - symbol as i32, 5),
            MIN_MULTIPLE => (MAX_MULTIPLE as i32 - symbol as i32, 6),
            UNCHANGED => return Ok(true),
            NEW_SEQUENCE => {
                let high = self.corrections.decompress(decoder, (sequence.time >> 32) as i32, 8)?;
                let time = i64::from(high) << 32 | i64::from(decoder.read_int()?);
                self.newest = (self.newest + 1) % SEQUENCES;
                self.current = self.newest;
                self.sequences[self.current] = Sequence { time, difference: 0, extremes: 0 };
                return Ok(true);
            }
            _ => {
                self.current = (self.current + (symbol - NEW_SEQUENCE) as usize) % SEQUENCES;
                return Ok(false);
            }
        };
        let predicted = sequence.difference.wrapping_mul(multiple);
        let difference = self.corrections.decompress(decoder, predicted, context)?;
        sequence.time = sequence.time.wrapping_add(difference.into());
        match symbol {
            1 => sequence.extremes = 0,
            0 | MAX_MULTIPLE | MIN_MULTIPLE if sequence.extremes == MAX_EXTREMES => {
                sequence.difference = difference;
                sequence.extremes = 0;
            }
            0 | MAX_MULTIPLE | MIN_MULTIPLE => sequence.extremes += 1,
            _ => {}
        }
        Ok(true)
    }
}

impl<R: Read> FieldDecompressor<R> for GpsTime {
    fn size_of_field(&self) -> usize {
        size_of::<i64>()
    }

    fn decompress_first(&mut self, source: &mut R, first: &mut [u8]) -> io::Result<()> {
        let mut time = [0; 8];
        source.read_exact(&mut time)?;
        first.copy_from_slice(&time);
        self.sequences[0].time = i64::from_le_bytes(time);
        Ok(())
    }

    fn decompress_with(&mut self, decoder: &mut ArithmeticDecoder<R>, time: &mut [u8]) -> io::Result<()> {
        for _ in 0..=MAX_SWITCHES {
            if self.step(decoder)? {
                time.copy_from_slice(&self.sequences[self.current].time.to_le_bytes());
                return Ok(());
            }
        }
        Err(io::Error::new(io::ErrorKind::InvalidData, "no GPS time, but switches between sequences of them"))
    }
}

//! The GPS times of LAZ, in the second version of their item.

use laz::{
    decoders::ArithmeticDecoder,
    decompressors::{IntegerDecompressor, IntegerDecompressorBuilder},
    models::{ArithmeticModel, ArithmeticModelBuilder},
    record::FieldDecompressor,
};
use std::io::{self, Read};

/// A run of times with small differences, such as one of several scanners' that take turns.
#[derive(Clone, Copy, Default)]
struct Sequence {
    /// The last time: the bits of a double, as an integer.
    time: i64,
    /// The difference that later ones are multiples of, about.
    difference: i32,
    /// How many differences were no such multiple.
    extremes: u8,
}

/// Four sequences, the most that an encoder keeps.
const SEQUENCES: usize = 4;
/// An encoder that finds a time near the last one of another sequence switches to it at once; by
/// steps of one, three switches reach every sequence.
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

/// The decompressor of the item, as the [LASzip paper] and its reference implementation have it.
///
/// [LASzip paper]: https://doi.org/10.14358/PERS.79.2.209
pub(super) struct GpsTime {
    sequences: [Sequence; SEQUENCES],
    current: usize,
    newest: usize,
    /// What comes next in a sequence whose difference is zero, which is that of a new one.
    first_symbols: ArithmeticModel,
    symbols: ArithmeticModel,
    /// What is to be added to a predicted number, in nine contexts.
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
    /// Reads one symbol with what belongs to it. Returns whether that was a time, and not a switch
    /// to another sequence.
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

#[cfg(test)]
mod tests {
    use super::*;
    use laz::{
        las::v2,
        record::{
            RecordCompressor, RecordDecompressor, SequentialPointRecordCompressor, SequentialPointRecordDecompressor,
        },
    };
    use rand::{RngExt, SeedableRng, seq::IndexedRandom};
    use rand_pcg::Pcg64Mcg;

    type Decompressor<'a> = SequentialPointRecordDecompressor<'a, &'a [u8]>;

    /// Returns the decompressors of a stream of times: the one here and that of the crate.
    fn decompressors(stream: &[u8]) -> [Decompressor<'_>; 2] {
        let [mut ours, mut theirs] = [Decompressor::new(stream), Decompressor::new(stream)];
        ours.add_field_decompressor(GpsTime::default());
        theirs.add_field_decompressor(v2::GpsTimeDecompressor::default());
        [ours, theirs]
    }

    /// Returns times that need every symbol: several sequences, most of which pass by multiples of
    /// a difference, small and large, of both signs, for a while or once.
    fn times(random: &mut Pcg64Mcg, count: usize) -> Vec<i64> {
        let mut sequences: Vec<i64> = (0..6).map(|i| i << 40).collect();
        let mut times = Vec::with_capacity(count);
        let (mut s, mut unit, mut multiple) = (0, 1_i64, 1_i64);
        while times.len() < count {
            match random.random_range(0..40) {
                0 => s = random.random_range(0..sequences.len()),
                1 => unit = *[1, 20, 1000, 1 << 20].choose(random).expect("four"),
                2 => multiple = *[0, 1, 7, 80, 499, 500, 501, 10_000].choose(random).expect("eight"),
                3 => multiple = -*[1, 9, 10, 11, 600].choose(random).expect("five"),
                4 => sequences[s] += i64::from(*[i32::MIN, i32::MAX].choose(random).expect("two")),
                5 => sequences[s] = i64::from(random.random::<i32>()) << 20,
                _ => {}
            }
            let jitter = if random.random_bool(0.3) { random.random_range(-unit / 5..=unit / 5) } else { 0 };
            sequences[s] += unit * multiple + jitter;
            times.push(sequences[s]);
        }
        times
    }

    #[test]
    fn what_the_crate_compresses() {
        for seed in 0..5 {
            let times = times(&mut Pcg64Mcg::seed_from_u64(seed), 20_000);
            let mut compressor = SequentialPointRecordCompressor::new(Vec::new());
            compressor.add_field_compressor(v2::GpsTimeCompressor::default());
            times.iter().for_each(|time| compressor.compress_next(&time.to_le_bytes()).expect("memory"));
            compressor.done().expect("memory");
            let stream = compressor.into_inner();
            for mut decompressor in decompressors(&stream) {
                for (i, time) in times.iter().enumerate() {
                    let mut read = [0; 8];
                    decompressor.decompress_next(&mut read).expect("whole");
                    assert_eq!(i64::from_le_bytes(read), *time, "time {i} of seed {seed}");
                }
            }
        }
    }
}

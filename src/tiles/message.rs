//! What tiles send each other.

use super::bytes::{Reader, TOO_LONG, Writer};
use crate::error::Error;

/// A point that another tile gets to know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Known<const D: usize> {
    /// Its index in the whole input.
    pub(super) index: u32,
    /// The tile that it belongs to.
    pub(super) owner: u32,
    pub(super) at: [f64; D],
}

/// What a tile sends to another one, in plain bytes on its way.
///
/// # Examples
///
/// ```
/// use gdel::tiles::Message;
///
/// // Bytes from elsewhere are checked.
/// assert!(Message::<3>::from_bytes(&[1, 2, 3]).is_err());
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Message<const D: usize>(pub(super) Content<D>);

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Content<const D: usize> {
    /// The lowest and the highest coordinates of the tile's own points; and, for each of the common points that
    /// duplicates another one, its index and that of the other.
    Hello { bounds: Option<[[f64; D]; 2]>, duplicates: Vec<[u32; 2]> },
    /// Points that the other tile does not know.
    Points(Vec<Known<D>>),
}

const HELLO: u32 = u32::from_le_bytes(*b"gdt0");
const POINTS: u32 = u32::from_le_bytes(*b"gdt1");

impl<const D: usize> Message<D> {
    /// Returns the number of points in it.
    pub fn points(&self) -> usize {
        match &self.0 {
            Content::Hello { .. } => 0,
            Content::Points(points) => points.len(),
        }
    }

    /// Returns the message as bytes, the same on every machine.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Writer(Vec::new());
        match &self.0 {
            Content::Hello { bounds, duplicates } => {
                bytes.words(&[HELLO, D as u32, u32::from(bounds.is_some()), duplicates.len() as u32]);
                bytes.numbers(bounds.unwrap_or([[0.0; D]; 2]).as_flattened());
                bytes.words(duplicates.as_flattened());
            }
            Content::Points(points) => {
                bytes.words(&[POINTS, D as u32, points.len() as u32]);
                for p in points {
                    bytes.words(&[p.index, p.owner]);
                    bytes.numbers(&p.at);
                }
            }
        }
        bytes.0
    }

    /// Reads a message.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BadMessage`] if that is not one, or one of another dimension.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let mut bytes = Reader(bytes);
        let (kind, dimension) = (bytes.word()?, bytes.word()?);
        if dimension as usize != D {
            return Err(Error::BadMessage { reason: "it is of another dimension" });
        }
        let content = match kind {
            HELLO => {
                let (is_there, count) = (bytes.word()? != 0, bytes.word()?);
                let bounds = [bytes.point()?, bytes.point()?];
                let mut duplicates = vec![[0; 2]; bytes.count(count, 8)?];
                for pair in &mut duplicates {
                    *pair = [bytes.word()?, bytes.word()?];
                }
                Content::Hello { bounds: is_there.then_some(bounds), duplicates }
            }
            POINTS => {
                let count = bytes.word()?;
                let mut points = vec![Known { index: 0, owner: 0, at: [0.0; D] }; bytes.count(count, 8 + 8 * D)?];
                for p in &mut points {
                    *p = Known { index: bytes.word()?, owner: bytes.word()?, at: bytes.point()? };
                }
                Content::Points(points)
            }
            _ => return Err(Error::BadMessage { reason: "it does not begin like one" }),
        };
        if bytes.0.is_empty() { Ok(Message(content)) } else { Err(TOO_LONG) }
    }
}

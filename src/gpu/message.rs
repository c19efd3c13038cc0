//! Plain data as lists of words, to be sent to another thread and back.

use crate::{
    error::Error,
    stats::{ExactCounts, SplayStats},
};
use bytemuck::{AnyBitPattern, NoUninit};

/// The words of a message: numbers in the first list, each array in a list of its own.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Packer {
    numbers: Vec<u32>,
    arrays: Vec<Vec<u32>>,
}

impl Packer {
    /// Returns the lists of a message.
    pub fn pack(message: impl Message) -> Vec<Vec<u32>> {
        let mut packer = Packer::default();
        message.write(&mut packer);
        let Packer { numbers, arrays } = packer;
        std::iter::once(numbers).chain(arrays).collect()
    }
}

/// Reads what a [`Packer`] has written.
#[derive(Debug)]
pub struct Unpacker {
    numbers: std::vec::IntoIter<u32>,
    arrays: std::vec::IntoIter<Vec<u32>>,
}

impl Unpacker {
    /// Returns the message in these lists; `None` if they are no such message.
    pub fn unpack<M: Message>(lists: Vec<Vec<u32>>) -> Option<M> {
        let mut arrays = lists.into_iter();
        let mut unpacker = Unpacker { numbers: arrays.next()?.into_iter(), arrays };
        let message = M::read(&mut unpacker)?;
        let is_all = unpacker.numbers.as_slice().is_empty() && unpacker.arrays.as_slice().is_empty();
        is_all.then_some(message)
    }
}

/// Plain data that can be sent to another thread.
pub trait Message: Sized {
    /// Adds the words.
    fn write(self, to: &mut Packer);

    /// Takes them back; `None` if they do not fit.
    fn read(from: &mut Unpacker) -> Option<Self>;
}

/// Implements [`Message`] for structures whose fields are messages.
macro_rules! message {
    ($(impl[$($generics:tt)*])? $name:ty { $($field:ident),* $(,)? } $(where $($bounds:tt)*)?) => {
        impl $(<$($generics)*>)? $crate::gpu::message::Message for $name $(where $($bounds)*)? {
            fn write(self, to: &mut $crate::gpu::message::Packer) {
                let Self { $($field),* } = self;
                $($crate::gpu::message::Message::write($field, to);)*
            }

            fn read(from: &mut $crate::gpu::message::Unpacker) -> Option<Self> {
                Some(Self { $($field: $crate::gpu::message::Message::read(from)?),* })
            }
        }
    };
}
pub(crate) use message;

impl Message for u32 {
    fn write(self, to: &mut Packer) {
        to.numbers.push(self);
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        from.numbers.next()
    }
}

impl Message for u64 {
    fn write(self, to: &mut Packer) {
        to.numbers.extend([self as u32, (self >> 32) as u32]);
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        Some(u64::from(from.numbers.next()?) | u64::from(from.numbers.next()?) << 32)
    }
}

/// Numbers that travel as 64 bits.
macro_rules! as_u64 {
    ($($number:ty),*) => {$(
        impl Message for $number {
            fn write(self, to: &mut Packer) {
                (self as i64 as u64).write(to);
            }

            fn read(from: &mut Unpacker) -> Option<Self> {
                Some(u64::read(from)? as i64 as $number)
            }
        }
    )*};
}
as_u64!(i64, usize, isize);

impl Message for bool {
    fn write(self, to: &mut Packer) {
        u32::from(self).write(to);
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        Some(u32::read(from)? != 0)
    }
}

impl<T: NoUninit + AnyBitPattern> Message for Vec<T> {
    fn write(self, to: &mut Packer) {
        to.arrays.push(bytemuck::cast_vec(self));
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        match bytemuck::try_cast_vec(from.arrays.next()?) {
            Ok(items) => Some(items),
            // The memory has room for a part of an item.
            Err((_, words)) => Some(bytemuck::try_cast_slice(&words).ok()?.to_vec()),
        }
    }
}

impl<T: Message, const N: usize> Message for [T; N] {
    fn write(self, to: &mut Packer) {
        self.into_iter().for_each(|item| item.write(to));
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        let items: Option<Vec<T>> = (0..N).map(|_| T::read(from)).collect();
        items?.try_into().ok()
    }
}

impl<T: Message> Message for Option<T> {
    fn write(self, to: &mut Packer) {
        self.is_some().write(to);
        if let Some(value) = self {
            value.write(to);
        }
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        Some(if bool::read(from)? { Some(T::read(from)?) } else { None })
    }
}

impl<T: Message, E: Message> Message for Result<T, E> {
    fn write(self, to: &mut Packer) {
        self.is_ok().write(to);
        match self {
            Ok(value) => value.write(to),
            Err(error) => error.write(to),
        }
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        Some(if bool::read(from)? { Ok(T::read(from)?) } else { Err(E::read(from)?) })
    }
}

/// Those errors that the work on coordinates can end with.
impl Message for Error {
    fn write(self, to: &mut Packer) {
        let [kind, number, axis, value] = match self {
            Error::NotFinite { index, axis, value } => {
                let value = VALUES.iter().position(|&other| other == value);
                [0, index, axis as usize, value.unwrap_or_default()]
            }
            Error::TooManySimplices { limit } => [1, limit, 0, 0],
            Error::OutOfMemory { simplices } => [2, simplices, 0, 0],
            _ => [3, 0, 0, 0],
        };
        [kind, number, axis, value].write(to);
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        let [kind, number, axis, value] = <[usize; 4]>::read(from)?;
        Some(match kind {
            0 => {
                let axis = char::from_u32(axis as u32)?;
                Error::NotFinite { index: number, axis, value: VALUES.get(value)? }
            }
            1 => Error::TooManySimplices { limit: number },
            2 => Error::OutOfMemory { simplices: number },
            _ => Error::Cancelled,
        })
    }
}

/// What is not finite, as [`Error::NotFinite`] names it.
const VALUES: [&str; 3] = ["NaN", "inf", "-inf"];

message!(ExactCounts { integer, expansion, symbolic });
message!(SplayStats {
    peeled,
    failed,
    built,
    pulled,
    flips,
    removed,
    added,
    inserted,
    signs,
    rounds,
    gathers,
    gathered,
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_come_back() {
        let lists = Packer::pack([Ok(vec![[1u32, 2], [3, 4]]), Err(Error::OutOfMemory { simplices: 1 << 40 })]);
        assert_eq!(lists.len(), 2);
        let back = Unpacker::unpack::<[Result<Vec<[u32; 2]>, Error>; 2]>(lists);
        assert_eq!(back, Some([Ok(vec![[1, 2], [3, 4]]), Err(Error::OutOfMemory { simplices: 1 << 40 })]));
        assert_eq!(Unpacker::unpack::<Option<isize>>(Packer::pack(Some(-7isize))), Some(Some(-7)));
    }

    #[test]
    fn what_is_no_such_message_is_none() {
        assert_eq!(Unpacker::unpack::<u64>(vec![vec![1]]), None);
        assert_eq!(Unpacker::unpack::<u32>(vec![vec![1, 2]]), None);
        assert_eq!(Unpacker::unpack::<Vec<[u32; 2]>>(vec![vec![], vec![1, 2, 3]]), None);
        assert_eq!(Unpacker::unpack::<u32>(vec![vec![1], vec![]]), None);
    }
}

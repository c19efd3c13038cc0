//! Points of the caller.

use crate::{device::Device, error::failed};
use cudarc::driver::result::memcpy_dtoh_sync;
use gdel::{Error, Points};
use std::{any::Any, fmt};

/// The type of coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// `f32`.
    Single,
    /// `f64`.
    Double,
}

/// Points in CUDA memory, one row after the other.
pub struct Tensor {
    address: u64,
    rows: usize,
    columns: usize,
    precision: Precision,
    ordinal: usize,
    /// Keeps the memory.
    _owner: Box<dyn Any + Send + Sync>,
}

impl Tensor {
    /// Describes points: the address of the first one, how many rows and columns there are, and on which of CUDA's
    /// GPUs. `owner` is kept as long as the tensor.
    ///
    /// # Safety
    ///
    /// As long as the tensor lives, the memory has to be there and nobody may write it. What was to write it must have
    /// been started on the default stream of CUDA, or on one that this waits for.
    pub unsafe fn new(
        address: u64,
        [rows, columns]: [usize; 2],
        precision: Precision,
        ordinal: usize,
        owner: impl Any + Send + Sync,
    ) -> Self {
        Tensor { address, rows, columns, precision, ordinal, _owner: Box::new(owner) }
    }

    /// Returns the number of points.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the number of coordinates per point.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Returns the number of the GPU among those of CUDA.
    pub fn ordinal(&self) -> usize {
        self.ordinal
    }

    /// Reads the points.
    ///
    /// # Errors
    ///
    /// Returns [`Error::OutOfMemory`], and [`Error::Gpu`] for another GPU, another number of coordinates, and failures.
    pub(crate) fn read<const D: usize>(&self, device: &Device) -> Result<HostPoints<D>, Error> {
        if self.ordinal != device.ordinal() {
            let reason = format!("the points are on GPU {}, not on GPU {}", self.ordinal, device.ordinal());
            return Err(Error::Gpu { reason });
        }
        if self.columns != D {
            return Err(Error::Gpu { reason: format!("the points have {} coordinates, not {D}", self.columns) });
        }
        device.context.bind_to_thread().map_err(failed)?;
        match self.precision {
            Precision::Single => self.read_as().map(HostPoints::Single),
            Precision::Double => self.read_as().map(HostPoints::Double),
        }
    }

    fn read_as<T: bytemuck::Pod, const D: usize>(&self) -> Result<Vec<[T; D]>, Error> {
        let points = bytemuck::try_zeroed_vec::<[T; D]>(self.rows);
        let mut points = points.map_err(|()| Error::OutOfMemory { simplices: self.rows })?;
        if self.rows > 0 {
            // SAFETY: who made the tensor has made sure that so many are there, and the default stream is the one that
            // was waited for.
            unsafe { memcpy_dtoh_sync(points.as_flattened_mut(), self.address) }.map_err(failed)?;
        }
        Ok(points)
    }
}

impl fmt::Debug for Tensor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Tensor { address, rows, columns, precision, ordinal, .. } = self;
        write!(f, "Tensor {{ {precision:?}, shape: [{rows}, {columns}], address: {address:#x}, GPU: {ordinal} }}")
    }
}

/// Points in the memory of the host.
pub(crate) enum HostPoints<const D: usize> {
    Single(Vec<[f32; D]>),
    Double(Vec<[f64; D]>),
}

impl<const D: usize> HostPoints<D> {
    pub(crate) fn points(&self) -> Points<'_, D> {
        match self {
            HostPoints::Single(points) => Points::F32(points),
            HostPoints::Double(points) => Points::F64(points),
        }
    }
}

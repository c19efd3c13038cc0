//! Settings for Phase 1.

use crate::{
    dimension::Dimension,
    gpu::{
        Gpu, Parts,
        dim::Dim,
        layout::{Counters, Pick},
        phase1::buffers::largest_bytes,
        update::Limits,
    },
    options::Winding,
    platform,
};
use std::time::Duration;

/// Settings for Phase 1 in `D` dimensions, for experiments: they change the time, and not the set
/// of simplices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings<const D: usize> {
    /// How points are picked. The circumcentre is that of a tetrahedron's sphere or of a triangle's
    /// circle.
    pub pick: Pick,
    /// Whether to insert all points before flipping (§5.3; `InsAll` in Figure 12).
    pub insert_all: bool,
    /// How many of the points the CPU engine triangulates first, while the device orders them;
    /// `None` for what was measured to be best.
    pub start_points: Option<u32>,
    /// The largest active count at which a round ends while points wait. A round also goes on until fewer
    /// simplices are active than one per four points that are inserted (16 where many signs are exact), and
    /// than one per 16 points of the input.
    pub min_active: u32,
    /// How much device memory a run gets.
    pub memory: MemorySettings,
    /// 3D only: with at most so many active tetrahedra, flip iterations are done in one workgroup,
    /// without a dispatch per pass.
    pub few: u32,
    /// The rounds of insertion and flips that are submitted together, at most
    /// [`LOGGED`](crate::gpu::layout::LOGGED); those that insert few points, or take
    /// hardly any time, are in one batch if there are several.
    pub rounds: u32,
    /// The batches of rounds that are submitted before the counters of the first one are read.
    pub batches: u32,
    /// What a run may cost before it is given up.
    pub budget: Budget,
    /// Whether points are ordered along the Hilbert curve, and so are the slots of their simplices
    /// in memory (§4.3, Figure 12).
    pub sort: bool,
    /// 3D only: how the mesh comes to a host that wants to have it; `None` for what is fastest.
    pub way_to_host: Option<WayToHost>,
    /// 2D only: the orientation of the mesh.
    pub winding: Winding,
}

/// How a 3D mesh comes to the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WayToHost {
    /// The host reads the mesh, then splays it.
    ReadFirst,
    /// The host splays the mesh while another of its threads reads it.
    ReadMeanwhile,
    /// The host splays the stars that it gathers, and the device makes the arrays. That saves most of the host's memory, and
    /// takes longer than to read the mesh before it is splayed.
    MadeOnDevice,
}

/// How much device memory a run gets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemorySettings {
    /// 3D only: there is a block in the tail for so many points, at the start and again whenever
    /// slots run out.
    pub points_per_tail_block: u32,
    /// Nodes of the history per point, if the device can bind so many. Flips for which there is no
    /// room wait for the next round.
    pub history: u32,
    /// 3D only: the size of the parts of large arrays, in bytes; `None` to have them in parts where
    /// there are too many points for one buffer, which then are as large as the device can bind.
    pub part_bytes: Option<u64>,
}

/// What a run may cost before it is given up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Budget {
    /// The flip iterations before flips are counted; see [`Settings::is_slow`].
    pub spare_iterations: u32,
    /// The flips that earn a run one more flip iteration.
    pub flips_per_iteration: u32,
    /// How wrong a mesh may be after its points have moved, so that repairing it pays.
    pub limits: Limits,
    /// About the longest time that a device is busy with one submission, so that others can use it, too, and that no
    /// system takes it for dead.
    pub submission: Duration,
}

impl<const D: usize> Default for Settings<D>
where
    Dimension<D>: Dim<D>,
{
    fn default() -> Self {
        Settings {
            pick: Pick::default(),
            insert_all: false,
            start_points: None,
            min_active: u32::MAX,
            memory: MemorySettings { points_per_tail_block: 16, history: Dimension::<D>::HISTORY, part_bytes: None },
            few: 256,
            rounds: 1,
            batches: 2,
            budget: Budget {
                spare_iterations: 256,
                flips_per_iteration: 256,
                limits: Limits::measured(D),
                submission: Duration::from_millis(30),
            },
            sort: true,
            way_to_host: platform::MESHES_STAY_ON_DEVICE.then_some(WayToHost::MadeOnDevice),
            winding: Winding::CounterClockwise,
        }
    }
}

/// Rounds for few points, and points for each further round, beyond which a run does not come to an end on its own. Ordinary
/// inputs take about ten, and those whose flips wait for each other are given up before ([`Settings::is_slow`]). A round
/// inserts a point into every simplex that has any: even where each point is half as far from the next as the one before,
/// coordinates have too few bits for so many rounds.
const MOST_ROUNDS: usize = 1024;
const POINTS_PER_ROUND: usize = 64;

/// The smallest tail, in blocks: small inputs seldom have to grow it.
const MIN_TAIL_BLOCKS: u32 = 64;

impl<const D: usize> Settings<D> {
    /// Returns the blocks that are added to the tail at a time.
    pub(crate) fn tail_blocks(&self, points: u32) -> u32 {
        MIN_TAIL_BLOCKS + points / self.memory.points_per_tail_block.max(1)
    }

    /// Returns the blocks for so many points, with the first tail.
    pub(crate) fn first_blocks(&self, points: u32) -> u32
    where
        Dimension<D>: Dim<D>,
    {
        Dimension::<D>::blocks(points, self.tail_blocks(points))
    }

    /// Returns how many of `count` points the CPU engine triangulates first. The corners of the
    /// first simplex are always among them.
    pub(crate) fn start_points(&self, count: usize) -> usize
    where
        Dimension<D>: Dim<D>,
    {
        self.start_points.map_or_else(|| Dimension::<D>::start_points(count), |n| n as usize).max(D + 1)
    }

    /// Returns the parts that large arrays are in for so many points; `None` if each is in one buffer.
    ///
    /// One buffer has to have room for an eighth more slots, because a run may ask for more.
    pub fn parts(&self, gpu: &Gpu, points: usize) -> Option<Parts>
    where
        Dimension<D>: Dim<D>,
    {
        let points = u32::try_from(points).ok().filter(|&points| points as usize <= Dimension::<D>::MAX_POINTS)?;
        if D != 3 {
            return None;
        }
        match self.memory.part_bytes {
            Some(bytes) => Parts::with_bytes(&gpu.device().limits(), bytes),
            None => {
                let bytes = largest_bytes(self.first_blocks(points));
                let largest = gpu.max_storage_bytes();
                let is_too_much = bytes + bytes / 8 > largest.into();
                if is_too_much { Parts::with_bytes(&gpu.device().limits(), largest) } else { None }
            }
        }
    }

    /// Returns whether a run with so many points has taken more rounds than it can.
    pub(crate) fn is_endless(counters: &Counters, points: usize) -> bool {
        counters.round as usize > MOST_ROUNDS + points / POINTS_PER_ROUND
    }

    /// Returns whether the flips of a run wait for each other, so that the CPU engine finishes
    /// sooner.
    ///
    /// An iteration takes a device some 60 µs if few simplices are active, in which the CPU engine
    /// does what takes Phase 1 some 400 flips. Ordinary inputs of 10,000 points have 300 to 1,000
    /// flips per iteration; on the moment curve or two skew lines there are 10 to 30, however many
    /// the points are. What few points take is within the spare iterations.
    pub fn is_slow(&self, counters: &Counters) -> bool {
        let Budget { spare_iterations, flips_per_iteration, .. } = self.budget;
        counters.iterations > spare_iterations.saturating_add(counters.flips() / flips_per_iteration.max(1))
    }
}

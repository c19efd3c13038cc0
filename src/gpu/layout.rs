//! What the kernels of Phase 1 keep in GPU buffers.
//!
//! The structures have counterparts of the same name and layout in `shaders/`, which the compiler
//! compares; the constants are those of the shaders.
//!
//! **Points** are sorted along the Hilbert curve; a *vertex* is a place in that order. Vertex `n`
//! (the number of points) is the vertex at infinity. Its record holds the *interior point*, a point
//! inside the first tetrahedron, and infinity lies opposite to it: replacing infinity by the
//! interior point flips the sign of an orientation.
//!
//! **Tetrahedra** live in slots. Slots 8v … 8v + 7 are the *block* of vertex *v*, so that a
//! tetrahedron is near its vertices in memory without any sorting; the blocks after that of infinity
//! are the *tail*, which serves when the blocks of all vertices of a flip are full. At the end of
//! the buffer `control` there is one word per block whose low bits tell which of its slots are free.
//!
//! **Neighbours** are packed as 4·tetrahedron + face: entry *k* of a tetrahedron is the facet
//! opposite its vertex *k*, as the tetrahedron on the other side numbers it.

use bytemuck::{Pod, Zeroable};

use crate::{
    gpu::shader::{
        assert_layout,
        constants::{common, d3},
    },
    index::NONE,
};

const _: () = assert!(common::NONE == NONE, "kernels and host have the same mark");

/// Slots in a block.
pub const BLOCK: u32 = common::BLOCK;
/// The word of a block whose slots are all free.
pub const ALL_FREE: u32 = common::ALL_FREE;
/// In 3D, the first bit of the round in which a vertex was inserted, in the word of its block. The bits below
/// are its free slots.
pub const ROUND_SHIFT: u32 = common::ROUND_SHIFT;

/// The status of a tetrahedron.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Status {
    /// Facets to check (bits 0–3): the tetrahedron is in the active list exactly when there are
    /// some. Facets that were found not locally Delaunay but not flippable (bits 4–7). The
    /// insertion round in which waiting points may lie inside (bits 16–31).
    pub flags: u32,
    /// The node of the history that made this tetrahedron, plus 1, times 4, plus which of its
    /// tetrahedra it is; 0 if no flip of the round did, or no waiting point may lie inside.
    pub last: u32,
    /// The highest bid for this tetrahedron. The bids of a flip iteration are above all those of
    /// the ones before it.
    pub vote: u32,
    /// The first node of the round that changed the tetrahedron in this slot as it was after the
    /// splits, plus 1; 0 if there is none. Valid where waiting points lay in it then.
    pub first: u32,
}
assert_layout!(Status);

/// The facets to check, in [`Status::flags`].
pub const CHECK: u32 = common::CHECK;
/// Where the facets that are not locally Delaunay and not flippable start in [`Status::flags`].
pub const SUSPECT_SHIFT: u32 = common::SUSPECT_SHIFT;
/// Where the insertion round starts in [`Status::flags`].
pub const HELD_SHIFT: u32 = common::HELD_SHIFT;

/// An entry of the active list.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Active {
    /// The tetrahedron.
    pub tet: u32,
    /// What the current flip iteration found: the facets still to check (bits 0–3), the facets that
    /// cannot be flipped (bits 4–7), the kind of the proposed flip (bits 8–9), its facet (bits
    /// 10–11) and edge (bits 12–13). A flip that was carried out leaves [`DONE`], and in 3D
    /// [`DONE_23`] or the slot that a 3-2 flip gives back.
    pub outcome: u32,
}
assert_layout!(Active);

/// Where the kind of flip is in [`Active::outcome`].
pub const KIND_SHIFT: u32 = common::KIND_SHIFT;
/// Where the facet is in [`Active::outcome`].
pub const FACET_SHIFT: u32 = common::FACET_SHIFT;
/// Where the edge is in [`Active::outcome`].
pub const EDGE_SHIFT: u32 = d3::EDGE_SHIFT;
/// A flip of two tetrahedra into three, in [`Active::outcome`] and [`FlipNode::kind`].
pub const FLIP_23: u32 = d3::FLIP_23;
/// A flip of three tetrahedra into two.
pub const FLIP_32: u32 = d3::FLIP_32;
/// The flip was carried out.
pub const DONE: u32 = common::DONE;
/// It was a flip of two tetrahedra into three.
pub const DONE_23: u32 = d3::DONE_23;
/// Where the slot that was given back is in [`Active::outcome`], with [`DONE`].
pub const SLOT_SHIFT: u32 = d3::SLOT_SHIFT;

/// A flip in the history.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct FlipNode {
    /// The ring around the edge, x₀, x₁, x₂: with the ends of the edge, the tetrahedra
    /// (xᵢ, xᵢ₊₁, d, e) are positively oriented.
    pub ring: [u32; 3],
    /// One end of the edge.
    pub d: u32,
    /// The tetrahedra that it made: 2-3, (xᵢ, xᵢ₊₁, d, e); 3-2, that with e and that with d.
    pub tets: [u32; 3],
    /// The other end of the edge.
    pub e: u32,
    /// The nodes that changed these later, or [`NONE`].
    pub next: [u32; 3],
    /// [`FLIP_23`] or [`FLIP_32`].
    pub kind: u32,
}
assert_layout!(FlipNode);

/// The counters that the kernels share, and the parameters that they set themselves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Counters {
    /// The flip iteration, as checking and committing see it.
    pub iteration: u32,
    /// The flip iteration, as linking sees it. There are two, so that no kernel writes the one that it reads.
    pub link_iteration: u32,
    /// The lowest bid of the flip iteration, as checking and committing see it.
    pub bid_base: u32,
    /// The same, as linking sees it.
    pub link_bid_base: u32,
    /// With fewer active tetrahedra than this a flip iteration does nothing.
    pub min_active: u32,
    /// Entries of the list of waiting points.
    pub entries: u32,
    /// Entries of the list before it was compacted in this round; 0 if it was not.
    pub entries_before: u32,
    /// The half of the list that is in use: 0 or 1.
    pub waiting_half: u32,
    /// Entries in the two halves of the active list; iteration *i* uses half *i* mod 2.
    pub active_len: [u32; 2],
    /// The insertion round, from 1.
    pub round: u32,
    /// Nodes of the history that were requested in this round; there may be room for fewer.
    pub next_node: u32,
    /// Points inserted so far, the first four included.
    pub inserted: u32,
    /// 2-3 flips so far.
    pub flips_23: u32,
    /// 3-2 flips so far.
    pub flips_32: u32,
    /// Signs that took exact arithmetic so far.
    pub exact: u32,
    /// What has run out: [`SLOTS_FULL`], [`HISTORY_FULL`].
    pub overflow: u32,
    /// Flip iterations that had something to do.
    pub iterations: u32,
    /// Entries of the active list in all flip iterations.
    pub visits: u32,
    /// Failed vertices; in 2D, inverted triangles where points have moved.
    pub failed: u32,
    /// Points at the same place of the lattice as another one, which stands for them.
    pub merged: u32,
    /// Tetrahedra that are flat, or of which the lattice does not prove everything; in 2D,
    /// tests that the host decides.
    pub uncertain: u32,
    /// Infinite tetrahedra, counted when they are numbered.
    pub ghosts: u32,
    /// Entries of the active list that the filter left open in this flip iteration.
    pub undecided: u32,
    /// Facets that are not locally Delaunay, found at the end.
    pub not_locally_delaunay: u32,
    /// In 2D: flips so far.
    pub flips_22: u32,
    /// In 2D: edges of the hull.
    pub hull: u32,
    /// Flip iterations that were done in one workgroup.
    pub few_done: u32,
    /// Entries of the list of waiting points that were kept when it was compacted in this round.
    pub kept: u32,
    /// After points have moved: the facets of the hull that were found in the mesh.
    pub moved_hull: u32,
    /// After points have moved: the simplices that are not positively oriented; 2³¹ and more if the
    /// arrays of the mesh are not those of a triangulation.
    pub inverted: u32,
    /// After points have moved: the facets between positively oriented simplices that are not locally
    /// Delaunay, as far as the filter decides.
    pub violated: u32,
    /// How simplices pick their points in this round: a [`Pick`] that is not adaptive.
    pub criterion: u32,
    /// Points for which the walk to their simplex of the start took too many steps.
    pub long_walks: u32,
    /// Tetrahedra of the mesh that are gathered at a time, at the end.
    pub gathered: u32,
    /// In 3D: facets that were removed because they could not be flipped.
    pub removed: u32,
    /// In 3D: the rounds in which such facets were looked for.
    pub removals: u32,
    /// The sum of the hashes of the facets of the mesh, which is 0 for every mesh: see [`mesh_check`](crate::gpu::mesh_check).
    pub mesh_sum: u32,
    /// In 3D: the points that have one of their tetrahedra.
    pub mesh_vertices: u32,
    /// For each pass of this flip iteration and of this round, how many entries of its list the workgroups
    /// have taken.
    pub taken: [u32; 5],
    /// What the rounds have done: entry *r* modulo [`LOGGED`] is the state after round *r*, as
    /// [`Counters::progress`] returns it.
    pub log: [[u32; 5]; LOGGED],
}
assert_layout!(Counters);

impl Counters {
    /// Returns the flips of all kinds so far.
    pub fn flips(&self) -> u32 {
        self.flips_23.saturating_add(self.flips_32).saturating_add(self.flips_22)
    }

    /// Returns the number of active simplices.
    pub(crate) fn active(&self) -> u32 {
        self.active_len[(self.iteration & 1) as usize]
    }

    /// Returns whether many signs took exact arithmetic.
    pub fn is_exact(&self) -> bool {
        self.exact > self.visits / common::WAITING_EXACT_SHARE
    }

    /// Returns the active count at which a round ends that begins with so many points inserted, if others wait:
    /// with fewer active simplices, flips are left to the next round.
    pub fn min_active(&self, params: &Params, inserted: u32) -> u32 {
        let shift = if self.is_exact() { common::WAITING_EXACT_SHIFT } else { common::WAITING_SHIFT };
        params.max_min_active.min(inserted >> shift)
    }

    /// Returns what was done so far: points inserted, active simplices, flips, flip iterations, and
    /// those of them that were done in one workgroup.
    pub fn progress(&self) -> [u32; 5] {
        [self.inserted, self.active(), self.flips(), self.iterations, self.few_done]
    }
}

/// A flip was put off because no slot was found for its third tetrahedron.
pub const SLOTS_FULL: u32 = common::SLOTS_FULL;
/// A flip was put off because the history was full.
pub const HISTORY_FULL: u32 = common::HISTORY_FULL;

/// The parameters of the kernels. In the buffer `control` it stands before the [`Counters`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Params {
    /// The number of points, which is also the number of the vertex at infinity.
    pub infinite: u32,
    /// Blocks, those of the tail included.
    pub blocks: u32,
    /// Nodes that the history can hold.
    pub history: u32,
    /// With at most so many active tetrahedra, flip iterations are done in one workgroup; 0 for
    /// never.
    pub few: u32,
    /// One workgroup stops doing iterations when more than so many tetrahedra are active.
    pub few_limit: u32,
    /// The most flip iterations that one workgroup does in a dispatch.
    pub few_iterations: u32,
    /// The largest [`Counters::min_active`].
    pub max_min_active: u32,
    /// 1 if there are no flips while points wait.
    pub insert_all: u32,
    /// How a tetrahedron picks its point: a [`Pick`].
    pub pick: u32,
    /// Block count before the last growth.
    pub blocks_before: u32,
    /// In 2D: 1 for a mesh that is clockwise with *y* up, 0 for one that is counter-clockwise.
    pub clockwise: u32,
    /// The points that the start triangulates.
    pub start_points: u32,
    /// The simplices of the start.
    pub start_simplices: u32,
    /// The vertices of a stretch; for each stretch, a simplex of the start nearby is known.
    pub start_stride: u32,
    /// In a run that goes on from a mesh whose points have moved, the number of its simplices; 0 in
    /// others.
    pub moved_simplices: u32,
    /// The number of facets of its hull.
    pub moved_ghosts: u32,
    /// The unused slots per 1,024 used ones, over which simplices and ghosts are spread.
    pub moved_spread: u32,
    /// With more inverted simplices than this, the points are inserted from scratch and nothing is flipped.
    pub moved_inverted: u32,
    /// The same for facets that are not locally Delaunay.
    pub moved_violated: u32,
}
assert_layout!(Params);

/// The rounds that [`Counters::log`] keeps.
pub const LOGGED: usize = common::LOGGED as usize;

/// The fewest points with which a round must begin to tell how the points fill space.
pub const GROWTH_FROM: u32 = common::GROWTH_FROM;
/// The share of all points, as a divisor, with which such a round must end at most.
pub const GROWTH_SHARE: u32 = common::GROWTH_SHARE;
/// Twice the growth in such a round from which on points fill space evenly.
pub const TWICE_GROWTH: u32 = common::TWICE_GROWTH;

/// Words of [`Params`], after which the [`Counters`] stand in the buffer `control`.
pub const PARAM_WORDS: usize = size_of::<Params>() / 4;
/// Words of [`Counters`].
pub const COUNTER_WORDS: usize = size_of::<Counters>() / 4;
/// Words of the buffer `control` before the free slots of the blocks, which end it.
pub const FREE_START: usize = PARAM_WORDS + COUNTER_WORDS;

/// Which of its waiting points a tetrahedron inserts (the paper's §5.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u32)]
pub enum Pick {
    /// The one nearest to the circumcentre.
    Circumcenter = common::PICK_CIRCUMCENTER,
    /// The one nearest to the centroid.
    Centroid = common::PICK_CENTROID,
    /// Any.
    Random = common::PICK_RANDOM,
    /// The centroid if there are many points and the first rounds show that they fill space evenly: it takes fewer
    /// flips, and about a sixth fewer vertices fail. Otherwise the circumcentre: with the centroid, twice as many
    /// vertices would fail of points near a surface.
    #[default]
    Adaptive = common::PICK_ADAPTIVE,
}

impl Pick {
    /// All of them.
    pub const ALL: [Pick; 4] = [Pick::Adaptive, Pick::Circumcenter, Pick::Centroid, Pick::Random];
}

/// A point that waits to be inserted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Waiting {
    /// The point.
    pub point: u32,
    /// The tetrahedron that it lies in; [`NONE`] once it is inserted.
    pub tet: u32,
}
assert_layout!(Waiting);

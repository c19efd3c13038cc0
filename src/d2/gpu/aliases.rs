//! Buffers of 2D that the end of Phase 1 uses for other contents.
//!
//! | buffer | during the rounds | at the end |
//! | --- | --- | --- |
//! | `messages` | scores and points while they are picked; messages | the triangles of the mesh |
//! | `status` | the status of each slot | the half-edges of the mesh |
//! | `waiting` | the list of waiting points | the edges of the hull |
//! | `active` | the active list | the tests that rounding makes uncertain |
//! | `scores` | the scores of waiting points | |

use crate::{
    d2::gpu::layout::UncertainTest,
    gpu::{
        Binding, Storage,
        layout::{Active, Status, Waiting},
        phase1::{self, Buffers, Slot},
    },
};

/// The contents at the end of Phase 1, in buffers of the rounds.
#[derive(Debug)]
pub struct Aliases {
    /// The vertices of the triangles, as places in the input.
    pub triangles: Storage<[u32; 3]>,
    /// The half-edge that runs against each.
    pub halfedges: Storage<[u32; 3]>,
    /// The half-edges of the hull, from where to where.
    pub hull: Storage<[u32; 2]>,
    /// What the lattice does not prove of the true coordinates, as far as there is room.
    pub uncertain: Storage<UncertainTest>,
}

// The mesh has no more triangles than there are slots.
const _: () = assert!(size_of::<Slot>() >= size_of::<[u32; 3]>());
const _: () = assert!(size_of::<Status>() >= size_of::<[u32; 3]>());
// The hull has no more edges than there are points.
const _: () = assert!(size_of::<Waiting>() >= size_of::<[u32; 2]>());
// The active list has two entries per slot: there is room for one test per slot.
const _: () = assert!(2 * size_of::<Active>() >= size_of::<UncertainTest>());

impl phase1::Aliases<2> for Aliases {
    fn new(b: &Buffers<2>) -> Self {
        Aliases {
            triangles: b.messages.cast(),
            halfedges: b.status.cast(),
            hull: b.waiting.list.cast(),
            uncertain: b.active.cast(),
        }
    }

    fn arrays(&self) -> [Storage<[u32; 3]>; 2] {
        [self.triangles.clone(), self.halfedges.cast()]
    }

    fn bindings(&self) -> Vec<Binding<'_>> {
        vec![
            ("mesh_triangles", self.triangles.buffer()),
            ("halfedges", self.halfedges.buffer()),
            ("hull", self.hull.buffer()),
            ("uncertain_tests", self.uncertain.buffer()),
        ]
    }
}

//! Buffers of 3D that the end of Phase 1 uses for other contents.
//!
//! | buffer | during the rounds | at the end |
//! | --- | --- | --- |
//! | `messages` | scores and points while they are picked; the list of undecided checks; messages | the tetrahedra of the mesh |
//! | `active` | the active list | the neighbours of the mesh |
//! | `status` | the status of each slot, until the failed vertices are marked | the list of uncertain tetrahedra |
//! | `simplices`, `neighbors` | the slots | tetrahedra that are gathered, and those of a patch |
//! | `scores` | the scores of waiting points | the list of failed vertices |

use crate::gpu::{
    Binding, Storage, append_bindings,
    layout::{Active, Status},
    phase1::{self, Buffers, Slot},
};

/// The contents at the end of Phase 1, in buffers of the rounds.
#[derive(Debug)]
pub struct Aliases {
    /// The mesh without gaps: vertices of the tetrahedra, as places in the input. Infinite
    /// tetrahedra come last, and have infinity last.
    pub tets: Storage<Slot>,
    /// Neighbours, 4·tetrahedron + face.
    pub neighbors: Storage<Slot>,
    /// Tetrahedra that are flat or of which the lattice does not prove everything, with what is
    /// open, as `shaders/d3/certify.wgsl` has it.
    pub uncertain: Storage<Active>,
    /// The places in the input of the failed vertices.
    pub failed: Storage<u32>,
    /// The vertices of gathered tetrahedra, then of those of a patch.
    pub gathered_tetrahedra: Storage<Slot>,
    /// The neighbours of gathered tetrahedra, then of those of a patch.
    pub gathered_neighbors: Storage<Slot>,
}

// The mesh has no more tetrahedra than there are slots, and the active list has two entries per
// slot.
const _: () = assert!(2 * size_of::<Active>() >= size_of::<Slot>());
// A slot's tetrahedron is listed at most once.
const _: () = assert!(size_of::<Status>() >= size_of::<Active>());

impl phase1::Aliases<3> for Aliases {
    fn new(b: &Buffers<3>) -> Self {
        Aliases {
            tets: b.messages.clone(),
            neighbors: b.active.cast(),
            uncertain: b.status.cast(),
            // There is a score per point, and no vertex is listed twice.
            failed: b.waiting.scores.clone(),
            gathered_tetrahedra: b.simplices.clone(),
            gathered_neighbors: b.neighbors.clone(),
        }
    }

    fn arrays(&self) -> [Storage<[u32; 4]>; 2] {
        [self.tets.clone(), self.neighbors.clone()]
    }

    fn bindings(&self) -> Vec<Binding<'_>> {
        let mut bindings = vec![("failed_points", self.failed.buffer())];
        append_bindings(
            &mut bindings,
            &[
                self.tets.named("mesh_tetrahedra"),
                self.neighbors.named("mesh_neighbors"),
                self.uncertain.named("uncertain"),
                self.gathered_tetrahedra.named("gathered_tetrahedra"),
                self.gathered_neighbors.named("gathered_neighbors"),
            ],
        );
        bindings
    }
}

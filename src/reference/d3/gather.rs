//! Gathering tetrahedra of the mesh, and writing changed ones back.

use crate::d3::splay::{Gathered, KEEP, Patch};

/// The mesh at the end of Phase 1, and which of its tetrahedra have been gathered.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mesh {
    /// The vertices of each tetrahedron, infinity last; all 0 for slots that are not used.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Their neighbours, 4·slot + facet.
    pub neighbors: Vec<[u32; 4]>,
    /// The vertex at infinity: the number of points.
    pub infinite: u32,
    /// A bit per point.
    pub wanted: Vec<u32>,
    /// The number of each tetrahedron that was gathered, or 0.
    pub region_numbers: Vec<u32>,
}

impl Mesh {
    /// Creates a mesh of which nothing was gathered.
    pub fn new(tetrahedra: Vec<[u32; 4]>, neighbors: Vec<[u32; 4]>, infinite: u32) -> Self {
        let region_numbers = vec![0; tetrahedra.len()];
        let wanted = vec![0; (infinite as usize).div_ceil(32).max(1)];
        Mesh { tetrahedra, neighbors, infinite, wanted, region_numbers }
    }

    /// Gathers the tetrahedra at `vertices` that were not gathered before, and those around them if it
    /// `is_wide`, numbered from `first` on.
    pub fn gather(&mut self, vertices: &[u32], is_wide: bool, first: u32) -> Gathered {
        self.want(vertices);
        if is_wide {
            self.wanted = gather_widen(self);
        }
        let marks = gather_mark(self);
        let slots = gather_number(self, &marks, first);
        Gathered { is_wide, ..gather_copy(self, slots) }
    }

    fn has_wanted(&self, tet: &[u32; 4]) -> bool {
        tet.iter().any(|&v| v != self.infinite && self.wanted[v as usize / 32] >> (v % 32) & 1 != 0)
    }

    /// Sets the wanted vertices.
    pub fn want(&mut self, vertices: &[u32]) {
        self.wanted.fill(0);
        vertices.iter().for_each(|&v| self.wanted[v as usize / 32] |= 1 << (v % 32));
    }
}

/// Returns the vertices of the tetrahedra that have a wanted vertex, a bit for each. One invocation per
/// slot.
pub fn gather_widen(mesh: &Mesh) -> Vec<u32> {
    let mut wider = vec![0; mesh.wanted.len()];
    let around = mesh.tetrahedra.iter().filter(|tet| mesh.has_wanted(tet));
    for &v in around.flatten().filter(|&&v| v != mesh.infinite) {
        wider[v as usize / 32] |= 1 << (v % 32);
    }
    wider
}

/// Marks the tetrahedra that have a wanted vertex and were not gathered before. One invocation per
/// slot.
pub fn gather_mark(mesh: &Mesh) -> Vec<u32> {
    let slots = mesh.tetrahedra.iter().zip(&mesh.region_numbers);
    slots.map(|(tet, &number)| u32::from(number == 0 && mesh.has_wanted(tet))).collect()
}

/// Numbers the marked tetrahedra from `first` on, in the order of their slots, and lists them. One
/// invocation per slot.
pub fn gather_number(mesh: &mut Mesh, marks: &[u32], first: u32) -> Vec<u32> {
    let slots: Vec<u32> = (0..).zip(marks).filter(|&(_, &mark)| mark != 0).map(|(t, _)| t).collect();
    slots.iter().zip(first..).for_each(|(&t, number)| mesh.region_numbers[t as usize] = number);
    slots
}

/// Copies the listed tetrahedra, with their neighbours by the numbers that these have, or 0. One
/// invocation per tetrahedron.
pub fn gather_copy(mesh: &Mesh, slots: Vec<u32>) -> Gathered {
    let renumbered = |across: u32| 4 * mesh.region_numbers[across as usize / 4] + across % 4;
    Gathered {
        tetrahedra: slots.iter().map(|&t| mesh.tetrahedra[t as usize]).collect(),
        neighbors: slots.iter().map(|&t| mesh.neighbors[t as usize].map(renumbered)).collect(),
        slots,
        is_wide: false,
    }
}

/// Writes what splaying changed back into the mesh. One invocation per entry of the patch.
pub fn patch(mesh: &mut Mesh, patch: &Patch) {
    mesh.tetrahedra.resize(patch.len, [0; 4]);
    mesh.neighbors.resize(patch.len, [0; 4]);
    for (i, &t) in patch.slots.iter().enumerate() {
        mesh.tetrahedra[t as usize] = patch.tetrahedra[i];
        for (k, &across) in patch.neighbors[i].iter().enumerate().filter(|&(_, &across)| across != KEEP) {
            mesh.neighbors[t as usize][k] = across;
        }
    }
}

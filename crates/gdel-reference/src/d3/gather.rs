//! Gathering tetrahedra of the mesh, and writing changed ones back.

use gdel::internals::d3::splay::{Gathered, KEEP, NAMED_SHIFT, Patch};

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
    /// One more than the tetrahedron of each point, a ghost if it has any; infinity comes last.
    pub vertex_simplex: Vec<u32>,
    /// The number of each tetrahedron that was gathered, or 0.
    pub region_numbers: Vec<u32>,
}

impl Mesh {
    /// Creates a mesh of which nothing was gathered.
    pub fn new(tetrahedra: Vec<[u32; 4]>, neighbors: Vec<[u32; 4]>, infinite: u32) -> Self {
        let region_numbers = vec![0; tetrahedra.len()];
        let wanted = vec![0; (infinite as usize).div_ceil(32).max(1)];
        let mut vertex_simplex = vec![0; infinite as usize + 1];
        let (ghosts, finite): (Vec<u32>, _) =
            (0..tetrahedra.len() as u32).partition(|&t| tetrahedra[t as usize].contains(&infinite));
        for t in finite.into_iter().chain(ghosts) {
            tetrahedra[t as usize].iter().for_each(|&v| vertex_simplex[v as usize] = t + 1);
        }
        Mesh { tetrahedra, neighbors, infinite, wanted, vertex_simplex, region_numbers }
    }

    /// Gathers the tetrahedra at `vertices` that were not gathered before, numbered from `first` on.
    pub fn gather(&mut self, vertices: &[u32], first: u32) -> Gathered {
        self.want(vertices);
        let slots = gather_list(self, first);
        gather_copy(self, slots)
    }

    /// Sets the wanted vertices.
    pub fn want(&mut self, vertices: &[u32]) {
        self.wanted.fill(0);
        vertices.iter().for_each(|&v| self.wanted[v as usize / 32] |= 1 << (v % 32));
    }
}

/// Lists the tetrahedra that have a wanted vertex and were not gathered before, and numbers them from
/// `first` on: in the order of their slots, where the kernel has none. One invocation per tetrahedron.
pub fn gather_list(mesh: &mut Mesh, first: u32) -> Vec<u32> {
    let is_wanted = |&v: &u32| v != mesh.infinite && mesh.wanted[v as usize / 32] >> (v % 32) & 1 != 0;
    let slots = (0..).zip(mesh.tetrahedra.iter().zip(&mesh.region_numbers));
    let listed = slots.filter(|(_, (tet, number))| **number == 0 && tet.iter().any(is_wanted));
    let listed: Vec<u32> = listed.map(|(t, _)| t).collect();
    listed.iter().zip(first..).for_each(|(&t, number)| mesh.region_numbers[t as usize] = number);
    listed
}

/// Copies the listed tetrahedra, with their neighbours by the numbers that these have, or 0, and notes
/// for which of its vertices each is the tetrahedron of the vertex. One invocation per tetrahedron.
pub fn gather_copy(mesh: &Mesh, slots: Vec<u32>) -> Gathered {
    let renumbered = |across: u32| 4 * mesh.region_numbers[across as usize / 4] + across % 4;
    let named = |t: u32| -> u32 {
        let vertices = (0..).zip(mesh.tetrahedra[t as usize]);
        vertices.filter(|&(_, v)| mesh.vertex_simplex[v as usize] == t + 1).map(|(k, _)| 1 << k).sum()
    };
    Gathered {
        tetrahedra: slots.iter().map(|&t| mesh.tetrahedra[t as usize]).collect(),
        neighbors: slots.iter().map(|&t| mesh.neighbors[t as usize].map(renumbered)).collect(),
        slots: slots.into_iter().map(|t| t | named(t) << NAMED_SHIFT).collect(),
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

//! The end of Phase 1: the mesh without gaps, and what is left open by rounding.

use crate::{
    d2::gpu::{
        aliases::Aliases,
        layout::{COUNTER_CLOCKWISE, FLAT, UncertainTest},
        outputs::OutputStage,
    },
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Pending,
        layout::Counters,
        phase1::{Buffers, Copied, Copies, Finish},
    },
};

/// The arrays of a [`Mesh2`](crate::d2::Mesh2), in input indices, except that the hull has no
/// order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mesh {
    /// Three vertices per triangle in the order of
    /// [`Settings::winding`](crate::gpu::phase1::Settings::winding), none flat.
    pub triangles: Vec<[u32; 3]>,
    /// Entry *k* is the half-edge that runs against the one from vertex *k* to the next,
    /// 3·(triangle) + (vertex); -1 on the hull.
    pub halfedges: Vec<[u32; 3]>,
    /// The half-edges of the hull, from where to where, in no order.
    pub hull: Vec<[u32; 2]>,
}

/// The Delaunay triangulation of the lattice's points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NearMesh {
    /// The triangles: those of the true points, if all `uncertain` tests have the right answer.
    pub mesh: Mesh,
    /// The signs that the lattice does not prove, because coordinates were rounded; `None` if there are
    /// more of them than the device has room for.
    pub uncertain: Option<Vec<UncertainTest>>,
}

/// The readbacks beside those of the triangles and their half-edges.
pub type Reading = Open<Pending<[u32; 2]>, Pending<UncertainTest>>;

/// What the host reads of any mesh.
pub struct Open<H, U> {
    /// [`Mesh::hull`].
    pub(crate) hull: H,
    /// [`NearMesh::uncertain`].
    pub(crate) uncertain: Option<U>,
    /// The number of points.
    pub(crate) points: usize,
}

impl Reading {
    /// Records the readbacks.
    pub(crate) fn copy(copies: &mut Copies<'_>, b: &Buffers<2>, aliases: &Aliases, counters: &Counters) -> Self {
        let tests = counters.uncertain as usize;
        Open {
            hull: copies.copy(&aliases.hull, counters.hull as usize),
            uncertain: (tests <= b.simplices.len()).then(|| copies.copy(&aliases.uncertain, tests)),
            points: b.points.pairs.len(),
        }
    }

    /// Receives them.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Copied::receive`].
    pub(crate) async fn receive(
        self,
        copied: &mut Copied<'_>,
    ) -> Result<Open<Vec<[u32; 2]>, Vec<UncertainTest>>, Error> {
        let points = self.points;
        let hull = copied.receive(self.hull).await?;
        let uncertain = match self.uncertain {
            Some(tests) => Some(copied.receive(tests).await?),
            None => None,
        };
        let are_points = |vertices: &[u32]| vertices.iter().all(|&v| (v as usize) < points);
        // Infinity is one of the vertices of tests.
        let fits = |test: &UncertainTest| {
            let others = [COUNTER_CLOCKWISE, FLAT];
            test.triangle
                .iter()
                .chain(Some(&test.beyond).filter(|beyond| !others.contains(beyond)))
                .all(|&v| v as usize <= points)
        };
        if !hull.iter().all(|edge: &[u32; 2]| are_points(edge)) || !uncertain.iter().flatten().all(fits) {
            return Err(copied.gpu.wrong("an edge of the hull or an uncertain triangle has a vertex that is none"));
        }
        Ok(Open { hull, uncertain, points })
    }
}

impl Finish<2> for Dimension<2> {
    type Aliases = Aliases;
    type Reading = Reading;
    type Result = NearMesh;
    type Outputs = OutputStage;

    fn outputs(compiler: &Compiler<'_>) -> OutputStage {
        OutputStage::new(compiler)
    }

    fn mesh_len(finite: usize, _counters: &Counters) -> usize {
        finite
    }

    fn copy(copies: &mut Copies<'_>, b: &Buffers<2>, aliases: &Aliases, counters: &Counters) -> Reading {
        Open::copy(copies, b, aliases, counters)
    }

    async fn receive(
        copied: &mut Copied<'_>,
        reading: Reading,
        [triangles, halfedges]: [Vec<[u32; 3]>; 2],
        _finite: usize,
    ) -> Result<NearMesh, Error> {
        let Open { hull, uncertain, .. } = reading.receive(copied).await?;
        let halfedges = bytemuck::cast_vec(halfedges);
        Ok(NearMesh { mesh: Mesh { triangles, halfedges, hull }, uncertain })
    }
}

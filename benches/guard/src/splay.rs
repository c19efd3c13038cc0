//! What star splaying begins with: the Delaunay triangulation of points a little off the true ones,
//! in which some facets are not locally Delaunay, and flat tetrahedra lie on the hull, as Phase 1
//! leaves them.

use gdel::{
    Backend, Triangulator,
    internals::{
        d3::{
            generate::{Distribution3, generate3d},
            splay::{NearDelaunay3, SplayOutcome, Terms, splay},
        },
        input::lattice::Lattice,
        parallel::Threads,
        predicates::filter::{PredicateContext, PredicateContext3},
    },
};

#[allow(dead_code)]
#[path = "../../../tests/splay/flips.rs"]
mod flips;

/// A triangulation that is nearly that of the vertices.
pub struct Spoilt {
    vertices: PredicateContext3<'static>,
    near: NearDelaunay3,
}

impl Spoilt {
    /// Returns the triangulation of `points`, each coordinate of which is off by at most `by`.
    pub fn new(points: Vec<[f64; 3]>, by: f64) -> Self {
        let offsets = generate3d(Distribution3::Uniform, points.len(), 4);
        let displaced =
            points.iter().zip(offsets).map(|(p, q)| std::array::from_fn(|i| p[i] + by * (2.0 * q[i] - 1.0)));
        let displaced: Vec<[f64; 3]> = displaced.collect();
        let mesh = Triangulator::new().backend(Backend::Cpu).delaunay3d(&displaced).expect("finite points");
        let points: &'static [[f64; 3]] = points.leak();
        let vertices = PredicateContext::of_input(points.into(), &Lattice::fit(points.into()));
        let near = flips::near(points.len() as u32, &mesh.tetrahedra);
        let near = flips::found_out(&vertices, &near);
        assert!(near.missing.is_empty() && !near.failed.is_empty());
        Spoilt { vertices, near }
    }

    /// Makes it Delaunay.
    pub fn splay(self) -> SplayOutcome {
        splay(&self.vertices, self.near, Terms::unlimited(Threads::One)).expect("memory")
    }
}

/// Panics if splaying aborted.
pub fn expect_delaunay(outcome: SplayOutcome) {
    match outcome {
        SplayOutcome::Delaunay(_, stats) => println!("{stats:?}"),
        SplayOutcome::Aborted(reason) => panic!("splaying aborted: {reason:?}"),
    }
}

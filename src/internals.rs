//! What tests, measurements, the other crates of the workspace and the WebAssembly bindings use of this crate.
//!
//! Nothing here is part of the public interface: anything may change or go in any version. Each item is named, so
//! that the compiler reports what nobody uses. The modules are those of the crate.

pub use crate::options::{OnProgress, Options, Winding};
pub mod cpu {
    pub use crate::cpu::{
        Incremental, Insert, MeshOf, delaunay, delaunay_in_order, regular, regular_in_order, weights_of_radii,
    };
    pub mod edit {
        pub use crate::cpu::edit::{Again, Edit, Sparse, Used, delaunay_of_used, edit};
    }
}
pub mod constrained {
    pub use crate::constrained::{constrained, tin};
}
pub mod d2 {
    pub use crate::d2::Triangulation2;
    pub mod generate {
        pub use crate::d2::generate::{Distribution2, generate2d};
    }
    #[cfg(feature = "gpu")]
    pub mod gpu {
        pub mod aliases {
            pub use crate::d2::gpu::aliases::Aliases;
        }
        pub mod finish {
            pub use crate::d2::gpu::finish::Mesh;
        }
        pub mod layout {
            pub use crate::d2::gpu::layout::{EdgeFlip, FLIP_22};
        }
        pub mod vertex {
            pub use crate::d2::gpu::vertex::{append_words, position};
        }
    }
    pub mod lawson {
        pub use crate::d2::lawson::{Aborted, LawsonOutcome, NearDelaunay2, lawson};
    }
}
pub mod d3 {
    pub mod generate {
        pub use crate::d3::generate::{Distribution3, generate3d};
    }
    #[cfg(feature = "gpu")]
    pub mod gpu {
        pub mod aliases {
            pub use crate::d3::gpu::aliases::Aliases;
        }
        pub mod buffers {
            pub use crate::d3::gpu::buffers::Gathering;
        }
        pub mod outputs {
            pub use crate::d3::gpu::outputs::{MadeArrays, OutputParams, OutputStage, SlotMesh};
        }
        pub mod vertex {
            pub use crate::d3::gpu::vertex::{append_words, position};
        }
    }
    pub mod mesh {
        pub use crate::d3::mesh::FACETS;
    }
    pub mod splay {
        pub use crate::d3::splay::{
            Aborted, Doubts, Gathered, KEEP, KeptRegion, NAMED_SHIFT, NearDelaunay3, Patch, Region, Splay,
            SplayOutcome, Stop, Terms, splay, splay_again,
        };
    }
    pub mod triangulation {
        pub use crate::d3::triangulation::{FiniteMesh, Triangulation3};
    }
}
pub mod derived {
    pub use crate::derived::{
        AlphaEdges, DisjointSets, SingularEdges, StolenMeasures, SurfaceMesh, VoronoiShapes, crossing_facets, singular,
        sites_by_halves, transport,
    };
}
pub mod dimension {
    pub use crate::dimension::Dimension;
}
pub mod fields {
    pub use crate::fields::{Field, FieldOfStruct, Struct, Value};
}
pub mod geometry {
    pub use crate::geometry::{Euclidean, Geometry, circumsphere};
}
#[cfg(feature = "gpu")]
pub mod gpu {
    pub use crate::gpu::{
        AdapterChoice, Binding, Compiler, Gpu, Kernel, MAX_WORKGROUPS, Parts, Profiler, Readback, Recorder, Storage,
        adapters, workgroups,
    };
    pub use crate::platform::gpu::wait;
    pub mod device_mesh {
        pub use crate::gpu::device_mesh::{DeviceArrays, MeshArrays};
    }
    pub mod dim {
        pub use crate::gpu::dim::{Corners, Dim, Flip, OwnBuffers};
    }
    pub mod engine {
        pub use crate::gpu::engine::{Complete, Destination, GpuEngine, MadeMesh, Outcome};
    }
    pub mod layout {
        pub use crate::gpu::layout::{
            ALL_FREE, Active, BLOCK, CHECK, COUNTER_WORDS, Counters, DONE, DONE_23, EDGE_SHIFT, FACET_SHIFT, FLIP_23,
            FLIP_32, FREE_START, FlipNode, GROWTH_FROM, GROWTH_SHARE, HELD_SHIFT, HISTORY_FULL, KIND_SHIFT, LOGGED,
            PARAM_WORDS, Params, Pick, ROUND_SHIFT, SLOT_SHIFT, SLOTS_FULL, SUSPECT_SHIFT, Status, TWICE_GROWTH,
            Waiting,
        };
    }
    pub mod host {
        pub use crate::gpu::host::{Answer, Carrier, Elsewhere, Fit, Here, Host, Side, State};
        #[cfg(target_arch = "wasm32")]
        pub use crate::platform::AnyHost;
    }
    pub mod phase1 {
        pub use crate::gpu::phase1::{
            Aliases, Begin, Budget, Buffers, Finish, MemorySettings, Phase1, Phase1Output, Phase1Run, Settings, Sizes,
            WayToHost,
        };
    }
    pub mod points {
        pub use crate::gpu::points::{DevicePoints, InputCounts, InputParams, PointStage};
    }
    pub mod primitives {
        pub mod compact {
            pub use crate::gpu::primitives::compact::Compact;
        }
        pub mod scan {
            pub use crate::gpu::primitives::scan::{GROUPS, Scan, ScanParams};
        }
        pub mod sort {
            pub use crate::gpu::primitives::sort::{FEW, Sort, TILE};
        }
    }
    pub mod mutation {
        pub use crate::gpu::mutation::Mutation;
    }
    pub mod self_test {
        pub use crate::gpu::self_test::{KNOWN_ANSWERS, KnownAnswer, fingerprint};
    }
    pub mod shader {
        pub use crate::gpu::shader::{D2, D3, Shader, Shaders, with_int64};
    }
    pub mod start {
        pub use crate::gpu::start::{StartMesh, StartSimplex, first_simplex};
    }
    pub mod update {
        pub use crate::gpu::update::Limits;
    }
}
pub mod input {
    pub mod lattice {
        pub use crate::input::lattice::{Lattice, Width};
    }
    pub mod order {
        pub use crate::input::order::Order;
    }
    pub mod points {
        pub use crate::input::points::Points;
    }
}
pub mod mesh {
    pub use crate::mesh::{MeshInfo, canonical};
}
pub mod parallel {
    pub use crate::parallel::Threads;
}
pub mod predicates {
    pub use crate::predicates::{Sign, collinear, incircle, insphere, orient2d, orient3d};
    pub mod exact {
        pub use crate::predicates::exact::power_sign;
    }
    pub mod filter {
        pub use crate::predicates::filter::{PredicateContext, PredicateContext2, PredicateContext3};
    }
    pub mod integer {
        pub use crate::predicates::integer::{insphere_narrow, insphere_wide, orient3d_narrow, orient3d_wide};
    }
    pub mod symbolic {
        pub use crate::predicates::symbolic::{break_tie, without};
    }
}

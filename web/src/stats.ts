// Generated from src/stats.rs by `WRITE_STATS_TS=1 cargo test --test cpu stats_ts`.

/** Statistics of the run that computed a mesh. */
export interface Stats {
  /** The backend that computed the mesh. */
  backend: 'gpu' | 'cpu';
  /** Why the CPU computed the mesh, if it was not requested explicitly. */
  fallback: string | null;
  /**
   * The phases in the order in which they ran, with the time that each took. Phases of an attempt
   * that failed are not included.
   */
  phases: { name: string; milliseconds: number }[];
  /**
   * Predicate evaluations on the CPU that the floating-point filter left open, by what decided
   * them.
   */
  exact: ExactCounts;
  /** What the GPU did, including an attempt after which the CPU had to take over. */
  gpu: GpuStats | null;
  /** What star splaying did after that; 3D only. */
  splay: SplayStats | null;
  /** What `Triangulator::update`, `insert` or `remove` did, if that made the mesh. */
  update: UpdateStats | null;
  /**
   * How many meshes of the GPU, if it was considered, have failed a check so far, each of which was
   * an error or left to the CPU; earlier processes are included where they have kept that.
   */
  wrongMeshes: number;
}

/**
 * The number of predicate evaluations that each exact stage decided after the floating-point
 * filter.
 */
export interface ExactCounts {
  /** Decided by fixed-width integers on the lattice. */
  integer: number;
  /**
   * Decided by floating-point expansions or big integers, where a point does not fit the lattice.
   */
  expansion: number;
  /** Cospherical or cocircular points: decided by the symbolic perturbation. */
  symbolic: number;
}

/** What Phase 1 did on the GPU. */
export interface GpuStats {
  /** The name of the adapter. */
  adapter: string;
  /** The insertion rounds, then the rounds that only flipped. */
  rounds: Round[];
  /**
   * The number of points that Phase 1 started with, which count as inserted by the first round:
   * those that the CPU triangulated, or the corners of one simplex where that is faster, or the
   * sample has duplicates.
   */
  startPoints: number;
  /** The number of flips of two tetrahedra into three. */
  flips23: number;
  /** The number of flips of three tetrahedra into two. */
  flips32: number;
  /** The number of flips of two triangles into two, in 2D. */
  flips22: number;
  /** The number of flip iterations that had something to do. */
  flipIterations: number;
  /** The number of predicate evaluations that took exact arithmetic. */
  exactTests: number;
  /**
   * The number of facets that were not locally Delaunay and could not be flipped, including those
   * with the vertex at infinity.
   */
  notLocallyDelaunay: number;
  /** The number of vertices of such facets, without the vertex at infinity. */
  failedVertices: number;
  /**
   * The number of points that were merged with another one at the same lattice position:
   * duplicates, and points that were rounded there.
   */
  merged: number;
  /** The number of results that were read back. */
  readbacks: number;
  /** How often the host waited for one of them while the device had nothing else to do. */
  stalls: number;
  /** The number of bytes that were read back. */
  bytesRead: number;
  /** The number of kernels that were run. */
  dispatches: number;
  /**
   * The number of submissions to the queue. One that is split, because the device takes long for
   * it, counts once.
   */
  submits: number;
  /** The largest amount of GPU memory that was held at a time, in bytes. */
  bytes: number;
}

/** A round of Phase 1: insertions, and the flips that follow them. */
export interface Round {
  /** The number of points that were inserted. */
  inserted: number;
  /**
   * The number of tetrahedra, or triangles in 2D, whose facets were still to be checked at the end.
   */
  active: number;
  /** The number of flips. */
  flips: number;
  /** The number of flip iterations that had something to do. */
  iterations: number;
  /**
   * The time by the host's clock: an equal share of that of the rounds which were submitted
   * together.
   */
  milliseconds: number;
}

/** What star splaying did. */
export interface SplayStats {
  /** The number of flat tetrahedra on the hull that were peeled off. */
  peeled: number;
  /** The number of failed vertices. */
  failed: number;
  /**
   * The number of stars that were made convex: those of failed vertices, and some that had flat or
   * inverted tetrahedra.
   */
  built: number;
  /** The number of stars that were taken from the triangulation unchanged. */
  pulled: number;
  /** The number of Flip-Flop's flips. */
  flips: number;
  /** The number of tetrahedra that were removed from the triangulation. */
  removed: number;
  /** The number of tetrahedra that were added to it. */
  added: number;
  /** The number of missing points that were inserted. */
  inserted: number;
  /** The number of predicate evaluations. */
  signs: number;
  /** The number of rounds of insertions. */
  rounds: number;
  /** The number of times that stars were gathered from the device. */
  gathers: number;
  /** The number of tetrahedra that were gathered. */
  gathered: number;
}

/** What an update, an insertion or a removal did to make a mesh from the one before. */
export interface UpdateStats {
  /**
   * The number of tetrahedra, or triangles in 2D, that were flat or inverted at the new points.
   * Like the next three, it is counted by updates of meshes on a device.
   */
  inverted: number;
  /** The number of facets, or edges in 2D, that were not locally Delaunay there. */
  notLocallyDelaunay: number;
  /** The number of flips. */
  flips: number;
  /** The number of stars that were made convex; 3D only. */
  stars: number;
  /** The number of vertices that were removed because their points were. */
  removed: number;
  /** The number of points that were inserted: new ones, and former duplicates. */
  inserted: number;
  /** Whether a mesh on the device was read, changed on the host, and uploaded. */
  onHost: boolean;
  /**
   * Why the points were triangulated from scratch, if they were. On a device, after two such
   * updates in a row, only every fourth looks at the mesh; the others have the reason of the one
   * before.
   */
  restarted: string | null;
}

//! One of the tiles that points are split into.

use super::{
    border::{Border, Vertices},
    dim::Tiled,
    message::{Content, Known, Message},
    part::{self, Part},
    piece::Piece,
    plan::Plan,
};
use crate::{
    backend::Backend,
    cpu::{Incremental, MeshOf, insert_points},
    dimension::Dimension,
    error::Error,
    geometry::{Euclidean, Geometry},
    index::NONE,
    input::{
        lattice::Lattice,
        order::{Distinct, Order, insertion_order},
        points::Points,
    },
    mesh::MeshInfo,
    options::Options,
    parallel::{self, Threads},
    predicates::filter::PredicateContext,
    stats::{Phase, Stats},
    triangulator::Triangulator,
};
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;

/// One of the tiles that points are split into, which triangulates its own points and those of others that it gets to
/// know.
///
/// Tiles take [steps](Tile::step) together: what each sends in one step, the others receive in the next one. When none
/// has sent anything, all simplices at a tile's own points are those of the whole triangulation.
///
/// # Examples
///
/// ```
/// use gdel::tiles::{Plan, Survey, Tile, join};
///
/// let points: Vec<[f64; 2]> = (0..100u32).map(|i| [f64::from(i * i % 101), f64::from(i)]).collect();
/// let plan = Plan::new(Survey::<2>::new(&points, 0, 10)?, 3);
/// let mut tiles = Vec::new();
/// for (number, (own, indices)) in (0..).zip(plan.split(&points, 0)) {
///     tiles.push(Tile::<2, 3>::new(plan.clone(), number, own, indices)?);
/// }
/// let mut received = vec![Vec::new(); 3];
/// loop {
///     let mut sent = vec![Vec::new(); 3];
///     for (from, tile) in tiles.iter_mut().enumerate() {
///         for (to, message) in tile.step(std::mem::take(&mut received[from]))? {
///             sent[to as usize].push((from as u32, message));
///         }
///     }
///     if sent.iter().all(Vec::is_empty) {
///         break;
///     }
///     received = sent;
/// }
/// let parts = tiles.into_iter().map(Tile::finish).collect::<Result<_, _>>()?;
/// let mesh = join::<2, 3>(parts, points.len())?;
/// assert!(gdel::verify2d(&points, &mesh)?.passed());
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct Tile<const D: usize, const N: usize>
where
    Dimension<D>: Tiled<D, N>,
{
    pub(super) plan: Arc<Plan<D>>,
    pub(super) number: u32,
    pub(super) options: Options,
    /// The steps so far.
    pub(super) steps: u32,
    pub(super) cloud: Cloud<D>,
    /// For each of its own points the one that it duplicates, or [`NONE`].
    pub(super) duplicate_of: Vec<u32>,
    pub(super) triangulation: Option<Triangulation<D>>,
    /// Whether the tile knows only the points of its shell.
    pub(super) is_shell: bool,
    /// How the tile was computed.
    pub(super) stats: Stats,
    /// For each tile, the box of its own points.
    pub(super) bounds: Vec<Option<[[f64; D]; 2]>>,
    /// For each tile, the vertices that it knows, without common ones of other tiles.
    pub(super) sent: Vec<FxHashSet<u32>>,
}

pub(super) type Triangulation<const D: usize> = <Dimension<D> as Incremental<D>>::Triangulation;

/// The points that a tile knows, which are its vertices.
#[derive(Debug, Default)]
pub(super) struct Cloud<const D: usize> {
    /// First the tile's own points, in the order of their indices, then the
    /// common ones of other tiles, then others.
    pub(super) points: Vec<[f64; D]>,
    /// The index of each in the whole input.
    pub(super) indices: Vec<u32>,
    /// The number of the tile's own points.
    pub(super) own: u32,
    /// The number of common points of other tiles.
    pub(super) common: u32,
    /// The tile that each point of other tiles belongs to.
    pub(super) owners: Vec<u32>,
    /// The indices of the points of other tiles.
    pub(super) known: FxHashSet<u32>,
}

impl<const D: usize> Cloud<D> {
    /// Adds a point of another tile.
    pub(super) fn learn(&mut self, index: u32, owner: u32, at: [f64; D]) {
        if self.known.insert(index) {
            self.points.push(at);
            self.indices.push(index);
            self.owners.push(owner);
        }
    }
}

impl<const D: usize, const N: usize> Tile<D, N>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    /// Creates the tile with this number of a plan, from its own points and their indices in the whole input, which
    /// have to ascend.
    ///
    /// # Errors
    ///
    /// Returns [`Error::ValueCount`] unless there is one index per point, [`Error::BadTile`] if the plan has no such
    /// tile, or a point that belongs to another one, or if the indices do not ascend, and [`Error::NotFinite`].
    pub fn new(
        plan: impl Into<Arc<Plan<D>>>,
        number: u32,
        points: Vec<[f64; D]>,
        indices: Vec<u32>,
    ) -> Result<Self, Error> {
        Self::with_options(plan.into(), number, points, indices, Options::default())
    }

    /// Creates a tile with options.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Tile::new`].
    #[doc(hidden)]
    pub fn with_options(
        plan: Arc<Plan<D>>,
        number: u32,
        points: Vec<[f64; D]>,
        indices: Vec<u32>,
        options: Options,
    ) -> Result<Self, Error> {
        let bad = |reason| Err(Error::BadTile { tile: number, reason });
        if points.len() != indices.len() {
            return Err(Error::ValueCount { values: indices.len(), points: points.len() });
        }
        Points::F64(&points).finite_bounds(Threads::One)?;
        if number >= plan.tiles() {
            return bad("there is none with this number");
        }
        if !indices.is_sorted_by(|a, b| a < b) {
            return bad("the indices of its points do not ascend");
        }
        if points.iter().any(|&p| plan.tile_of(p) != number) {
            return bad("one of its points belongs to another one");
        }
        Ok(Tile {
            sent: vec![FxHashSet::default(); plan.tiles() as usize],
            bounds: vec![None; plan.tiles() as usize],
            plan,
            number,
            options,
            steps: 0,
            cloud: Cloud {
                own: points.len() as u32,
                common: 0,
                points,
                indices,
                owners: Vec::new(),
                known: FxHashSet::default(),
            },
            duplicate_of: Vec::new(),
            triangulation: None,
            is_shell: false,
            stats: Stats::new(Backend::Cpu),
        })
    }

    /// Takes a step: looks at what other tiles have sent in the last one, each message with the number of its sender.
    /// Returns messages, each with the number of the tile that it is for.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BadMessage`] if a message is not one that another tile has sent in the last step,
    /// [`Error::Cancelled`], [`Error::TooManyPoints`], [`Error::TooManySimplices`] and [`Error::OutOfMemory`]. After
    /// an error the tile cannot go on.
    pub fn step(&mut self, received: Vec<(u32, Message<D>)>) -> Result<Vec<(u32, Message<D>)>, Error> {
        self.take_step(None, received)
    }

    /// Takes a step as [`step`](Self::step) does, in which `triangulator` makes the mesh of the points that the tile
    /// knows, which is most of the second step: for example on a GPU of its own. The tile is the same in the end.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Triangulator, tiles::{Plan, Survey, Tile}};
    ///
    /// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0f64]];
    /// let plan = Plan::new(Survey::<2>::new(&points, 0, 1)?, 1);
    /// let mut tile = Tile::<2, 3>::new(plan, 0, points.to_vec(), vec![0, 1, 2, 3])?;
    /// let triangulator = Triangulator::new();
    /// tile.step_on(&triangulator, Vec::new())?;
    /// tile.step_on(&triangulator, Vec::new())?;
    /// assert_eq!(tile.finish()?.simplices.len(), 2);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`step`](Self::step) and those of [`Triangulator::delaunay3d`]. Blocks the thread.
    pub fn step_on(
        &mut self,
        triangulator: &Triangulator,
        received: Vec<(u32, Message<D>)>,
    ) -> Result<Vec<(u32, Message<D>)>, Error> {
        self.take_step(Some(triangulator), received)
    }

    /// Takes a step. A triangulator makes the mesh of the second one if there is one.
    fn take_step(
        &mut self,
        on: Option<&Triangulator>,
        received: Vec<(u32, Message<D>)>,
    ) -> Result<Vec<(u32, Message<D>)>, Error> {
        if received.iter().any(|&(from, _)| from >= self.plan.tiles() || from == self.number) {
            return Err(Error::BadMessage { reason: "its sender is not another tile" });
        }
        let threads = self.options.threads;
        self.steps += 1;
        match self.steps {
            1 if received.is_empty() => Ok(self.hello()),
            1 => Err(UNEXPECTED),
            2 => {
                self.begin(received)?;
                let made = match on {
                    Some(triangulator) if self.has_simplices() => Some(self.triangulate_on(triangulator)?),
                    _ => None,
                };
                parallel::with_threads(threads, |threads| {
                    match made {
                        Some(made) => self.take_mesh(threads, made)?,
                        None => self.awake(threads)?,
                    }
                    Ok(self.outgoing(threads, 0, true))
                })
            }
            _ => parallel::with_threads(threads, |threads| {
                let first = self.cloud.points.len();
                self.add(threads, received)?;
                let is_quiet = first == self.cloud.points.len();
                Ok(if is_quiet { Vec::new() } else { self.outgoing(threads, first as u32, false) })
            }),
        }
    }

    /// Returns the simplices of the whole triangulation of which the vertex with the lowest index is one of the tile's
    /// own.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`step`](Self::step) if the tile was [suspended](Self::suspend), and [`Error::BadTile`] if its
    /// [core](Self::take_core) was taken.
    pub fn finish(mut self) -> Result<Part<N>, Error> {
        self.check_whole()?;
        let (mut part, triangulation) = self.end()?;
        if let Some(triangulation) = triangulation {
            let indices = &self.cloud.indices;
            let name = |v: u32| indices[v as usize];
            part::fill::<D, N>(&mut part, triangulation, indices, name, (self.vertices(), None), self.options.winding);
        }
        Ok(part)
    }

    /// Returns the same simplices as [`finish`](Self::finish), with the points that they need.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`finish`](Self::finish).
    pub fn into_piece(mut self) -> Result<Piece<D, N>, Error> {
        self.take_core()?.complete(self)
    }

    /// Ends the steps: returns the part without simplices, and the triangulation if there is one.
    pub(super) fn end(&mut self) -> Result<(Part<N>, Option<Triangulation<D>>), Error> {
        let threads = self.options.threads;
        parallel::with_threads(threads, |threads| self.awake(threads))?;
        let duplicates = self.cloud.indices.iter().copied().zip(self.duplicate_of.iter().copied());
        let duplicates = duplicates.filter(|&(_, first)| first != NONE).map(Into::into).collect();
        Ok((Part { duplicates, ..Part::new(self.plan.dimension()) }, self.triangulation.take()))
    }

    /// Frees the triangulation, which takes ten times the memory of the points. The next step in which points arrive,
    /// or the end, makes it again: of few points if the [core](Self::take_core) was taken.
    pub fn suspend(&mut self) {
        self.triangulation = None;
    }

    /// Triangulates all points that the tile knows if it has begun and has no triangulation.
    fn awake(&mut self, threads: Threads) -> Result<(), Error> {
        let is_begun = self.steps > 1 && self.cloud.own > 0;
        if is_begun && self.triangulation.is_none() { self.triangulate(threads) } else { Ok(()) }
    }

    /// Returns whether the tile has points, of an input that spans the space.
    fn has_simplices(&self) -> bool {
        self.cloud.own > 0 && usize::from(self.plan.dimension()) == D
    }

    /// Returns how the tile was computed so far.
    pub fn stats(&self) -> &Stats {
        &self.stats
    }

    /// Returns whose the vertices are.
    pub(super) fn vertices(&self) -> Vertices<'_> {
        Vertices { number: self.number, own: self.cloud.own, common: self.cloud.common, owners: &self.cloud.owners }
    }

    /// Tells the other tiles where the tile's own points are, and which of the common points duplicate others of them.
    fn hello(&mut self) -> Vec<(u32, Message<D>)> {
        let key = |p: &[f64; D]| p.map(|x| (x + 0.0).to_bits());
        let own = self.plan.common.iter().filter(|p| self.plan.tile_of(p.at) == self.number);
        let mut first_at: FxHashMap<[u64; D], u32> = own.clone().map(|p| (key(&p.at), p.index)).collect();
        for (p, &index) in self.cloud.points.iter().zip(&self.cloud.indices) {
            if let Some(first) = first_at.get_mut(&key(p)) {
                *first = index.min(*first);
            }
        }
        let first_of = own.map(|p| [p.index, first_at[&key(&p.at)]]);
        let duplicates = first_of.filter(|[index, first]| first < index).collect();
        let bounds = Points::F64(&self.cloud.points).bounds();
        self.bounds[self.number as usize] = bounds;
        let others = (0..self.plan.tiles()).filter(|&to| to != self.number);
        let hello = Message(Content::Hello { bounds, duplicates });
        others.map(|to| (to, hello.clone())).collect()
    }

    /// Learns where other tiles have points, and the common points of these.
    fn begin(&mut self, received: Vec<(u32, Message<D>)>) -> Result<(), Error> {
        let mut first_of = FxHashMap::default();
        let mut heard = FxHashSet::default();
        for (from, message) in received {
            let Content::Hello { bounds, duplicates } = message.0 else { return Err(UNEXPECTED) };
            self.bounds[from as usize] = bounds;
            heard.insert(from);
            first_of.extend(duplicates.into_iter().map(|[i, first]| (i, first)));
        }
        if heard.len() + 1 != self.plan.tiles() as usize {
            return Err(Error::BadMessage { reason: "not all tiles have sent one" });
        }
        if self.cloud.own == 0 {
            return Ok(());
        }
        let plan = Arc::clone(&self.plan);
        for p in &plan.common {
            let owner = plan.tile_of(p.at);
            let index = first_of.get(&p.index).copied().unwrap_or(p.index);
            if owner != self.number {
                self.cloud.learn(index, owner, p.at);
            } else if let Ok(v) = self.cloud.indices[..self.cloud.own as usize].binary_search(&index) {
                self.sent.iter_mut().for_each(|sent| _ = sent.insert(v as u32));
            }
        }
        self.cloud.common = self.cloud.owners.len() as u32;
        Ok(())
    }

    /// Triangulates all points that the tile knows.
    fn triangulate(&mut self, threads: Threads) -> Result<(), Error> {
        self.check_count()?;
        let points = Points::F64(&self.cloud.points);
        let lattice = Lattice::fit_by(threads, points)?;
        let Distinct { mut order, rounds, duplicate_of } =
            insertion_order(threads, points, &lattice, Dimension::<D>::CURVE, Order::Brio);
        let index = |i: u32| if i == NONE { NONE } else { self.cloud.indices[i as usize] };
        let (own, foreign) = duplicate_of.split_at(self.cloud.own as usize);
        if foreign.iter().any(|&i| i != NONE) {
            return Err(EQUAL);
        }
        self.duplicate_of = own.iter().map(|&i| index(i)).collect();
        if usize::from(self.plan.dimension()) < D {
            return Ok(());
        }
        Dimension::<D>::spanning_first(points, &mut order);
        let context = PredicateContext::new_by(threads, points, &lattice, order).ranked(&self.cloud.indices);
        let mut triangulation = Dimension::<D>::triangulate(threads, &context, &rounds, &self.options)?;
        self.stats.exact = context.exact_counts();
        Dimension::<D>::rename(threads, &mut triangulation, &context.into_input_indices(), points.len() as u32);
        self.triangulation = Some(triangulation);
        Ok(())
    }

    /// Triangulates all points that the tile knows by a triangulator. It breaks ties by the order of points, so they are in
    /// that of their indices, which is returned with the mesh.
    fn triangulate_on(&self, triangulator: &Triangulator) -> Result<(Vec<u32>, MeshOf<D>), Error> {
        self.check_count()?;
        let Cloud { points, indices, .. } = &self.cloud;
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        // Most ascend already, which this sort is fast for.
        order.sort_by_key(|&v| indices[v as usize]);
        let sorted: Vec<[f64; D]> = order.iter().map(|&v| points[v as usize]).collect();
        let mesh = Dimension::<D>::delaunay(triangulator, &sorted)?;
        Ok((order, mesh))
    }

    /// Takes the mesh of all points that the tile knows, of which vertex *v* is point `order[v]`.
    fn take_mesh(&mut self, threads: Threads, (order, mesh): (Vec<u32>, MeshOf<D>)) -> Result<(), Error> {
        let Cloud { points, indices, own, .. } = &self.cloud;
        self.duplicate_of = vec![NONE; *own as usize];
        for (&v, &first) in order.iter().zip(mesh.duplicate_of()).filter(|&(_, &first)| first != NONE) {
            let duplicate_of = self.duplicate_of.get_mut(v as usize).ok_or(EQUAL)?;
            *duplicate_of = indices[order[first as usize] as usize];
        }
        self.stats = mesh.stats().clone();
        let infinite = points.len() as u32;
        let mut triangulation = Dimension::<D>::of_mesh(threads, mesh, infinite);
        Dimension::<D>::rename(threads, &mut triangulation, &order, infinite);
        self.triangulation = Some(triangulation);
        Ok(())
    }

    /// Checks that one triangulation can have all points that the tile knows.
    fn check_count(&self) -> Result<(), Error> {
        let (points, limit) = (self.cloud.points.len(), <Dimension<D> as Incremental<D>>::MAX_POINTS);
        if points > limit { Err(Error::TooManyPoints { points, limit }) } else { Ok(()) }
    }

    /// Inserts what other tiles have sent.
    fn add(&mut self, threads: Threads, received: Vec<(u32, Message<D>)>) -> Result<(), Error> {
        let before = self.cloud.points.len();
        let mut received_from = Vec::new();
        for (from, message) in received {
            let Content::Points(points) = message.0 else { return Err(UNEXPECTED) };
            for p in points {
                if p.owner == self.number || p.owner != self.plan.tile_of(p.at) {
                    return Err(Error::BadMessage { reason: "it has a point of another tile than it says" });
                }
                received_from.push((from, p.index));
                self.cloud.learn(p.index, p.owner, p.at);
            }
        }
        if self.cloud.points.len() == before {
            return Ok(());
        }
        // Who has sent a point knows it.
        let names = (before as u32..).zip(&self.cloud.indices[before..]);
        let vertex_of: FxHashMap<u32, u32> = names.map(|(v, &index)| (index, v)).collect();
        for (from, index) in received_from {
            if let Some(&v) = vertex_of.get(&index) {
                self.sent[from as usize].insert(v);
            }
        }
        self.check_count()?;
        let Some(triangulation) = &mut self.triangulation else { return self.awake(threads) };
        let points = Points::F64(&self.cloud.points);
        let lattice = Lattice::fit_by(threads, points)?;
        let new = points.range(before..points.len());
        let Distinct { mut order, .. } = insertion_order(threads, new, &lattice, Dimension::<D>::CURVE, Order::Brio);
        if order.len() < new.len() {
            return Err(EQUAL);
        }
        order.iter_mut().for_each(|i| *i += before as u32);
        Dimension::<D>::move_infinite(triangulation, points.len() as u32);
        let context = if new.len() > points.len() / FEW {
            PredicateContext::new_by(threads, points, &lattice, (0..points.len() as u32).collect())
        } else {
            PredicateContext::of_input(points, &lattice)
        };
        let context = context.ranked(&self.cloud.indices);
        let is_used = |&t: &u32| Dimension::<D>::simplex(triangulation, t).is_some();
        let start = (0..Dimension::<D>::slots(triangulation)).find(is_used).unwrap_or(0);
        let options = &self.options;
        insert_points(triangulation, &context, order, start, |_| options.report(Phase::Insert, 1.0))?;
        self.stats.exact = self.stats.exact + context.exact_counts();
        Ok(())
    }

    /// Returns what other tiles have to know of the simplices that have a vertex from `first` on; at the beginning also
    /// what they will probably need.
    fn outgoing(&mut self, threads: Threads, first: u32, is_beginning: bool) -> Vec<(u32, Message<D>)> {
        let Some(triangulation) = &self.triangulation else { return Vec::new() };
        let mut sent = std::mem::take(&mut self.sent);
        let border = Border::new(threads, triangulation, self.vertices(), first);
        let mut outgoing = vec![Vec::new(); sent.len()];
        // The tile that each vertex was last sent to: most simplices around a vertex have the same neighbours.
        let mut last = vec![NONE; self.cloud.points.len()];
        let mut send = |to: u32, v: u32| {
            if std::mem::replace(&mut last[v as usize], to) != to && sent[to as usize].insert(v) {
                let i = v as usize;
                let owner = i.checked_sub(self.cloud.own as usize).map_or(self.number, |i| self.cloud.owners[i]);
                outgoing[to as usize].push(Known { index: self.cloud.indices[i], owner, at: self.cloud.points[i] });
            }
        };
        if is_beginning {
            border.push(|v| self.cloud.points[v as usize], &self.bounds, &mut send);
        }
        border.exchange(&mut send);
        self.sent = sent;
        let messages = (0..).zip(outgoing).filter(|(_, points)| !points.is_empty());
        messages.map(|(to, points)| (to, Message(Content::Points(points)))).collect()
    }
}

/// The coordinates of all vertices are prepared only where at least one of so many is inserted.
const FEW: usize = 100;

const EQUAL: Error = Error::BadMessage { reason: "points with different indices are equal" };
const UNEXPECTED: Error = Error::BadMessage { reason: "it is of another step" };

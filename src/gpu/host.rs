//! The seam between the engine, which drives a device, and the host, which has the coordinates.
//!
//! The engine sees counters, vertices and stars. Whatever needs coordinates is a [`Request`], which is plain
//! data, and so is its answer. [`Here`] answers in the same process, without copies. [`Elsewhere`] has
//! another thread answer, as a page does that has the device while a worker has the points: only lists of
//! words go there and come back ([`Message`]).

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Storage,
        dim::{Corners, Dim},
        message::{Message, Packer, Unpacker, message},
        points::{InputParams, bits_of},
        progress,
        start::{StartMesh, StartSimplex, first_simplex},
    },
    index::NONE,
    input::{lattice::Lattice, order::missing_points, points::Points},
    options::Options,
    parallel::{self, Threads},
    predicates::filter::PredicateContext,
    stats::Phase,
};
use std::fmt::Debug;

/// What the host remembers of a run that is being completed, and the memory that it keeps between runs.
pub trait Work<const D: usize>: Dim<D> {
    /// The state.
    type Work: Debug + Default + Send;

    /// Does what takes memory for each of so many points, while the device is at work.
    fn prepare(work: &mut Self::Work, points: usize);
}

/// Whoever has the coordinates of a run.
#[expect(async_fn_in_trait, reason = "only this crate is generic over hosts, and checks threads where it is not")]
pub trait Host<const D: usize>
where
    Dimension<D>: Work<D>,
{
    /// Returns the number of points.
    fn point_count(&self) -> usize;

    /// Writes the bits of the coordinates to the device.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Cancelled`].
    async fn upload(&mut self, gpu: &Gpu, to: &Storage<u32>) -> Result<(), Error>;

    /// Returns the state, if it is in this process.
    fn work(&mut self) -> Option<&mut <Dimension<D> as Work<D>>::Work>;

    /// Has a request answered, and does something `meanwhile`.
    ///
    /// # Errors
    ///
    /// Those of [`Request::answer`].
    async fn ask_while<R: Request<D>>(&mut self, request: R, meanwhile: impl FnOnce()) -> Result<R::Answer, Error>;

    /// Has a request answered.
    ///
    /// # Errors
    ///
    /// Those of [`Request::answer`].
    async fn ask<R: Request<D>>(&mut self, request: R) -> Result<R::Answer, Error> {
        self.ask_while(request, || ()).await
    }
}

/// Receives the share of the work that is done from time to time; an error from it ends the work.
pub type Report<'a> = &'a dyn Fn(f64) -> Result<(), Error>;

/// Something that needs coordinates.
pub trait Request<const D: usize>: Message + Send
where
    Dimension<D>: Work<D>,
{
    /// The answer.
    type Answer: Message + Send;

    /// The number of this kind of request in messages.
    const KIND: u32;

    /// The phase in which it is answered.
    const PHASE: Phase = Phase::Lattice;

    /// Answers.
    ///
    /// # Errors
    ///
    /// What `report` returns, [`Error::NotFinite`], [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
    fn answer(self, side: &mut Side<'_, D>, report: Report<'_>) -> Result<Self::Answer, Error>;
}

/// What answers need.
#[derive(Debug)]
pub struct Side<'a, const D: usize>
where
    Dimension<D>: Work<D>,
{
    points: Points<'a, D>,
    options: &'a Options,
    state: State<D>,
}

/// What the host knows of a run.
#[derive(Debug)]
pub struct State<const D: usize>
where
    Dimension<D>: Work<D>,
{
    /// The lattice, once it is fitted.
    lattice: Option<Lattice<D>>,
    /// The first simplex.
    start: Option<StartSimplex<D>>,
    work: <Dimension<D> as Work<D>>::Work,
}

impl<const D: usize> Default for State<D>
where
    Dimension<D>: Work<D>,
{
    fn default() -> Self {
        State { lattice: None, start: None, work: Default::default() }
    }
}

impl<'a, const D: usize> Side<'a, D>
where
    Dimension<D>: Work<D>,
{
    /// Goes on with a run in this state.
    pub fn new(points: Points<'a, D>, options: &'a Options, state: State<D>) -> Self {
        Side { points, options, state }
    }

    /// Returns the state of the run.
    pub fn into_state(self) -> State<D> {
        self.state
    }

    /// Writes the bits of the coordinates to the device.
    pub fn upload(&self, gpu: &Gpu, to: &Storage<u32>) {
        to.write(gpu, 0, bits_of(self.points).0);
    }

    /// Returns the points, the options, the lattice and the state.
    pub(crate) fn parts(&mut self) -> (Points<'a, D>, &'a Options, &Lattice<D>, &mut <Dimension<D> as Work<D>>::Work) {
        let Side { points, options, state: State { lattice, work, .. } } = self;
        (*points, options, lattice.get_or_insert_with(|| Lattice::fit(*points)), work)
    }

    /// Answers a request, and reports to the caller how far the completion has come.
    fn answer<R: Request<D>>(&mut self, request: R) -> Result<R::Answer, Error> {
        let options = self.options;
        request.answer(self, &|share| options.report(R::PHASE, progress::of_completion(share)))
    }
}

/// A host in the same process.
#[derive(Debug)]
pub struct Here<'a, const D: usize>(Side<'a, D>)
where
    Dimension<D>: Work<D>;

impl<'a, const D: usize> Here<'a, D>
where
    Dimension<D>: Work<D>,
{
    /// Creates a host of these points, with what is left of the run before.
    pub fn new(points: Points<'a, D>, options: &'a Options, work: <Dimension<D> as Work<D>>::Work) -> Self {
        Here(Side { points, options, state: State { work, ..State::default() } })
    }

    /// Returns what the next run gets.
    pub(crate) fn into_work(self) -> <Dimension<D> as Work<D>>::Work {
        self.0.state.work
    }
}

impl<const D: usize> Host<D> for Here<'_, D>
where
    Dimension<D>: Work<D>,
{
    fn point_count(&self) -> usize {
        self.0.points.len()
    }

    async fn upload(&mut self, gpu: &Gpu, to: &Storage<u32>) -> Result<(), Error> {
        self.0.upload(gpu, to);
        Ok(())
    }

    fn work(&mut self) -> Option<&mut <Dimension<D> as Work<D>>::Work> {
        Some(&mut self.0.state.work)
    }

    async fn ask_while<R: Request<D>>(&mut self, request: R, meanwhile: impl FnOnce()) -> Result<R::Answer, Error> {
        let side = &mut self.0;
        let ((), mut answers) = parallel::beside(meanwhile, vec![move || request.answer(side, &|_| Ok(()))]);
        answers.swap_remove(0)
    }

    async fn ask<R: Request<D>>(&mut self, request: R) -> Result<R::Answer, Error> {
        self.0.answer(request)
    }
}

/// Carries requests to another thread, and the points to the device.
#[expect(async_fn_in_trait, reason = "as for Host")]
pub trait Carrier {
    /// Returns the number of points.
    fn point_count(&self) -> usize;

    /// Does what [`Host::upload`] does.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Cancelled`].
    async fn upload(&mut self, gpu: &Gpu, to: &Storage<u32>) -> Result<(), Error>;

    /// Sends a request, does something `meanwhile`, and returns what [`Side`] answers there.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Cancelled`] if there is no answer.
    async fn carry(
        &mut self,
        kind: u32,
        request: Vec<Vec<u32>>,
        meanwhile: impl FnOnce(),
    ) -> Result<Vec<Vec<u32>>, Error>;
}

/// A host in another thread.
#[derive(Debug)]
pub struct Elsewhere<C>(pub C);

impl<C: Carrier, const D: usize> Host<D> for Elsewhere<C>
where
    Dimension<D>: Work<D>,
{
    fn point_count(&self) -> usize {
        self.0.point_count()
    }

    async fn upload(&mut self, gpu: &Gpu, to: &Storage<u32>) -> Result<(), Error> {
        self.0.upload(gpu, to).await
    }

    fn work(&mut self) -> Option<&mut <Dimension<D> as Work<D>>::Work> {
        None
    }

    async fn ask_while<R: Request<D>>(&mut self, request: R, meanwhile: impl FnOnce()) -> Result<R::Answer, Error> {
        let answer = self.0.carry(R::KIND, Packer::pack(request), meanwhile).await?;
        Unpacker::unpack::<Result<R::Answer, Error>>(answer).ok_or(Error::Cancelled)?
    }
}

/// Returns the words of the answer to a request of type `R` in these words; `None` if they are no such
/// request.
pub(crate) fn answer_words<R: Request<D>, const D: usize>(
    side: &mut Side<'_, D>,
    request: Vec<Vec<u32>>,
) -> Option<Vec<Vec<u32>>>
where
    Dimension<D>: Work<D>,
{
    Some(Packer::pack(side.answer(Unpacker::unpack::<R>(request)?)))
}

/// Answers requests of every kind that there is in `D` dimensions.
pub trait Answer<const D: usize>: Work<D>
where
    Dimension<D>: Work<D>,
{
    /// Returns the words of the answer to the request in these words, of this kind; `None` if they are
    /// none.
    fn answer(side: &mut Side<'_, D>, kind: u32, request: Vec<Vec<u32>>) -> Option<Vec<Vec<u32>>>;

    /// Returns whether a simplex is positively oriented, and the vertices beyond its facets, where there are any, are
    /// outside its circumsphere.
    fn is_delaunay(vertices: &PredicateContext<'_, D>, corners: &[u32], apexes: &[u32]) -> bool;
}

/// Asks where the points are on the lattice.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Fit {
    /// The vertices of what was the first simplex, and may still be; or none.
    pub first: Vec<u32>,
    /// Whether the lattice is to be wide although the points fit a narrow one.
    pub wide: bool,
}
message!(Fit { first, wide });

/// Where the points are on the lattice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fitted<const D: usize>
where
    Dimension<D>: Dim<D>,
{
    /// What the device has to know of the points, without the size of its own table.
    pub params: InputParams,
    /// The first simplex, unless the points lie in a line (2D) or plane (3D), or nearly so.
    pub start: Option<StartSimplex<D>>,
}

impl<const D: usize> Request<D> for Fit
where
    Dimension<D>: Work<D>,
{
    type Answer = Fitted<D>;

    const KIND: u32 = 0;

    fn answer(self, side: &mut Side<'_, D>, _report: Report<'_>) -> Result<Fitted<D>, Error> {
        let points = side.points;
        let lattice = match side.state.lattice.take() {
            Some(lattice) => lattice,
            None => Lattice::fit_by(Threads::All, points)?,
        };
        let lattice = if self.wide { lattice.widened() } else { lattice };
        let position = |i: usize| lattice.coordinates(points.get(i)).map(|c| c.value);
        let start = Some(&self.first[..])
            .filter(|first| !first.is_empty())
            .and_then(|first| StartSimplex::of(lattice.width(), first, &position))
            .or_else(|| first_simplex(lattice.width(), points.len(), position));
        let params = InputParams::new(points, &lattice);
        (side.state.lattice, side.state.start) = (Some(lattice), start);
        Ok(Fitted { params, start })
    }
}

/// Asks for the triangulation of some of the points, about as many as this.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MakeStart {
    /// The number of points.
    pub wanted: usize,
}
message!(MakeStart { wanted });

impl<const D: usize> Request<D> for MakeStart
where
    Dimension<D>: Work<D>,
{
    type Answer = StartMesh;

    const KIND: u32 = 1;

    fn answer(self, side: &mut Side<'_, D>, _report: Report<'_>) -> Result<StartMesh, Error> {
        let start = side.state.start;
        let (points, _, lattice, _) = side.parts();
        Ok(start.map(|start| StartMesh::new(points, lattice, &start, self.wanted)).unwrap_or_default())
    }
}

/// The points that share their place on the lattice with others.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Merged {
    /// Points that are vertices of no simplex, each with the vertex at the same place of the lattice.
    pub merged: Vec<[u32; 2]>,
    /// The duplicates of a mesh whose points have moved, each with the vertex that stood for it.
    pub duplicates: Option<Vec<[u32; 2]>>,
}
message!(Merged { merged, duplicates });

impl Merged {
    /// Returns the points that are no duplicates, each with the vertex at the same place of the lattice,
    /// and the field `duplicate_of` of the mesh. `prepared` is that field without duplicates, if it has
    /// been made.
    pub(crate) fn missing<const D: usize>(
        &self,
        points: Points<'_, D>,
        prepared: Vec<u32>,
    ) -> (Vec<[u32; 2]>, Vec<u32>) {
        let mut duplicate_of = prepared;
        if duplicate_of.len() != points.len() {
            duplicate_of = parallel::filled(Threads::All, points.len(), NONE);
        }
        let mut missing = missing_points(points, &self.merged, &mut duplicate_of);
        if let Some(duplicates) = &self.duplicates {
            // The mesh lacks what was a duplicate. The vertex of its place then is still one.
            let parted = duplicates.iter().filter(|&&[v, _]| duplicate_of[v as usize] == NONE);
            missing = parted.copied().collect();
        }
        (missing, duplicate_of)
    }
}

message!(StartMesh { points, simplices });

impl<const D: usize> Message for Fitted<D>
where
    Dimension<D>: Dim<D>,
{
    fn write(self, to: &mut Packer) {
        vec![self.params].write(to);
        let start = self.start.map(|start| (start.first.as_ref().to_vec(), start.interior_point));
        start.is_some().write(to);
        if let Some((first, interior_point)) = start {
            first.write(to);
            interior_point.write(to);
        }
    }

    fn read(from: &mut Unpacker) -> Option<Self> {
        let params = *Vec::<InputParams>::read(from)?.first()?;
        let start = if bool::read(from)? {
            let first: Vec<Corners<D>> = Message::read(from)?;
            Some(StartSimplex { first: *first.first()?, interior_point: Message::read(from)? })
        } else {
            None
        };
        Some(Fitted { params, start })
    }
}

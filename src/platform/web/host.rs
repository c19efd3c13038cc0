//! A host of either kind, so that the engine is compiled once: its code is the largest part of a module.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Storage,
        host::{Carrier, Elsewhere, Here, Host, Request, Work},
    },
};
use std::pin::Pin;

/// What a carrier does, sooner or later.
type Done<'f, T> = Pin<Box<dyn Future<Output = Result<T, Error>> + 'f>>;

/// The object-safe form of [`Carrier`].
pub trait DynCarrier {
    fn point_count(&self) -> usize;
    fn upload<'f>(&'f mut self, gpu: &'f Gpu, to: &'f Storage<u32>) -> Done<'f, ()>;
    fn carry<'f>(
        &'f mut self,
        kind: u32,
        request: Vec<Vec<u32>>,
        meanwhile: &'f mut dyn FnMut(),
    ) -> Done<'f, Vec<Vec<u32>>>;
}

impl<C: Carrier> DynCarrier for C {
    fn point_count(&self) -> usize {
        Carrier::point_count(self)
    }

    fn upload<'f>(&'f mut self, gpu: &'f Gpu, to: &'f Storage<u32>) -> Done<'f, ()> {
        Box::pin(Carrier::upload(self, gpu, to))
    }

    fn carry<'f>(
        &'f mut self,
        kind: u32,
        request: Vec<Vec<u32>>,
        meanwhile: &'f mut dyn FnMut(),
    ) -> Done<'f, Vec<Vec<u32>>> {
        Box::pin(Carrier::carry(self, kind, request, meanwhile))
    }
}

impl<'a> Carrier for Box<dyn DynCarrier + 'a> {
    fn point_count(&self) -> usize {
        (**self).point_count()
    }

    async fn upload(&mut self, gpu: &Gpu, to: &Storage<u32>) -> Result<(), Error> {
        (**self).upload(gpu, to).await
    }

    async fn carry(
        &mut self,
        kind: u32,
        request: Vec<Vec<u32>>,
        meanwhile: impl FnOnce(),
    ) -> Result<Vec<Vec<u32>>, Error> {
        let mut meanwhile = Some(meanwhile);
        (**self).carry(kind, request, &mut || meanwhile.take().into_iter().for_each(|work| work())).await
    }
}

/// A host in the same thread, or in another one.
pub enum AnyHost<'a, const D: usize>
where
    Dimension<D>: Work<D>,
{
    /// In the same thread.
    Here(Here<'a, D>),
    /// In another thread.
    Elsewhere(Elsewhere<Box<dyn DynCarrier + 'a>>),
}

impl<'a, const D: usize> AnyHost<'a, D>
where
    Dimension<D>: Work<D>,
{
    /// Returns the host that a carrier leads to.
    pub fn elsewhere(carrier: impl Carrier + 'a) -> Self {
        AnyHost::Elsewhere(Elsewhere(Box::new(carrier)))
    }

    /// Returns what the next run gets.
    pub(crate) fn into_work(self) -> <Dimension<D> as Work<D>>::Work {
        match self {
            AnyHost::Here(host) => host.into_work(),
            AnyHost::Elsewhere(_) => Default::default(),
        }
    }
}

/// Returns the host as the engine takes it.
pub(crate) fn any_host<const D: usize>(here: Here<'_, D>) -> AnyHost<'_, D>
where
    Dimension<D>: Work<D>,
{
    AnyHost::Here(here)
}

impl<const D: usize> Host<D> for AnyHost<'_, D>
where
    Dimension<D>: Work<D>,
{
    fn point_count(&self) -> usize {
        match self {
            AnyHost::Here(host) => host.point_count(),
            AnyHost::Elsewhere(host) => Host::<D>::point_count(host),
        }
    }

    async fn upload(&mut self, gpu: &Gpu, to: &Storage<u32>) -> Result<(), Error> {
        match self {
            AnyHost::Here(host) => host.upload(gpu, to).await,
            AnyHost::Elsewhere(host) => Host::<D>::upload(host, gpu, to).await,
        }
    }

    fn work(&mut self) -> Option<&mut <Dimension<D> as Work<D>>::Work> {
        match self {
            AnyHost::Here(host) => host.work(),
            AnyHost::Elsewhere(_) => None,
        }
    }

    async fn ask_while<R: Request<D>>(&mut self, request: R, meanwhile: impl FnOnce()) -> Result<R::Answer, Error> {
        match self {
            AnyHost::Here(host) => host.ask_while(request, meanwhile).await,
            AnyHost::Elsewhere(host) => host.ask_while(request, meanwhile).await,
        }
    }

    async fn ask<R: Request<D>>(&mut self, request: R) -> Result<R::Answer, Error> {
        match self {
            AnyHost::Here(host) => host.ask(request).await,
            AnyHost::Elsewhere(host) => host.ask(request).await,
        }
    }
}

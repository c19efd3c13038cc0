//! The buffers of Phase 1 on the device and as the references have them, in 2D and 3D.

use bytemuck::Pod;
use gdel::internals::{
    dimension::Dimension,
    gpu::{
        Gpu, Readback, Storage,
        layout::{Counters, FREE_START, PARAM_WORDS, Params},
        phase1::Buffers,
    },
};
use gdel_reference::{State, d3, dim::ReferenceDim};
use pollster::block_on;
use std::ops::Range;

/// Moves the buffers that only one dimension has.
pub trait Own<const D: usize>: ReferenceDim<D>
where
    Dimension<D>: ReferenceDim<D>,
{
    fn write(gpu: &Gpu, b: &Buffers<D>, own: &Self::OwnState);
    fn read(gpu: &Gpu, b: &Buffers<D>) -> Self::OwnState;
}

impl Own<2> for Dimension<2> {
    fn write(_: &Gpu, _: &Buffers<2>, (): &()) {}
    fn read(_: &Gpu, _: &Buffers<2>) {}
}

impl Own<3> for Dimension<3> {
    fn write(gpu: &Gpu, b: &Buffers<3>, own: &d3::OwnState) {
        b.control.write(gpu, FREE_START, &own.free);
        b.own.failed.write(gpu, 0, &own.failed);
    }

    fn read(gpu: &Gpu, b: &Buffers<3>) -> d3::OwnState {
        d3::OwnState { free: read(gpu, &b.control)[FREE_START..].to_vec(), failed: read(gpu, &b.own.failed) }
    }
}

/// Reads a whole buffer.
pub fn read<T: Pod>(gpu: &Gpu, storage: &Storage<T>) -> Vec<T> {
    block_on(Readback::default().read(gpu, storage, 0, storage.len())).unwrap()
}

fn write_control(gpu: &Gpu, control: &Storage<u32>, params: &Params, counters: &Counters) {
    control.write(gpu, 0, bytemuck::cast_slice(&[*params]));
    control.write(gpu, PARAM_WORDS, bytemuck::cast_slice(&[*counters]));
}

pub fn read_counters(gpu: &Gpu, control: &Storage<u32>) -> Counters {
    *bytemuck::from_bytes(bytemuck::cast_slice(&read(gpu, control)[PARAM_WORDS..FREE_START]))
}

/// Returns where the list of waiting points is: when a round has begun that will compact it, in the
/// other half.
fn waiting_range<const D: usize>(state: &State<D>) -> Range<usize>
where
    Dimension<D>: Own<D>,
{
    let Counters { entries, entries_before, kept, waiting_half, .. } = state.counters;
    let (half, len) =
        if entries_before != 0 && kept == 0 { (waiting_half ^ 1, entries_before) } else { (waiting_half, entries) };
    let start = half * state.params.infinite;
    start as usize..(start + len) as usize
}

/// Writes all buffers but those of the points.
pub fn upload<const D: usize>(gpu: &Gpu, b: &Buffers<D>, state: &State<D>)
where
    Dimension<D>: Own<D>,
{
    write_control(gpu, &b.control, &state.params, &state.counters);
    b.simplices.write(gpu, 0, &state.simplices);
    b.neighbors.write(gpu, 0, &state.neighbors);
    b.status.write(gpu, 0, &state.status);
    b.active.write(gpu, 0, &state.active.concat());
    b.messages.write(gpu, 0, &state.messages);
    b.history.write(gpu, 0, &state.history);
    b.waiting.list.write(gpu, waiting_range(state).start, &state.waiting);
    b.waiting.scores.write(gpu, 0, &state.scores);
    Dimension::<D>::write(gpu, b, &state.own);
}

/// Reads all buffers but those of the points, which are those of `like`, and so is what the
/// references do not count.
pub fn download<const D: usize>(gpu: &Gpu, b: &Buffers<D>, like: &State<D>) -> State<D>
where
    Dimension<D>: Own<D>,
{
    let active = read(gpu, &b.active);
    let (even, odd) = active.split_at(active.len() / 2);
    let waiting = read(gpu, &b.waiting.list)[waiting_range(like)].to_vec();
    let Counters { exact, failed, taken, .. } = like.counters;
    State {
        simplices: read(gpu, &b.simplices),
        neighbors: read(gpu, &b.neighbors),
        status: read(gpu, &b.status),
        messages: read(gpu, &b.messages),
        active: [even.to_vec(), odd.to_vec()],
        history: read(gpu, &b.history),
        waiting,
        scores: read(gpu, &b.waiting.scores),
        own: Dimension::<D>::read(gpu, b),
        counters: Counters { exact, failed, taken, ..read_counters(gpu, &b.control) },
        ..like.clone()
    }
}

/// Asserts that all buffers but those of the points are equal.
pub fn assert_equal<const D: usize>(device: &State<D>, reference: &State<D>, name: &str)
where
    Dimension<D>: Own<D>,
{
    assert_eq!(device.counters, reference.counters, "{name}");
    assert_eq!(device.simplices, reference.simplices, "{name}");
    assert_eq!(device.neighbors, reference.neighbors, "{name}");
    assert_eq!(device.status, reference.status, "{name}");
    assert_eq!(device.messages, reference.messages, "{name}");
    assert_eq!(device.active, reference.active, "{name}");
    assert_eq!(device.history, reference.history, "{name}");
    assert_eq!(device.waiting, reference.waiting, "{name}");
    assert_eq!(device.scores, reference.scores, "{name}");
    assert_eq!(device.own, reference.own, "{name}");
}

//! Runs in two threads: the one that has the device drives it, the other one has the points.
//!
//! Each is an instance of this module. What one asks of the other goes as a list of typed arrays.

use gdel::{
    Error, Triangulator,
    internals::{
        Options, Winding,
        dimension::Dimension,
        gpu::{
            Gpu, Storage,
            host::{Answer, Carrier, Side, State},
        },
    },
    stats::Stats,
};
use js_sys::{Array, Function, Promise, Uint32Array};
use std::sync::Arc;
use wasm_bindgen::{
    JsCast,
    prelude::{JsValue, wasm_bindgen},
};
use wasm_bindgen_futures::JsFuture;

use crate::{
    objects::{Thrown, error, object},
    points::Coordinates,
    run::{reporting, statistics},
};

/// The words that are copied before the thread may look after something else.
const PIECE: usize = 1 << 18;

#[wasm_bindgen]
extern "C" {
    /// The way to the thread that has the points.
    #[wasm_bindgen(typescript_type = "Carrier")]
    pub type JsCarrier;

    #[wasm_bindgen(method, getter, js_name = pointCount)]
    fn points(this: &JsCarrier) -> u32;

    /// Sends a request of this kind. Returns a promise of the answer.
    #[wasm_bindgen(method)]
    fn send(this: &JsCarrier, kind: u32, request: Array) -> Promise;

    /// Writes the coordinates to a buffer of the device.
    #[wasm_bindgen(method, js_name = upload)]
    fn upload_points(this: &JsCarrier, buffer: JsValue) -> Promise;

    /// Returns a promise if the thread has been busy for long.
    #[wasm_bindgen(method)]
    fn pause(this: &JsCarrier) -> Option<Promise>;
}

#[wasm_bindgen(typescript_custom_section)]
const CARRIER: &str = r"
/** The way to the thread that has the points. */
export interface Carrier {
  readonly pointCount: number;
  /** Sends a request of this kind, and returns the answer. */
  send(kind: number, request: Uint32Array[]): Promise<Uint32Array[]>;
  /** Writes the coordinates to a buffer of the device. */
  upload(buffer: object): Promise<void>;
  /** Returns a promise if the thread has been busy for long. */
  pause(): Promise<void> | undefined;
}
";

/// Waits for a promise. Why it is rejected, its maker knows.
async fn settled(promise: Promise) -> Result<JsValue, Error> {
    JsFuture::from(promise).await.map_err(|_| Error::Cancelled)
}

/// Looks after something else if it is time.
async fn pause(carrier: &JsCarrier) -> Result<(), Error> {
    match carrier.pause() {
        Some(promise) => settled(promise).await.map(drop),
        None => Ok(()),
    }
}

impl Carrier for JsCarrier {
    fn point_count(&self) -> usize {
        self.points() as usize
    }

    async fn upload(&mut self, _gpu: &Gpu, to: &Storage<u32>) -> Result<(), Error> {
        let buffer = to.buffer().as_webgpu().ok_or(Error::Cancelled)?;
        settled(self.upload_points(buffer.into())).await.map(drop)
    }

    async fn carry(
        &mut self,
        kind: u32,
        request: Vec<Vec<u32>>,
        meanwhile: impl FnOnce(),
    ) -> Result<Vec<Vec<u32>>, Error> {
        let lists = Array::new();
        for words in request {
            let array = Uint32Array::new_with_length(words.len() as u32);
            for (at, piece) in (0..).step_by(PIECE).zip(words.chunks(PIECE)) {
                pause(self).await?;
                array.subarray(at, at + piece.len() as u32).copy_from(piece);
            }
            lists.push(&array);
        }
        let answer = self.send(kind, lists);
        meanwhile();
        let answer: Array = settled(answer).await?.unchecked_into();
        let mut lists = Vec::new();
        for array in answer.iter() {
            let array: Uint32Array = array.unchecked_into();
            let mut words = vec![0; array.length() as usize];
            for (at, piece) in (0..).step_by(PIECE).zip(words.chunks_mut(PIECE)) {
                pause(self).await?;
                array.subarray(at, at + piece.len() as u32).copy_to(piece);
            }
            lists.push(words);
        }
        Ok(lists)
    }
}

/// The points of a run that another thread drives, and what is known of them.
struct Session<const D: usize>
where
    Dimension<D>: Answer<D>,
{
    points: Coordinates,
    options: Options,
    state: State<D>,
}

impl<const D: usize> Session<D>
where
    Dimension<D>: Answer<D>,
{
    fn new(points: JsValue, winding: Winding, report: Function) -> Result<Self, Thrown> {
        let points = Coordinates::new(&points)?;
        points.points::<D>()?;
        let options = Options { winding, on_progress: Some(Arc::new(reporting(report))), ..Options::default() };
        Ok(Session { points, options, state: State::default() })
    }

    fn answer(&mut self, kind: u32, request: Vec<Uint32Array>) -> Result<Array, Thrown> {
        let request = request.iter().map(Uint32Array::to_vec).collect();
        let mut side = Side::new(self.points.points()?, &self.options, std::mem::take(&mut self.state));
        let answer = Dimension::<D>::answer(&mut side, kind, request);
        self.state = side.into_state();
        let answer = answer.ok_or_else(|| error("INTERNAL", "a message between threads is broken"))?;
        Ok(answer.iter().map(|words| Uint32Array::new_from_slice(words)).collect())
    }
}

/// Implements the session of a dimension.
macro_rules! session {
    ($name:ident, $D:literal, $winding:expr) => {
        /// The points of a run that another thread drives.
        #[wasm_bindgen]
        pub struct $name(Session<$D>);

        #[wasm_bindgen]
        impl $name {
            /// Copies the points. Answers call `report(phase, fraction)`.
            #[wasm_bindgen(constructor)]
            pub fn new(points: JsValue, report: Function) -> Result<Self, Thrown> {
                Ok($name(Session::new(points, $winding, report)?))
            }

            /// Answers a request of this kind.
            pub fn answer(&mut self, kind: u32, request: Vec<Uint32Array>) -> Result<Array, Thrown> {
                self.0.answer(kind, request)
            }
        }
    };
}

#[cfg(feature = "d3")]
session!(Session3, 3, Winding::default());
#[cfg(feature = "d2")]
session!(Session2, 2, Winding::Clockwise);

/// Returns what a run did that the CPU engine has to take over.
pub(crate) fn left_to_cpu(before: &Stats) -> JsValue {
    object([("leftToCpu", statistics(before))])
}

/// Returns a triangulator for one run on the device.
pub(crate) fn for_device(triangulator: &Triangulator, report: Function) -> Triangulator {
    triangulator.clone().on_progress(reporting(report))
}

//! Triangulations by several workers, each of which has a part of the points.

use crate::{
    objects::{Thrown, error, object, set, signed},
    points::Coordinates,
    run::{reporting, statistics},
};
use gdel::{
    NONE,
    internals::{
        Options, Winding,
        dimension::Dimension,
        geometry::{Euclidean, Geometry},
    },
    tiles::{BorderFacet, Message, Part, Plan, Survey, Tile, Tiled, links},
};
use js_sys::{Array, Float64Array, Function, Int32Array, Uint8Array, Uint32Array};
use std::{mem, sync::Arc};
use wasm_bindgen::{
    JsCast,
    prelude::{JsValue, wasm_bindgen},
};

/// Of at least so many points one is known to all tiles, …
const EVERY: u32 = 1000;
/// … and at least so many points are, if there are as many.
const COMMON: u32 = 4096;

/// Splits points of 2 or 3 dimensions into tiles: returns the plan, and for each tile its points and their indices.
#[wasm_bindgen(js_name = splitPoints)]
pub fn split_points(dimension: u32, points: &JsValue, tiles: u32) -> Result<JsValue, Thrown> {
    if dimension == 3 { split::<3>(points, tiles) } else { split::<2>(points, tiles) }
}

fn split<const D: usize>(points: &JsValue, tiles: u32) -> Result<JsValue, Thrown>
where
    Dimension<D>: gdel::internals::cpu::Incremental<D>,
{
    let coordinates = Coordinates::new(points)?;
    let points = coordinates.points::<D>()?;
    let every = (points.len() as u32 / COMMON).clamp(1, EVERY);
    let plan = Plan::new(Survey::new(points, 0, every)?, tiles);
    let parts: Array = plan
        .split(points, 0)
        .into_iter()
        .map(|(points, indices)| {
            object([
                ("points", Float64Array::new_from_slice(points.as_flattened()).into()),
                ("indices", Uint32Array::new_from_slice(&indices).into()),
            ])
        })
        .collect();
    Ok(object([
        ("spanned", plan.dimension().into()),
        ("plan", Uint8Array::new_from_slice(&plan.to_bytes()).into()),
        ("parts", parts.into()),
    ]))
}

/// One of the tiles.
#[wasm_bindgen]
pub struct WasmTile(Option<AnyTile>);

enum AnyTile {
    In2(Tile<2, 3>),
    In3(Tile<3, 4>),
    Done2(Part<3>),
    Done3(Part<4>),
}

#[wasm_bindgen]
impl WasmTile {
    /// Creates the tile with this number; in 2D in delaunator's orientation.
    #[wasm_bindgen(constructor)]
    pub fn new(
        dimension: u32,
        plan: &[u8],
        number: u32,
        points: Vec<f64>,
        indices: Vec<u32>,
        report: Function,
    ) -> Result<WasmTile, Thrown> {
        let options = Options {
            on_progress: Some(Arc::new(reporting(report))),
            winding: Winding::Clockwise,
            ..Options::default()
        };
        let tile = if dimension == 3 {
            AnyTile::In3(tile(plan, number, points, indices, options)?)
        } else {
            AnyTile::In2(tile(plan, number, points, indices, options)?)
        };
        Ok(WasmTile(Some(tile)))
    }

    /// Takes a step: takes numbers of senders, each with its message after it, and returns numbers of receivers, each
    /// with the message for it.
    pub fn step(&mut self, received: &Array) -> Result<Array, Thrown> {
        match &mut self.0 {
            Some(AnyTile::In2(tile)) => step(tile, received),
            Some(AnyTile::In3(tile)) => step(tile, received),
            _ => Err(no_tile()),
        }
    }

    /// Ends the steps. Returns how many simplices the tile has, its statistics, and the duplicates among its points.
    pub fn finish(&mut self) -> Result<JsValue, Thrown> {
        let (stats, done) = match self.0.take() {
            Some(AnyTile::In2(tile)) => (tile.stats().clone(), AnyTile::Done2(tile.finish()?)),
            Some(AnyTile::In3(tile)) => (tile.stats().clone(), AnyTile::Done3(tile.finish()?)),
            _ => return Err(no_tile()),
        };
        let (count, duplicates) = match &done {
            AnyTile::Done2(part) => (part.simplices.len(), &part.duplicates),
            AnyTile::Done3(part) => (part.simplices.len(), &part.duplicates),
            _ => return Err(no_tile()),
        };
        let result = object([
            ("simplices", (count as f64).into()),
            ("stats", statistics(&stats)),
            ("duplicates", Uint32Array::new_from_slice(duplicates.as_flattened()).into()),
        ]);
        self.0 = Some(done);
        Ok(result)
    }

    /// Returns the arrays of the tile, before which there are `base` simplices in the mesh.
    pub fn take(mut self, base: u32) -> Result<JsValue, Thrown> {
        match self.0.take() {
            Some(AnyTile::Done2(part)) => Ok(arrays::<2, 3>(part, base, None)),
            Some(AnyTile::Done3(part)) => Ok(arrays::<3, 4>(part, base, None)),
            _ => Err(no_tile()),
        }
    }

    /// Copies the simplices and their neighbours to the beginning of arrays of a mesh. Returns the other arrays.
    #[wasm_bindgen(js_name = copyTo)]
    pub fn copy_to(mut self, simplices: &Uint32Array, neighbors: &Int32Array) -> Result<JsValue, Thrown> {
        match self.0.take() {
            Some(AnyTile::Done2(part)) => Ok(arrays::<2, 3>(part, 0, Some((simplices, neighbors)))),
            Some(AnyTile::Done3(part)) => Ok(arrays::<3, 4>(part, 0, Some((simplices, neighbors)))),
            _ => Err(no_tile()),
        }
    }
}

fn no_tile() -> Thrown {
    error("INTERNAL", "a tile is asked for something in the wrong order").into()
}

fn tile<const D: usize, const N: usize>(
    plan: &[u8],
    number: u32,
    points: Vec<f64>,
    indices: Vec<u32>,
    options: Options,
) -> Result<Tile<D, N>, Thrown>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let points =
        bytemuck::allocation::try_cast_vec(points).unwrap_or_else(|(_, points)| points.as_chunks::<D>().0.to_vec());
    Ok(Tile::with_options(Arc::new(Plan::from_bytes(plan)?), number, points, indices, options)?)
}

fn step<const D: usize, const N: usize>(tile: &mut Tile<D, N>, received: &Array) -> Result<Array, Thrown>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let mut messages = Vec::new();
    for i in (0..received.length()).step_by(2) {
        let from = received.get(i).as_f64().unwrap_or_default() as u32;
        let bytes: Uint8Array = received.get(i + 1).unchecked_into();
        messages.push((from, Message::from_bytes(&bytes.to_vec())?));
    }
    let sent = Array::new();
    for (to, message) in tile.step(messages)? {
        sent.push(&to.into());
        sent.push(&Uint8Array::new_from_slice(&message.to_bytes()));
    }
    Ok(sent)
}

/// Engines replace code by faster code only when it is called again.
const PIECE: usize = 1 << 12;

/// Adds a number to all entries of neighbours that are there.
#[inline(never)]
fn add(entries: &mut [u32], by: u32) {
    for entry in entries {
        *entry = if *entry == NONE { NONE } else { *entry + by };
    }
}

/// Copies the arrays of a part, the large ones into those of a mesh if these are there. Each is freed as soon as it is
/// copied.
fn arrays<const D: usize, const N: usize>(
    mut part: Part<N>,
    base: u32,
    into: Option<(&Uint32Array, &Int32Array)>,
) -> JsValue
where
    Dimension<D>: Tiled<D, N>,
{
    let by = base * Dimension::<D>::STRIDE;
    if by > 0 {
        part.neighbors.chunks_mut(PIECE).for_each(|piece| add(piece.as_flattened_mut(), by));
    }
    let moved = |facet: &BorderFacet| {
        let [a, b, c] = facet.vertices;
        [a, b, c, facet.place + base * N as u32, facet.entry + by]
    };
    let borders: Vec<[u32; 5]> = part.borders.iter().map(moved).collect();
    let hull: Vec<u32> = part.hull.iter().flat_map(|facet| facet[..D].iter().copied()).collect();
    let result = object([
        ("borders", Uint32Array::new_from_slice(borders.as_flattened()).into()),
        ("hull", Uint32Array::new_from_slice(&hull).into()),
    ]);
    let (simplices, neighbors) = (mem::take(&mut part.simplices), mem::take(&mut part.neighbors));
    if let Some((to_simplices, to_neighbors)) = into {
        let length = simplices.as_flattened().len() as u32;
        to_simplices.subarray(0, length).copy_from(simplices.as_flattened());
        drop(simplices);
        to_neighbors.subarray(0, length).copy_from(bytemuck::cast_slice(neighbors.as_flattened()));
    } else {
        set(&result, "simplices", Uint32Array::new_from_slice(simplices.as_flattened()));
        drop(simplices);
        set(&result, "neighbors", signed(neighbors.as_flattened()));
    }
    result
}

/// Joins the tiles of a mesh, whose neighbours of all tiles are in one array, into which those in other tiles go.
/// Returns the hull.
#[wasm_bindgen(js_name = joinTiles)]
pub fn join_tiles(
    dimension: u32,
    borders: Vec<u32>,
    hull: Vec<u32>,
    neighbors: &Int32Array,
) -> Result<Uint32Array, Thrown> {
    let facet = |&[a, b, c, place, entry]: &[u32; 5]| BorderFacet { vertices: [a, b, c], place, entry };
    let borders = borders.as_chunks().0.iter().map(facet);
    let (found, hull) = if dimension == 3 {
        (links(borders, hull.as_chunks::<3>().0)?, hull)
    } else {
        let edges = hull.as_chunks::<2>().0.to_vec();
        let found = links(borders, &edges)?;
        (found, Dimension::<2>::assemble(Vec::new(), Vec::new(), edges, Winding::Clockwise).hull)
    };
    for [place, entry] in found {
        neighbors.set_index(place, entry as i32);
    }
    Ok(Uint32Array::new_from_slice(&hull))
}

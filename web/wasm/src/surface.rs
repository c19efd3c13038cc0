//! The closed surface through points.

use crate::{
    objects::{Thrown, object, signed},
    points::Coordinates,
    task::{OfCaller, Task, coordinates, in_dimension, option},
};
use gdel::{
    Mesh2, Mesh3, Open, Side, Surface, SurfaceOptions,
    internals::{derived::SurfaceMesh, geometry::Euclidean},
};
use js_sys::{Array, Function, Uint8Array, Uint32Array};
use wasm_bindgen::{
    JsCast,
    prelude::{JsValue, wasm_bindgen},
};

/// Returns the closed surface through the points. What `options` do not have is as in
/// [`SurfaceOptions::default`].
#[wasm_bindgen]
pub fn surface(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, surface_in(points, mesh, options, report))
}

fn surface_in<M: OfCaller<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: SurfaceMesh<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "surface")?;
    let mut is_solid_wanted = false;
    option(options, "solid", "true or false", JsValue::as_bool, &mut is_solid_wanted)?;
    let [normals, sensors] = [vectors::<D>(options, "normals")?, vectors::<D>(options, "sensors")?];
    let given = surface_options(options, [&normals, &sensors])?;
    let surface = Surface::new(&task.mesh, task.points.points::<D>()?, &given)?;
    task.report(0.9)?;
    let sides: Vec<u8> = surface.sides().iter().map(|&side| code_of(side)).collect();
    let [pieces, cavities] = surface.dropped();
    let facets = if D == 2 { "edges" } else { "triangles" };
    let solid = match is_solid_wanted {
        true => Uint32Array::new_from_slice(surface.solid().as_flattened()).into(),
        false => JsValue::NULL,
    };
    Ok(object([
        (facets, Uint32Array::new_from_slice(surface.facets().as_flattened()).into()),
        ("vertices", task.points.in_same_precision(coordinates(surface.vertices()))),
        ("sources", signed(surface.sources()).into()),
        ("sides", Uint8Array::new_from_slice(&sides).into()),
        ("volume", surface.volume().into()),
        ("area", surface.area().into()),
        ("components", surface.components().into()),
        ("genus", surface.genus().into()),
        ("closed", surface.is_closed().into()),
        ("boundaries", surface.boundaries().into()),
        ("evidence", surface.evidence().name().into()),
        ("noise", surface.noise().into()),
        ("isolated", surface.isolated().into()),
        ("droppedPieces", pieces.into()),
        ("filledCavities", cavities.into()),
        ("moved", surface.moved_points().map_or(JsValue::NULL, |points| coordinates(points).into())),
        ("solid", solid),
    ]))
}

/// Normals or positions of sensors among the options.
fn vectors<const D: usize>(options: &JsValue, name: &str) -> Result<Option<Coordinates>, Thrown> {
    let mut vectors = None;
    let convert = |value: &JsValue| Some(Some(Coordinates::new(value).ok().filter(|all| all.points::<D>().is_ok())?));
    let must_be = format!("a Float32Array or a Float64Array of {D} numbers per vector");
    option(options, name, &must_be, convert, &mut vectors)?;
    if D == 2 {
        vectors.iter_mut().for_each(Coordinates::flip_y);
    }
    Ok(vectors)
}

/// Converts the options; [`vectors`] are those among them.
fn surface_options<'a, const D: usize>(
    options: &JsValue,
    [normals, sensors]: [&'a Option<Coordinates>; 2],
) -> Result<SurfaceOptions<'a, D>, Thrown> {
    let mut found = SurfaceOptions::default();
    let share = |value: &JsValue| value.as_f64().filter(|share| (0.0..=1.0).contains(share));
    // `auto` is `None`.
    let times = |value: &JsValue| match value.as_f64() {
        Some(times) if (0.0..=100.0).contains(&times) && times.fract() == 0.0 => Some(Some(times as u32)),
        None if *value == "auto" => Some(None),
        _ => None,
    };
    let direction = |value: &JsValue| {
        let numbers: Option<Vec<f64>> = value.dyn_ref::<Array>()?.iter().map(|x| x.as_f64()).collect();
        let mut direction: [f64; D] = numbers?.try_into().ok()?;
        if D == 2 {
            direction[1] = -direction[1];
        }
        Some(Some(direction))
    };
    let open = |value: &JsValue| match value.as_string()?.as_str() {
        "never" => Some(Open::Never),
        "auto" => Some(Open::Auto),
        _ => None,
    };
    option(options, "minPart", "a number from 0 to 1", share, &mut found.min_part)?;
    option(options, "dropIsolated", "true or false", JsValue::as_bool, &mut found.drop_isolated)?;
    option(options, "smooth", "'auto' or an integer from 0 to 100", times, &mut found.smooth)?;
    option(options, "refine", "true or false", JsValue::as_bool, &mut found.refine)?;
    option(options, "up", &format!("an array of {D} numbers"), direction, &mut found.up)?;
    option(options, "open", "'never' or 'auto'", open, &mut found.open)?;
    found.normals = normals.as_ref().map(Coordinates::points).transpose()?;
    found.sensors = sensors.as_ref().map(Coordinates::points).transpose()?;
    Ok(found)
}

/// Returns the number that says where a point lies.
fn code_of(side: Side) -> u8 {
    match side {
        Side::Outside => 0,
        Side::On => 1,
        Side::Inside => 2,
    }
}

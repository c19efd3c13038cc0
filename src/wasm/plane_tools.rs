//! The same as in [`tools`](crate::wasm::tools) for the plane.

use js_sys::{Float64Array, Int32Array, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::wasm::{
    objects::{error, object},
    points::{Coordinates, zeros},
    tools::{check_vertices, copied, file, no_format, report_object, rows},
};
use crate::{
    Mesh2, NONE,
    d2::{
        generate::{self, Distribution2},
        verify::{MeshView2, verify2d},
    },
    io::{SurfaceFormat, write_ele, write_neigh, write_node, write_npz, write_vtu},
};

/// `count` points of the distribution of that name in the plane, interleaved.
#[wasm_bindgen]
pub fn generate2d(kind: &str, count: u32, seed: u64) -> Result<Float64Array, JsValue> {
    let names = || Distribution2::ALL.map(Distribution2::name).join(", ");
    let distribution = Distribution2::ALL.into_iter().find(|d| d.name() == kind);
    let distribution = distribution.ok_or_else(|| {
        error("BAD_INPUT", &format!("there is no distribution {kind:?} in the plane, but {}", names()))
    })?;
    // Fails here where the points could not be held twice, and not half-way.
    drop(zeros::<[f64; 4]>(count)?);
    let points = generate::generate2d(distribution, count as usize, seed);
    Ok(Float64Array::new_from_slice(points.as_flattened()))
}

/// A mesh of the plane, copied into this module's memory.
#[wasm_bindgen]
pub struct PlaneMesh {
    points: Coordinates,
    triangles: Vec<[u32; 3]>,
    halfedges: Option<Vec<[i32; 3]>>,
    hull: Option<Vec<u32>>,
    duplicate_of: Option<Vec<i32>>,
    dimension: Option<u8>,
}

#[wasm_bindgen]
impl PlaneMesh {
    #[wasm_bindgen(constructor)]
    pub fn new(
        points: &JsValue,
        triangles: &Uint32Array,
        halfedges: Option<Int32Array>,
        hull: Option<Uint32Array>,
        duplicate_of: Option<Int32Array>,
        dimension: Option<u8>,
    ) -> Result<PlaneMesh, JsValue> {
        let points = Coordinates::new(points)?;
        points.points::<2>()?.validate()?;
        Ok(PlaneMesh {
            points,
            triangles: rows("triangles", triangles.length(), |to| triangles.copy_to(to))?,
            halfedges: halfedges.map(|a| rows("halfedges", a.length(), |to| a.copy_to(to))).transpose()?,
            hull: hull.map(|a| copied(a.length(), |to| a.copy_to(to))).transpose()?,
            duplicate_of: duplicate_of.map(|a| copied(a.length(), |to| a.copy_to(to))).transpose()?,
            dimension,
        })
    }

    /// The triangles as files of a format: `{ extension: bytes }`, more than one only for Triangle's.
    pub fn write(&self, format: &str) -> Result<JsValue, JsValue> {
        let points = self.points.points::<2>()?;
        check_vertices(self.triangles.as_flattened().iter(), points.len())?;
        let mut mesh = Mesh2::default();
        mesh.triangles = self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let turned = |halfedge: i32| if halfedge == NONE { NONE } else { halfedge / 3 * 3 + 2 - halfedge % 3 };
        mesh.halfedges = self.halfedges.iter().flatten().map(|&[a, b, c]| [c, b, a].map(turned)).collect();
        let mesh = &mesh;
        match format {
            "vtu" => Ok(object([file("vtu", |to| write_vtu(to, points, mesh))?])),
            "npz" => Ok(object([file("npz", |to| write_npz(to, points, mesh))?])),
            "triangle" => Ok(object([
                file("node", |to| write_node(to, points))?,
                file("ele", |to| write_ele(to, mesh))?,
                file("neigh", |to| write_neigh(to, mesh))?,
            ])),
            _ => {
                let format = SurfaceFormat::from_extension(format).ok_or_else(|| no_format(format))?;
                Ok(object([file(format.extensions()[0], |to| format.write(to, points, mesh))?]))
            }
        }
    }

    /// What the verifier finds.
    pub fn verify(&self) -> Result<JsValue, JsValue> {
        let report = verify2d(
            self.points.points::<2>()?,
            MeshView2 {
                triangles: &self.triangles,
                halfedges: self.halfedges.as_deref(),
                neighbors: None,
                hull: self.hull.as_deref(),
                duplicate_of: self.duplicate_of.as_deref(),
                dimension: self.dimension,
            },
        )?;
        let counts = report.counts;
        Ok(report_object(
            &report,
            object([
                ("points", counts.points.into()),
                ("distinctPoints", counts.distinct_points.into()),
                ("vertices", counts.vertices.into()),
                ("edges", counts.edges.into()),
                ("triangles", counts.facets.into()),
                ("hullEdges", counts.hull_edges.into()),
            ]),
        ))
    }
}

//! The formats by file extension.

use crate::{
    FormatError, Mesh, MeshData, PointCloud, Position, Shapes, e57, geojson, glb, las, npy, npz, obj, off, pcd, ply,
    poly, ptx, raw, stl, surface::Surface, svg, tetgen, text, three_mf, vtu,
};
use gdel::Points;
use std::io::{self, Write};

/// Declares an enum of formats with their file extensions, lower case; the first is the usual one.
macro_rules! formats {
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident: $($extension:literal)|+,)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name {
            $($(#[$variant_doc])* $variant,)+
        }

        impl $name {
            /// All formats of this kind.
            pub const ALL: &[$name] = &[$($name::$variant),+];

            /// Returns the format of files with this extension, in any case, without the dot.
            pub fn from_extension(extension: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|f| f.extensions().iter().any(|e| e.eq_ignore_ascii_case(extension)))
            }

            /// Returns the extensions of this format, the usual one first.
            pub fn extensions(self) -> &'static [&'static str] {
                match self {
                    $($name::$variant => &[$($extension),+],)+
                }
            }
        }
    };
}

formats! {
    /// A format of point clouds.
    PointFormat {
        /// Stanford PLY: the vertices' x, y, z.
        Ply: "ply",
        /// Wavefront OBJ: the `v` lines.
        Obj: "obj",
        /// STL, ASCII or binary: the triangles' corners, equal ones once.
        Stl: "stl",
        /// Geomview's OFF, in text: the vertices.
        Off: "off",
        /// x, y, z per line, separated by white space, commas or semicolons; more columns are
        /// ignored.
        Text: "xyz" | "txt" | "asc" | "pts",
        /// Comma-, semicolon- or tab-separated values; a first row of names may say which columns
        /// are x, y and z.
        Csv: "csv" | "tsv",
        /// Leica's PTX: the points of all scans, in the coordinates that these share.
        Ptx: "ptx",
        /// Point Cloud Library.
        Pcd: "pcd",
        /// ASPRS LAS and its compressed form LAZ.
        Las: "las" | "laz",
        /// ASTM E57: the points of all scans, in the coordinates of the file.
        E57: "e57",
        /// A NumPy array of shape (n, 3), for 2D points also (n, 2), of whole or floating-point
        /// numbers.
        Npy: "npy",
        /// The points of TetGen or Triangle.
        Node: "node",
        /// Only x, y, z in little-endian single precision, also for 2D points.
        RawF32: "f32",
        /// Only x, y, z in little-endian double precision, also for 2D points.
        RawF64: "f64",
    }
}

formats! {
    /// A format of tetrahedra, or of the triangles of a 2D mesh.
    MeshFormat {
        /// TetGen, in 2D Triangle: `.node` (points), `.ele` (tetrahedra) and `.neigh` (neighbours),
        /// always together, counted from 0.
        TetGen: "ele" | "node" | "neigh",
        /// VTK's XML unstructured grid.
        Vtu: "vtu",
        /// NumPy arrays `points`, `tetrahedra` and `neighbors`; in 2D `points`, `triangles` and
        /// `halfedges`.
        Npz: "npz",
    }
}

formats! {
    /// A format of meshes for solvers, which is only written.
    SolverFormat {
        /// Gmsh's MSH: all points, constrained edges and simplices.
        Msh: "msh",
        /// Triangle's planar straight-line graphs: the points and constrained edges of a 2D mesh.
        Poly: "poly",
    }
}

formats! {
    /// A format of tables.
    TableFormat {
        /// Comma-separated values with the names of the columns in the first line.
        Csv: "csv",
        /// One NumPy array per column.
        Npz: "npz",
    }
}

formats! {
    /// A format of the hull's triangles, or of all triangles of a 2D mesh.
    SurfaceFormat {
        /// Stanford PLY, binary little-endian.
        Ply: "ply",
        /// Wavefront OBJ.
        Obj: "obj",
        /// STL.
        Stl: "stl",
        /// Binary glTF 2.0.
        Glb: "glb",
        /// 3MF, for printing; units are millimetres.
        ThreeMf: "3mf",
    }
}

formats! {
    /// A format of shapes in a plane.
    ShapeFormat {
        /// GeoJSON: polygons with their holes, lines and points; heights are dropped.
        GeoJson: "geojson" | "json",
        /// Triangle's planar straight-line graphs: points, segments and places in holes.
        Poly: "poly",
        /// SVG: closed paths and basic shapes as boundaries, open ones as lines, with *y* up.
        Svg: "svg",
    }
}

impl PointFormat {
    /// Reads a whole file of this format.
    ///
    /// 3D points (`D` = 3) need *x*, *y* and *z*; of 2D points (`D` = 2) a *z* is dropped.
    ///
    /// A file without points is an empty cloud, whatever its format. So files of zero bytes are
    /// read where a format has no header (text, CSV, OBJ and raw numbers), and are errors where it
    /// has one.
    ///
    /// # Errors
    ///
    /// Returns where the file is broken, and how.
    pub fn read<const D: usize>(self, bytes: Vec<u8>) -> Result<PointCloud<D>, FormatError> {
        let has_header = !matches!(
            self,
            PointFormat::Obj | PointFormat::Text | PointFormat::Csv | PointFormat::RawF32 | PointFormat::RawF64
        );
        if bytes.is_empty() && has_header {
            return Err(FormatError::byte(0, "the file is empty"));
        }
        match self {
            PointFormat::Text => text::read(&bytes),
            PointFormat::Csv => text::read_csv(&bytes),
            PointFormat::Npy => npy::read(&bytes),
            PointFormat::Node => tetgen::read_node(&bytes),
            _ => self.read_3d(bytes).map(PointCloud::resize),
        }
    }

    /// Reads a whole text, CSV, PLY or `.node` file, and the values in its column with a name or a number,
    /// counted from 1: one per point. Columns of PLY are the properties of vertices.
    ///
    /// # Errors
    ///
    /// Returns where the file is broken, and how; values of other formats are not read, which is an error,
    /// too.
    pub fn read_with_values<const D: usize>(
        self,
        bytes: &[u8],
        column: &str,
    ) -> Result<(PointCloud<D>, Vec<f64>), FormatError> {
        match self {
            PointFormat::Text => text::read_with_values(bytes, Some(column)),
            PointFormat::Csv => text::read_csv_with_values(bytes, Some(column)),
            PointFormat::Ply => {
                ply::read_with_values(bytes, Some(column)).map(|(cloud, values)| (cloud.resize(), values))
            }
            PointFormat::Node => tetgen::read_node_with_values(bytes, column),
            _ => Err(FormatError::byte(0, "values are read from text, CSV, PLY, .node, .npz and .vtu files only")),
        }
    }

    /// Reads a format whose points always have three coordinates.
    fn read_3d(self, bytes: Vec<u8>) -> Result<PointCloud, FormatError> {
        match self {
            PointFormat::Ply => ply::read(&bytes),
            PointFormat::Obj => obj::read(&bytes),
            PointFormat::Stl => stl::read(&bytes),
            PointFormat::Off => off::read(&bytes),
            PointFormat::Ptx => ptx::read(&bytes),
            PointFormat::Pcd => pcd::read(&bytes),
            PointFormat::Las => las::read(bytes),
            PointFormat::E57 => e57::read(&bytes),
            PointFormat::RawF32 => raw::read_f32(&bytes),
            PointFormat::RawF64 => raw::read_f64(&bytes),
            PointFormat::Text | PointFormat::Csv | PointFormat::Npy | PointFormat::Node => self.read(bytes),
        }
    }

    /// Returns whether [`write`](Self::write) supports this format.
    pub fn is_written(self) -> bool {
        use PointFormat::*;
        !matches!(self, Stl | Off | Ptx | Pcd | Las | E57)
    }

    /// Writes points in this format. 2D points have two columns in text, CSV, NumPy and `.node`
    /// files, else *z* = 0.
    ///
    /// # Errors
    ///
    /// Returns an error if `to` cannot be written, and [`io::ErrorKind::Unsupported`] for the
    /// formats that are only read.
    pub fn write<const D: usize>(self, to: impl Write, points: Points<'_, D>) -> io::Result<()> {
        match self {
            PointFormat::Ply => ply::write_points(to, points),
            PointFormat::Obj => obj::write_points(to, points),
            PointFormat::Text => text::write(to, points),
            PointFormat::Csv => text::write_csv(to, points),
            PointFormat::Npy => npy::write(to, points),
            PointFormat::Node => tetgen::write_node(to, points),
            PointFormat::RawF32 => raw::write_f32(to, points),
            PointFormat::RawF64 => raw::write_f64(to, points),
            PointFormat::Stl
            | PointFormat::Off
            | PointFormat::Ptx
            | PointFormat::Pcd
            | PointFormat::Las
            | PointFormat::E57 => Err(io::ErrorKind::Unsupported.into()),
        }
    }
}

impl MeshFormat {
    /// Reads a whole mesh file of this format; of TetGen's, the `.ele` file.
    ///
    /// # Errors
    ///
    /// Returns where the file is broken, and how.
    pub fn read<M: Mesh<D, N>, const D: usize, const N: usize>(
        self,
        bytes: &[u8],
    ) -> Result<MeshData<D, N>, FormatError> {
        match self {
            MeshFormat::TetGen => Ok(M::from_arrays(tetgen::read_ele::<M, D, N>(bytes)?, None)),
            MeshFormat::Vtu => vtu::read_vtu::<M, D, N>(bytes),
            MeshFormat::Npz => npz::read_npz::<M, D, N>(bytes),
        }
    }
}

impl SurfaceFormat {
    /// Writes the hull of a 3D mesh, or all triangles of a 2D mesh with *z* = 0; without the points
    /// that are not its vertices.
    ///
    /// PLY keeps the precision of the points. STL is binary if single precision holds the
    /// coordinates exactly, else ASCII. Binary glTF has single precision: coordinates that it does
    /// not hold exactly are relative to the centre of the surface, and the translation of the node
    /// is that centre in double precision. Axes are not exchanged, though *y* points up in glTF.
    ///
    /// # Errors
    ///
    /// Returns an error if `to` cannot be written, and [`io::ErrorKind::FileTooLarge`] if a binary
    /// glTF would exceed 4 GB.
    pub fn write<const D: usize, const N: usize, M: Mesh<D, N>>(
        self,
        to: impl Write,
        points: Points<'_, D>,
        mesh: &M,
    ) -> io::Result<()> {
        self.write_surface(to, &Surface::new(points, mesh.surface(), M::NAMES.surface))
    }

    /// Writes triangles, as [`write`](Self::write) does; `name` says what they are, in printable
    /// ASCII without quotation marks or backslashes.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`write`](Self::write).
    pub fn write_triangles<const D: usize>(
        self,
        to: impl Write,
        points: Points<'_, D>,
        triangles: &[[u32; 3]],
        name: &'static str,
    ) -> io::Result<()> {
        self.write_surface(to, &Surface::new(points, triangles.into(), name))
    }

    fn write_surface<const D: usize>(self, to: impl Write, surface: &Surface<'_, D>) -> io::Result<()> {
        match self {
            SurfaceFormat::Ply => ply::write_surface(to, surface),
            SurfaceFormat::Obj => obj::write_surface(to, surface),
            SurfaceFormat::Stl => stl::write_surface(to, surface),
            SurfaceFormat::Glb => glb::write_surface(to, surface),
            SurfaceFormat::ThreeMf => three_mf::write_surface(to, surface),
        }
    }
}

impl ShapeFormat {
    /// Reads a whole file of this format. The points of a `.poly` file must be in it:
    /// [`files::read_shapes`](crate::files::read_shapes) finds those in a `.node` file beside it, too.
    ///
    /// # Errors
    ///
    /// Returns where the file is broken, and how.
    pub fn read(self, bytes: &[u8]) -> Result<Shapes, FormatError> {
        match self {
            ShapeFormat::GeoJson => geojson::read(bytes),
            ShapeFormat::Svg => svg::read(bytes),
            ShapeFormat::Poly => poly::read(bytes, || {
                Err(FormatError { at: Position::Line(1), what: "the points are not in this file".into() })
            }),
        }
    }
}

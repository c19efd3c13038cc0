//! The formats by file extension.

use crate::io::{
    FormatError, MeshData, MeshData2, PointCloud, glb, las, npy, npz, obj, pcd, plane, ply, raw, stl, tetgen, text, vtu,
};
use crate::{Mesh3, Points};
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

            /// The format of files with this extension, in any case, without the dot.
            pub fn from_extension(extension: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|f| f.extensions().iter().any(|e| e.eq_ignore_ascii_case(extension)))
            }

            /// The extensions of this format, the usual one first.
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
        /// x, y, z a line, separated by white space, commas or semicolons; more columns are ignored.
        Text: "xyz" | "txt" | "asc" | "pts",
        /// Comma-, semicolon- or tab-separated values; a first row of names may say which columns are x, y and z.
        Csv: "csv" | "tsv",
        /// Point Cloud Library.
        Pcd: "pcd",
        /// ASPRS LAS and its compressed form LAZ.
        Las: "las" | "laz",
        /// A NumPy array of shape (n, 3).
        Npy: "npy",
        /// Nothing but x, y, z as little-endian single precision.
        RawF32: "f32",
        /// Nothing but x, y, z as little-endian double precision.
        RawF64: "f64",
    }
}

formats! {
    /// A format of tetrahedral meshes.
    MeshFormat {
        /// TetGen, in the plane Triangle: `.node` (points), `.ele` (tetrahedra) and `.neigh` (neighbours), always together,
        /// counted from 0.
        TetGen: "ele" | "node" | "neigh",
        /// VTK's XML unstructured grid.
        Vtu: "vtu",
        /// NumPy arrays `points`, `tetrahedra` and `neighbors`.
        Npz: "npz",
    }
}

formats! {
    /// A format of the hull's triangles.
    HullFormat {
        /// Stanford PLY, binary little-endian.
        Ply: "ply",
        /// Wavefront OBJ.
        Obj: "obj",
        /// STL.
        Stl: "stl",
        /// Binary glTF 2.0.
        Glb: "glb",
    }
}

impl PointFormat {
    /// Reads a whole file of this format.
    ///
    /// # Errors
    ///
    /// Where the file is broken, and how.
    pub fn read(self, bytes: Vec<u8>) -> Result<PointCloud, FormatError> {
        if bytes.is_empty() {
            return Err(FormatError::byte(0, "the file is empty"));
        }
        match self {
            PointFormat::Ply => ply::read(&bytes),
            PointFormat::Obj => obj::read(&bytes),
            PointFormat::Stl => stl::read(&bytes),
            PointFormat::Text => text::read(&bytes),
            PointFormat::Csv => text::read_csv(&bytes),
            PointFormat::Pcd => pcd::read(&bytes),
            PointFormat::Las => las::read(bytes),
            PointFormat::Npy => npy::read(&bytes),
            PointFormat::RawF32 => raw::read_f32(&bytes),
            PointFormat::RawF64 => raw::read_f64(&bytes),
        }
    }

    /// Whether [`write`](Self::write) knows this format.
    pub fn is_written(self) -> bool {
        !matches!(self, PointFormat::Stl | PointFormat::Pcd | PointFormat::Las)
    }

    /// Writes points in this format.
    ///
    /// # Errors
    ///
    /// When `to` cannot be written; [`io::ErrorKind::Unsupported`] for the formats that are read only.
    pub fn write(self, to: impl Write, points: Points<'_>) -> io::Result<()> {
        match self {
            PointFormat::Ply => ply::write_points(to, points),
            PointFormat::Obj => obj::write_points(to, points),
            PointFormat::Text => text::write(to, points),
            PointFormat::Csv => text::write_csv(to, points),
            PointFormat::Npy => npy::write(to, points),
            PointFormat::RawF32 => raw::write_f32(to, points),
            PointFormat::RawF64 => raw::write_f64(to, points),
            PointFormat::Stl | PointFormat::Pcd | PointFormat::Las => Err(io::ErrorKind::Unsupported.into()),
        }
    }
}

impl MeshFormat {
    /// Reads a whole mesh file of this format; of TetGen's, the `.ele` file.
    ///
    /// # Errors
    ///
    /// Where the file is broken, and how.
    pub fn read(self, bytes: &[u8]) -> Result<MeshData, FormatError> {
        match self {
            MeshFormat::TetGen => Ok(MeshData { tetrahedra: tetgen::read_ele(bytes)?, neighbors: None }),
            MeshFormat::Vtu => vtu::read_vtu(bytes),
            MeshFormat::Npz => npz::read_npz(bytes),
        }
    }

    /// Reads a whole file of this format that has a mesh of the plane; of Triangle's, the `.ele` file.
    ///
    /// # Errors
    ///
    /// Where the file is broken, and how.
    pub fn read2(self, bytes: &[u8]) -> Result<MeshData2, FormatError> {
        match self {
            MeshFormat::TetGen => plane::read_ele2(bytes),
            MeshFormat::Vtu => plane::read_vtu2(bytes),
            MeshFormat::Npz => npz::read_npz2(bytes),
        }
    }
}

impl HullFormat {
    /// Writes the hull of `mesh` in this format.
    ///
    /// # Errors
    ///
    /// When `to` cannot be written.
    pub fn write(self, to: impl Write, points: Points<'_>, mesh: &Mesh3) -> io::Result<()> {
        match self {
            HullFormat::Ply => ply::write_hull_ply(to, points, mesh),
            HullFormat::Obj => obj::write_hull_obj(to, points, mesh),
            HullFormat::Stl => stl::write_hull_stl(to, points, mesh),
            HullFormat::Glb => glb::write_hull_glb(to, points, mesh),
        }
    }
}

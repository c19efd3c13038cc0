//! Tables of results: CSV and NumPy's `.npz`, and VTK's grids with a table of values per cell.

use crate::{archive, npy, npz, surface::padded, vtu};
use gdel::{Csr, Points};
use std::io::{self, Write};

/// A column of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Column {
    /// Numbers.
    Numbers(Vec<f64>),
    /// Indices; −1 where there is none.
    Indices(Vec<i64>),
    /// Lists of indices: in CSV separated by spaces, in NumPy's files as two arrays, of which
    /// `NAME_offsets` says where each list starts.
    Lists(Csr),
}

impl Column {
    /// Returns the number of rows.
    fn len(&self) -> usize {
        match self {
            Column::Numbers(numbers) => numbers.len(),
            Column::Indices(indices) => indices.len(),
            Column::Lists(lists) => lists.len(),
        }
    }
}

/// Columns with names. For CSV and VTK all must have the same number of rows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// The names, as in the first line of a CSV file, and the columns.
    pub columns: Vec<(String, Column)>,
}

impl Table {
    /// Appends a column.
    #[must_use]
    pub fn with(mut self, name: &str, column: Column) -> Self {
        self.columns.push((name.to_owned(), column));
        self
    }

    /// Appends a column for each coordinate: x, y and z, after a prefix.
    #[must_use]
    pub fn with_points<const D: usize>(mut self, prefix: &str, points: &[[f64; D]]) -> Self {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate().take(D) {
            let column = Column::Numbers(points.iter().map(|p| p[axis]).collect());
            self.columns.push((format!("{prefix}{name}"), column));
        }
        self
    }

    /// Writes the names, then one row per line. Numbers have digits enough to read them back; NaN
    /// is `nan`.
    ///
    /// # Errors
    ///
    /// Returns an error if `to` cannot be written.
    pub fn write_csv(&self, mut to: impl Write) -> io::Result<()> {
        let names: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
        writeln!(to, "{}", names.join(","))?;
        for row in 0..self.columns.first().map_or(0, |(_, column)| column.len()) {
            for (place, (_, column)) in self.columns.iter().enumerate() {
                if place > 0 {
                    write!(to, ",")?;
                }
                match column {
                    Column::Numbers(numbers) if numbers[row].is_nan() => write!(to, "nan")?,
                    Column::Numbers(numbers) => write!(to, "{:?}", numbers[row])?,
                    Column::Indices(indices) => write!(to, "{}", indices[row])?,
                    Column::Lists(lists) => {
                        for (place, index) in lists.of(row as u32).iter().enumerate() {
                            write!(to, "{}{index}", if place > 0 { " " } else { "" })?;
                        }
                    }
                }
            }
            writeln!(to)?;
        }
        Ok(())
    }

    /// Writes an array of one dimension for each column: f8 for numbers, i8 for indices.
    ///
    /// # Errors
    ///
    /// Returns an error if `to` cannot be written.
    pub fn write_npz(&self, to: impl Write) -> io::Result<()> {
        archive::write(to, |archive| {
            for (name, column) in &self.columns {
                match column {
                    Column::Numbers(numbers) => {
                        npz::array(archive, name, |to| npy::write_vector(to, "<f8", numbers, f64::to_le_bytes))?;
                    }
                    Column::Indices(indices) => {
                        npz::array(archive, name, |to| npy::write_vector(to, "<i8", indices, i64::to_le_bytes))?;
                    }
                    Column::Lists(Csr { offsets, indices, .. }) => {
                        let offset = |x: usize| (x as u64).to_le_bytes();
                        let offsets_name = format!("{name}_offsets");
                        npz::array(archive, &offsets_name, |to| npy::write_vector(to, "<u8", offsets, offset))?;
                        npz::array(archive, name, |to| npy::write_vector(to, "<u4", indices, u32::to_le_bytes))?;
                    }
                }
            }
            Ok(())
        })
    }
}

/// The type of cells of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellShape {
    /// Vertices.
    Vertex,
    /// Edges.
    Line,
    /// Triangles.
    Triangle,
    /// Polygons.
    Polygon,
    /// Tetrahedra.
    Tetrahedron,
    /// Polyhedra.
    Polyhedron,
}

impl CellShape {
    /// Returns VTK's number.
    fn vtk(self) -> u8 {
        match self {
            CellShape::Vertex => 1,
            CellShape::Line => 3,
            CellShape::Triangle => 5,
            CellShape::Polygon => 7,
            CellShape::Tetrahedron => 10,
            CellShape::Polyhedron => 42,
        }
    }
}

/// Cells with values, for VTK.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// The vertices; 2D points have *z* = 0.
    pub points: Vec<[f64; 3]>,
    /// The shape of the cells that are pushed.
    pub shape: CellShape,
    /// One row per cell. Lists are left out.
    pub values: Table,
    /// The vertices of each cell.
    cells: Csr,
    /// VTK's number of the shape of each cell.
    types: Vec<u8>,
    /// For polyhedra, what VTK calls faces, one list per cell: the number of faces, then for each
    /// face the number of its vertices and the vertices.
    faces: Csr,
}

impl Grid {
    /// Creates a grid without cells.
    pub fn new<const D: usize>(points: Points<'_, D>, shape: CellShape) -> Self {
        let points = points.iter().map(padded).collect();
        let (cells, faces) = (Csr::default(), Csr::default());
        Grid { points, shape, values: Table::default(), cells, types: Vec::new(), faces }
    }

    /// Appends a cell.
    pub fn push(&mut self, vertices: impl IntoIterator<Item = u32>) {
        append(&mut self.cells, vertices);
        self.types.push(self.shape.vtk());
    }

    /// Appends a polyhedron with the corners of its faces.
    pub fn push_polyhedron<'f>(
        &mut self,
        vertices: impl IntoIterator<Item = u32>,
        faces: impl ExactSizeIterator<Item = &'f [u32]>,
    ) {
        self.push(vertices);
        let mut stream = vec![faces.len() as u32];
        for corners in faces {
            stream.push(corners.len() as u32);
            stream.extend(corners);
        }
        append(&mut self.faces, stream);
    }

    /// Writes VTK's XML unstructured grid, with binary data appended to the XML.
    ///
    /// # Errors
    ///
    /// Returns an error if `to` cannot be written.
    pub fn write_vtu(&self, to: impl Write) -> io::Result<()> {
        let wide = |x: u64| x.to_le_bytes();
        let coordinates = self.points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        let indices = |list: &Csr| list.indices.iter().flat_map(|&v| wide(v.into())).collect();
        let ends = |list: &Csr| list.offsets[1..].iter().flat_map(|&end| wide(end as u64)).collect();
        let mut arrays = vec![
            vtu::Array::new("Points", "Points", "Float64", 3, coordinates),
            vtu::Array::new("Cells", "connectivity", "Int64", 1, indices(&self.cells)),
            vtu::Array::new("Cells", "offsets", "Int64", 1, ends(&self.cells)),
            vtu::Array::new("Cells", "types", "UInt8", 1, self.types.clone()),
        ];
        if !self.faces.is_empty() {
            arrays.push(vtu::Array::new("Cells", "faces", "Int64", 1, indices(&self.faces)));
            arrays.push(vtu::Array::new("Cells", "faceoffsets", "Int64", 1, ends(&self.faces)));
        }
        for (name, column) in &self.values.columns {
            let (kind, bytes) = match column {
                Column::Numbers(numbers) => ("Float64", numbers.iter().flat_map(|x| x.to_le_bytes()).collect()),
                Column::Indices(indices) => ("Int64", indices.iter().flat_map(|x| x.to_le_bytes()).collect()),
                Column::Lists(_) => continue,
            };
            arrays.push(vtu::Array::new("CellData", name, kind, 1, bytes));
        }
        vtu::write_arrays(to, self.points.len(), self.cells.len(), &arrays)
    }
}

/// Appends a list.
fn append(lists: &mut Csr, list: impl IntoIterator<Item = u32>) {
    lists.indices.extend(list);
    lists.offsets.push(lists.indices.len());
}

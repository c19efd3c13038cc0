//! The simplices of a tile that no point of another tile can change.

use super::{
    dim::Tiled,
    part::{self, Around, BorderFacet, Part},
    piece::Piece,
    tile::{Cloud, Tile, Triangulation},
};
use crate::{
    dimension::Dimension,
    error::Error,
    geometry::{self, Euclidean, Geometry, vector},
    index::NONE,
    parallel::{self, CHUNK, Threads},
    slots::Slots,
};
use rustc_hash::FxHashMap;
use std::{
    io::{self, Read, Write},
    iter, mem,
};

/// The simplices of a tile that no point of another tile can change, and all points of the tile.
///
/// Their circumspheres do not reach any other tile. Most simplices of a tile are such after its second step; what is left
/// is a shell, of which the points suffice for all further steps.
///
/// # Examples
///
/// ```
/// use gdel::tiles::{Core, Plan, Survey, Tile};
///
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0f64]];
/// let plan = Plan::new(Survey::<2>::new(&points, 0, 1)?, 1);
/// let mut tile = Tile::<2, 3>::new(plan, 0, points.to_vec(), vec![0, 1, 2, 3])?;
/// tile.step(Vec::new())?;
/// tile.step(Vec::new())?;
/// let core = tile.take_core()?;
/// let mut bytes = Vec::new();
/// core.write(&mut bytes)?;
/// let core = Core::read(&mut &bytes[..], bytes.len() as u64)??;
/// let piece = core.complete(tile)?;
/// assert_eq!(piece.part.simplices.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Core<const D: usize, const N: usize> {
    points: Vec<[f64; D]>,
    indices: Vec<u32>,
    duplicates: Vec<[u32; 2]>,
    /// The vertices of the simplices, which are numbers of `points`.
    simplices: Vec<[u32; N]>,
    /// 4·(simplex) + (facet as it is numbered there); [`NONE`] on the surface of the core.
    neighbors: Vec<[u32; N]>,
}

const CORE: u32 = u32::from_le_bytes(*b"gdtc");

impl<const D: usize, const N: usize> Tile<D, N>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    /// Takes the core out of a tile that has taken two steps, and [suspends](Self::suspend) it. From then on, the tile knows
    /// only the points of its shell.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`step`](Self::step) if the tile was suspended, and [`Error::BadTile`] if the core was taken
    /// before.
    pub fn take_core(&mut self) -> Result<Core<D, N>, Error> {
        self.check_whole()?;
        let threads = self.options.threads;
        let (part, triangulation) = self.end()?;
        let own = self.cloud.own as usize;
        let mut core = Core {
            points: self.cloud.points[..own].to_vec(),
            indices: self.cloud.indices[..own].to_vec(),
            duplicates: part.duplicates,
            simplices: Vec::new(),
            neighbors: Vec::new(),
        };
        self.is_shell = true;
        let Some(triangulation) = triangulation else { return Ok(core) };
        let is_final = parallel::with_threads(threads, |threads| Ok(self.final_slots(threads, &triangulation)))?;
        let mut is_shell = vec![false; own];
        for (t, _) in (0..).zip(&is_final).filter(|&(_, &is_final)| !is_final) {
            let vertices = Dimension::<D>::simplex(&triangulation, t);
            vertices.iter().flatten().filter(|&&v| v < self.cloud.own).for_each(|&v| is_shell[v as usize] = true);
        }
        [core.simplices, core.neighbors] = kept::<D, N>(triangulation, &is_final);
        self.keep(&is_shell);
        Ok(core)
    }

    /// Checks that the core was not taken.
    pub(super) fn check_whole(&self) -> Result<(), Error> {
        let taken = Error::BadTile { tile: self.number, reason: "its core was taken" };
        if self.is_shell { Err(taken) } else { Ok(()) }
    }

    /// Returns whether the simplex in each slot is surely final.
    fn final_slots(&self, threads: Threads, triangulation: &Triangulation<D>) -> Vec<bool> {
        let slots = Dimension::<D>::slots(triangulation) as usize;
        let others = (0..).zip(&self.bounds).filter(|&(tile, _)| tile != self.number);
        let others: Vec<[[f64; D]; 2]> = others.filter_map(|(_, bounds)| *bounds).collect();
        let home = self.bounds[self.number as usize];
        let parts = parallel::map_ranges(threads, slots, |range| {
            let is_final = |t| {
                let Some(simplex) = Dimension::<D>::simplex(triangulation, t as u32) else { return false };
                if simplex.iter().any(|&v| v >= self.cloud.own) {
                    return false;
                }
                let corners = simplex.map(|v| self.cloud.points[v as usize]);
                let ball = Ball::around::<N>(&corners);
                home.is_some_and(|home| ball.is_inside(home)) || others.iter().all(|&bounds| ball.is_apart(bounds))
            };
            range.map(is_final).collect::<Vec<bool>>()
        });
        parallel::joined(parts)
    }

    /// Keeps these of the tile's own points, and all of other tiles.
    fn keep(&mut self, is_kept: &[bool]) {
        let cloud = mem::take(&mut self.cloud);
        let mut number = vec![NONE; cloud.points.len()];
        let mut own = 0;
        for (v, &is_kept) in is_kept.iter().enumerate() {
            if is_kept {
                number[v] = own;
                own += 1;
            }
        }
        (own..).zip(&mut number[is_kept.len()..]).for_each(|(new, number)| *number = new);
        let kept = |v: &usize| number[*v] != NONE;
        self.cloud = Cloud {
            points: (0..cloud.points.len()).filter(kept).map(|v| cloud.points[v]).collect(),
            indices: (0..cloud.points.len()).filter(kept).map(|v| cloud.indices[v]).collect(),
            own,
            ..cloud
        };
        self.duplicate_of.clear();
        for sent in &mut self.sent {
            *sent = sent.iter().map(|&v| number[v as usize]).filter(|&v| v != NONE).collect();
        }
    }
}

/// A ball that surely contains the circumsphere of a simplex.
struct Ball<const D: usize> {
    center: [f64; D],
    radius: f64,
}

/// 2⁻⁵⁰⁰.
const SMALLEST: f64 = f64::from_bits((1023 - 500) << 52);

impl<const D: usize> Ball<D> {
    fn around<const N: usize>(corners: &[[f64; D]; N]) -> Self
    where
        Euclidean: Geometry<D, N>,
    {
        // The offset and the radius have errors of 2⁻³⁷ and 2⁻³⁶ of the radius, and the centre that of a sum.
        let (offset, radius) = geometry::circumsphere(corners);
        let center = vector::plus(corners[0], offset);
        let largest = center.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let enclosing = radius * (1.0 + 2f64.powi(-34)) + largest * 2f64.powi(-50);
        // Squares of smaller radii could underflow, of which the bounds of errors know nothing.
        Ball { center, radius: if radius > SMALLEST { enclosing } else { f64::INFINITY } }
    }

    /// Returns whether the ball is surely inside a box.
    fn is_inside(&self, [low, high]: [[f64; D]; 2]) -> bool {
        (0..D).all(|k| self.center[k] - self.radius > low[k] && self.center[k] + self.radius < high[k])
    }

    /// Returns whether the ball surely does not meet a box.
    fn is_apart(&self, [low, high]: [[f64; D]; 2]) -> bool {
        let apart: [f64; D] = std::array::from_fn(|k| (low[k] - self.center[k]).max(self.center[k] - high[k]).max(0.0));
        // Where anything overflows, this is false, as it is for numbers that are not there.
        vector::squared_norm(apart) * (1.0 - 2f64.powi(-48)) > self.radius * self.radius
    }
}

/// Returns the simplices that are kept, and their neighbours, which are the arrays of the triangulation.
fn kept<const D: usize, const N: usize>(triangulation: Triangulation<D>, is_kept: &[bool]) -> [Vec<[u32; N]>; 2]
where
    Dimension<D>: Tiled<D, N>,
{
    let mut number = vec![NONE; is_kept.len()];
    let mut count = 0;
    for (number, _) in number.iter_mut().zip(is_kept).filter(|&(_, &is_kept)| is_kept) {
        *number = count;
        count += 1;
    }
    let [mut simplices, mut neighbors] = Dimension::<D>::into_arrays(triangulation);
    // None moves to the right, so that each is still where it was when it is read.
    parallel::in_pieces(is_kept.len(), CHUNK, &mut |piece| {
        for t in piece.filter(|&t| is_kept[t]) {
            let at = number[t] as usize;
            simplices[at] = simplices[t];
            neighbors[at] = neighbors[t].map(|f| match number[(f >> 2) as usize] {
                NONE => NONE,
                other => 4 * other + (f & 3),
            });
        }
    });
    simplices.truncate(count as usize);
    neighbors.truncate(count as usize);
    [simplices, neighbors]
}

impl<const D: usize, const N: usize> Core<D, N>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    /// Returns the piece of the tile that the core was taken from, when that has taken all steps.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Tile::finish`], and [`Error::BrokenMesh`] if it is the core of another tile.
    pub fn complete(mut self, mut tile: Tile<D, N>) -> Result<Piece<D, N>, Error> {
        if !tile.is_shell {
            return Err(OTHER);
        }
        let (mut part, triangulation) = tile.end()?;
        part.duplicates = mem::take(&mut self.duplicates);
        let own = self.points.len();
        // Vertices of the shell, by their numbers among all points.
        let shell = tile.cloud.indices[..tile.cloud.own as usize].iter().map(|index| self.indices.binary_search(index));
        let names: Result<Vec<u32>, usize> = shell.map(|v| v.map(|v| v as u32)).collect();
        let Ok(mut names) = names else { return Err(OTHER) };
        names.extend((own as u32..).take(tile.cloud.owners.len()));
        if let Some(triangulation) = triangulation {
            self.enclose(&mut part, triangulation, &tile, &names)?;
        } else if !self.simplices.is_empty() {
            return Err(OTHER);
        }
        let Core { mut points, mut indices, .. } = self;
        let first = tile.cloud.own as usize;
        points.extend_from_slice(&tile.cloud.points[first..]);
        indices.extend_from_slice(&tile.cloud.indices[first..]);
        let owners: Vec<u32> = iter::repeat_n(tile.number, own).chain(tile.cloud.owners.iter().copied()).collect();
        Ok(Piece::new(tile.number, &points, &indices, &owners, part))
    }

    /// Fills a part with the core and the shell around it, of which vertex *v* becomes `names[v]`.
    fn enclose(
        &mut self,
        part: &mut Part<N>,
        triangulation: Triangulation<D>,
        tile: &Tile<D, N>,
        names: &[u32],
    ) -> Result<(), Error> {
        let (winding, vertices) = (tile.options.winding, tile.vertices());
        let (across, is_around) = self.surroundings(&triangulation, vertices.own, vertices.infinite(), names)?;
        let around = Around { is_around: &is_around, across: &across, before: self.simplices.len() as u32 };
        let of = (vertices, Some(&around));
        let numbers = part::fill::<D, N>(part, triangulation, &tile.cloud.indices, |v| names[v as usize], of, winding);
        for (&of_shell, &of_core) in &across {
            let (t, k) = ((of_core >> 2) as usize, (of_core & 3) as usize);
            let beyond = numbers[(of_shell >> 2) as usize];
            if beyond < part::GHOST {
                self.neighbors[t][k] = 4 * beyond + (of_shell & 3);
            } else if beyond == NONE {
                let facet: [u32; D] = geometry::facet(&self.simplices[t], k);
                let vertices = part::sorted(facet.map(|v| self.indices[v as usize]));
                let [place, entry] = Dimension::<D>::place(t as u32, k, winding);
                part.borders.push(BorderFacet { vertices, place, entry });
            }
        }
        let (simplices, neighbors) = (mem::take(&mut self.simplices), mem::take(&mut self.neighbors));
        let shell = mem::replace(&mut part.simplices, simplices);
        part.simplices.iter_mut().for_each(|simplex| *simplex = Dimension::<D>::to_mesh(*simplex, winding));
        part.simplices.extend(shell);
        let shell = mem::replace(&mut part.neighbors, neighbors);
        part.neighbors.iter_mut().for_each(|across| *across = Dimension::<D>::entries(*across, winding));
        part.neighbors.extend(shell);
        Ok(())
    }

    /// Returns the facets of the core by the facets of simplices of the shell that are the same; and whether the simplex in
    /// each slot is one of the shell.
    ///
    /// The points of the shell are triangulated as if there was nothing inside. All simplices of the tile that are not in the
    /// core are there, since their circumspheres are empty of all points. They fill all space around the core, and
    /// the others fill the core.
    fn surroundings(
        &self,
        triangulation: &Triangulation<D>,
        own: u32,
        infinite: u32,
        names: &[u32],
    ) -> Result<(FxHashMap<u32, u32>, Vec<bool>), Error> {
        let mut surface: FxHashMap<[u32; 3], (u32, bool)> = FxHashMap::default();
        for (t, (simplex, across)) in (0..).zip(self.simplices.iter().zip(&self.neighbors)) {
            for (k, _) in (0u32..).zip(across).filter(|&(_, &f)| f == NONE) {
                let facet: [u32; D] = geometry::facet(simplex, k as usize);
                surface.insert(part::sorted(facet), (4 * t + k, is_even(facet)));
            }
        }
        let slots = Dimension::<D>::slots(triangulation);
        let mut across = FxHashMap::default();
        let mut is_around = vec![false; slots as usize];
        let mut next = Vec::new();
        let mut visit = |t: u32, next: &mut Vec<u32>| {
            if !mem::replace(&mut is_around[t as usize], true) {
                next.push(t);
            }
        };
        for t in 0..slots {
            let Some(simplex) = Dimension::<D>::simplex(triangulation, t) else { continue };
            if Dimension::<D>::ghost_facet(simplex, infinite).is_some() {
                visit(t, &mut next);
            }
            for k in 0..N {
                let facet: [u32; D] = geometry::facet(&simplex, k);
                if facet.iter().any(|&v| v >= own) {
                    continue;
                }
                let facet = facet.map(|v| names[v as usize]);
                let key = part::sorted(facet);
                // The two sides of a facet have its vertices the other way round.
                if let Some(&(of_core, is_even_there)) = surface.get(&key)
                    && is_even_there != is_even(facet)
                {
                    surface.remove(&key);
                    across.insert(4 * t + k as u32, of_core);
                    visit(t, &mut next);
                }
            }
        }
        if !surface.is_empty() {
            return Err(OTHER);
        }
        while let Some(t) = next.pop() {
            for (k, f) in (0..).zip(triangulation.neighbors(t)) {
                if !across.contains_key(&(4 * t + k)) {
                    visit(f >> 2, &mut next);
                }
            }
        }
        Ok((across, is_around))
    }

    /// Returns the number of simplices.
    pub fn simplices(&self) -> usize {
        self.simplices.len()
    }

    /// Writes the core as bytes, the same on every machine.
    ///
    /// # Errors
    ///
    /// Returns the errors of `to`.
    pub fn write(&self, to: &mut dyn Write) -> io::Result<()> {
        let counts = [self.points.len(), self.duplicates.len(), self.simplices.len()].map(|count| count as u32);
        write_words(to, &[CORE, D as u32])?;
        write_words(to, &counts)?;
        self.points.as_flattened().iter().try_for_each(|x| to.write_all(&x.to_le_bytes()))?;
        write_words(to, &self.indices)?;
        write_words(to, self.duplicates.as_flattened())?;
        write_words(to, self.simplices.as_flattened())?;
        write_words(to, self.neighbors.as_flattened())
    }

    /// Reads a core of `size` bytes.
    ///
    /// # Errors
    ///
    /// Returns the errors of `from`; then [`Error::BadMessage`] if that is not one, or one of another dimension.
    pub fn read(from: &mut dyn Read, size: u64) -> io::Result<Result<Self, Error>> {
        let bad = |reason| Ok(Err(Error::BadMessage { reason }));
        let mut header = [0; 20];
        if size < header.len() as u64 {
            return bad("it is too short");
        }
        from.read_exact(&mut header)?;
        let [kind, dimension, points, duplicates, simplices] =
            std::array::from_fn(|i| u32::from_le_bytes(header.as_chunks::<4>().0[i]));
        if kind != CORE || dimension as usize != D {
            return bad("it is not a core of this dimension");
        }
        let promised = [(points, 8 * D + 4), (duplicates, 8), (simplices, 8 * N)];
        let promised: u64 = promised.iter().map(|&(count, bytes)| u64::from(count) * bytes as u64).sum();
        if promised + header.len() as u64 != size {
            return bad("it is not as long as it says");
        }
        let core = Core {
            points: read_rows(from, points, f64::from_le_bytes)?,
            indices: read_rows::<_, 1, 4>(from, points, u32::from_le_bytes)?.into_flattened(),
            duplicates: read_rows(from, duplicates, u32::from_le_bytes)?,
            simplices: read_rows(from, simplices, u32::from_le_bytes)?,
            neighbors: read_rows(from, simplices, u32::from_le_bytes)?,
        };
        let is_facet = |&f: &u32| f == NONE || f >> 2 < simplices && (f & 3) < N as u32;
        let are_vertices = core.simplices.as_flattened().iter().all(|&v| v < points);
        if !are_vertices || !core.neighbors.as_flattened().iter().all(is_facet) {
            return bad("its simplices have vertices or neighbors that are not there");
        }
        Ok(Ok(core))
    }
}

fn write_words(to: &mut dyn Write, words: &[u32]) -> io::Result<()> {
    let mut bytes = Vec::new();
    words.chunks(BLOCK).try_for_each(|block| {
        bytes.clear();
        bytes.extend(block.iter().flat_map(|word| word.to_le_bytes()));
        to.write_all(&bytes)
    })
}

/// So many numbers, or rows of them, are written or read at a time.
const BLOCK: usize = 1 << 12;

/// Reads rows of numbers.
fn read_rows<T, const M: usize, const SIZE: usize>(
    from: &mut dyn Read,
    count: u32,
    decode: fn([u8; SIZE]) -> T,
) -> io::Result<Vec<[T; M]>> {
    let mut rows = Vec::with_capacity(count as usize);
    let mut bytes = vec![0; BLOCK * M * SIZE];
    while rows.len() < count as usize {
        let piece = &mut bytes[..(count as usize - rows.len()).min(BLOCK) * M * SIZE];
        from.read_exact(piece)?;
        let numbers = piece.as_chunks::<SIZE>().0;
        rows.extend(numbers.chunks_exact(M).map(|row| std::array::from_fn(|k| decode(row[k]))));
    }
    Ok(rows)
}

/// Returns whether an even number of exchanges sorts the vertices of a facet.
fn is_even<const D: usize>(facet: [u32; D]) -> bool {
    let inversions = (0..D).flat_map(|i| (i + 1..D).map(move |j| (i, j))).filter(|&(i, j)| facet[i] > facet[j]);
    inversions.count() % 2 == 0
}

const OTHER: Error = Error::BrokenMesh { reason: "the core is that of another tile" };

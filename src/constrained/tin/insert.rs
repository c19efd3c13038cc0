//! Greedy insertion: the point that is farthest above or below the surface becomes a vertex, until none is too far.

use super::{TinOptions, TinStats, heights::Face, places::Places};
use crate::{
    constrained::{
        Constrained2,
        growing::{self, BROKEN, Growing, Place},
    },
    error::Error,
    index::NONE,
    input::order::mix,
    options::Options,
    parallel::{self, Threads},
    stats::Phase,
};
use std::{cmp::Reverse, collections::BinaryHeap};

/// More triangles than this have half-edges that no index can name.
const MAX_TRIANGLES: usize = i32::MAX as usize / 3;

/// The number of insertions between two reports of progress.
const REPORT: usize = 256;

/// The place that is farthest from the surface in a triangle.
#[derive(Clone, Copy, PartialEq)]
struct Worst {
    error: f64,
    place: u32,
}

/// The surface meets all places of the triangle, or there are none.
const NO_ERROR: Worst = Worst { error: 0.0, place: NONE };

/// A place, and its error in one of the triangles around a new vertex.
#[derive(Clone, Copy)]
struct Moving {
    place: u32,
    triangle: u32,
    error: f64,
}

/// A place that is too far from the surface: the bits of its error, which ascend with it, its point, its number, and its
/// triangle. Of equal errors, the one of the lowest point comes first.
type Entry = (u64, Reverse<u32>, u32, u32);

/// A surface, and the places that it is to be near to.
pub(super) struct Greedy<'a> {
    mesh: Growing,
    /// The height of each vertex.
    heights: Vec<f64>,
    places: &'a Places,
    /// The places in each triangle that are no vertices. One on an edge between triangles is in one of them.
    inside: Vec<Vec<u32>>,
    worst: Vec<Worst>,
    queue: BinaryHeap<Entry>,
    moving: Vec<Moving>,
    /// Whether each piece is a part of a constraint; the others are edges of the hull.
    is_constraint: Vec<bool>,
    max_error: f64,
    threads: Threads,
    /// The points that have become vertices, in that order.
    pub(super) inserted: Vec<u32>,
    pub(super) stats: TinStats,
}

impl<'a> Greedy<'a> {
    /// Starts with a mesh, whose `vertices` have heights, and the statistics so far.
    ///
    /// # Errors
    ///
    /// [`Error::BrokenMesh`].
    pub(super) fn new(
        threads: Threads,
        start: &Constrained2,
        vertices: &[[f64; 3]],
        places: &'a Places,
        stats: TinStats,
    ) -> Result<Self, Error> {
        let from_above = vertices.iter().map(|&[x, y, _]| [x, y]).collect();
        let mut mesh = Growing::new(&start.mesh, &start.inside, from_above)?;
        mesh.prepare_for(&places.places);
        let mut is_constraint = vec![true; start.mesh.constraints.len()];
        mesh.mark_hull();
        is_constraint.resize(mesh.edges.len(), false);
        let count = mesh.triangles.len();
        let mut greedy = Greedy {
            mesh,
            heights: vertices.iter().map(|&[_, _, z]| z).collect(),
            places,
            inside: vec![Vec::new(); count],
            worst: vec![NO_ERROR; count],
            queue: BinaryHeap::new(),
            moving: Vec::new(),
            is_constraint,
            max_error: 0.0,
            threads,
            inserted: Vec::new(),
            stats,
        };
        greedy.distribute()?;
        Ok(greedy)
    }

    /// Puts each place that is no vertex into its triangle.
    fn distribute(&mut self) -> Result<(), Error> {
        let mut is_inside = vec![false; self.mesh.points.len()];
        let inside = self.mesh.triangles.iter().filter(|triangle| triangle.is_inside);
        inside.flat_map(|triangle| triangle.vertices).for_each(|v| is_inside[v as usize] = true);
        let parts = parallel::map_ranges(self.threads, self.places.places.len(), |range| {
            let mut t = 0;
            let mut found = Vec::with_capacity(range.len());
            for i in range {
                let place = self.places.places[i];
                t = self.locate(t, place, i as u64);
                let vertices = self.mesh.triangles[t as usize].vertices;
                found.push(match vertices.iter().find(|&&v| self.mesh.point(v) == place) {
                    Some(&v) if is_inside[v as usize] => NONE,
                    Some(_) => t,
                    None => self.preferred(t, place),
                });
            }
            found
        });
        let found = parallel::joined(parts);
        let faces: Vec<Face> = (0..self.mesh.triangles.len()).map(|t| self.face(t as u32)).collect();
        let mut moving = std::mem::take(&mut self.moving);
        for (place, &triangle) in (0..).zip(&found).filter(|&(_, &t)| t != NONE) {
            match self.mesh.triangles[triangle as usize].is_inside {
                true => moving.push(Moving { place, triangle, error: 0.0 }),
                false => self.stats.outside += 1,
            }
        }
        parallel::for_chunks(self.threads, &mut moving, |_, chunk| {
            for entry in chunk {
                entry.error = self.error(entry.place, &faces[entry.triangle as usize]);
            }
        });
        self.take(&mut moving);
        self.moving = moving;
        Ok(())
    }

    /// Returns a triangle that contains a place: walks from a triangle across edges that separate it from the place, in an
    /// order by chance, since walks that prefer an edge can go in circles around constraints (Devillers, Pion and Teillaud
    /// 2002). The place is in the hull.
    fn locate(&self, from: u32, place: [f64; 2], seed: u64) -> u32 {
        let separates = |e: &u32| {
            self.mesh.orient(self.mesh.origin(*e), self.mesh.target(*e), place) < 0 && self.mesh.twin(*e) != NONE
        };
        let mut t = from;
        let mut random = mix(seed);
        for _ in 0..self.mesh.triangles.len() {
            let first = (random % 3) as u32;
            let Some(e) = (0..3).map(|k| 3 * t + (first + k) % 3).find(separates) else { return t };
            t = self.mesh.twin(e) / 3;
            random = mix(random);
        }
        // Chance goes in circles, too, if seldom.
        let contains = |t: &u32| !(3 * t..3 * t + 3).any(|e| separates(&e));
        (0..self.mesh.triangles.len() as u32).find(contains).unwrap_or(t)
    }

    /// Returns the triangle that a place on the border of one belongs to: of several, one inside, and of these the first.
    fn preferred(&self, t: u32, place: [f64; 2]) -> u32 {
        let beyond = (3 * t..3 * t + 3)
            .filter(|&e| {
                self.mesh.twin(e) != NONE && self.mesh.orient(self.mesh.origin(e), self.mesh.target(e), place) == 0
            })
            .map(|e| self.mesh.twin(e) / 3);
        let key = |&t: &u32| (!self.mesh.triangles[t as usize].is_inside, t);
        beyond.chain([t]).min_by_key(key).unwrap_or(t)
    }

    /// Returns a vertex in space.
    fn vertex(&self, v: u32) -> [f64; 3] {
        let [x, y] = self.mesh.point(v);
        [x, y, self.heights[v as usize]]
    }

    fn face(&self, t: u32) -> Face {
        Face::new(self.mesh.triangles[t as usize].vertices.map(|v| self.vertex(v)))
    }

    /// Returns how far a place is above or below a triangle.
    fn error(&self, place: u32, face: &Face) -> f64 {
        (self.places.heights[place as usize] - face.height(self.places.places[place as usize])).abs()
    }

    /// Adds places to their triangles.
    fn take(&mut self, moving: &mut Vec<Moving>) {
        for Moving { place, triangle, error } in moving.drain(..) {
            self.inside[triangle as usize].push(place);
            let name = |place: u32| self.places.names[place as usize];
            let worst = &mut self.worst[triangle as usize];
            if error > worst.error || error == worst.error && worst.place != NONE && name(place) < name(worst.place) {
                *worst = Worst { error, place };
            }
        }
    }

    /// Adds vertices until all places are as near to the surface as the options demand. There may be `most` more.
    ///
    /// # Errors
    ///
    /// [`Error::BrokenMesh`], [`Error::Cancelled`].
    pub(super) fn insert_all(&mut self, options: &TinOptions, most: usize, run: &Options) -> Result<(), Error> {
        self.max_error = options.max_error;
        (0..self.worst.len() as u32).for_each(|t| self.enqueue(t));
        let first = self.error_left();
        // The logarithm of the error falls about evenly.
        let scale = (first / self.max_error.max(first * 1e-9)).ln();
        let limit = most.min(self.places.places.len()).max(1);
        let mut done = 0.0f64;
        while let Some((bits, _, place, t)) = self.queue.pop() {
            let error = f64::from_bits(bits);
            if self.worst[t as usize] != (Worst { error, place }) {
                continue;
            }
            if self.inserted.len() >= most || self.mesh.triangles.len() + 2 > MAX_TRIANGLES {
                self.stats.limited = true;
                break;
            }
            if self.inserted.len().is_multiple_of(REPORT) {
                let by_error = (first / error).ln() / scale;
                done = done.max(by_error).max(self.inserted.len() as f64 / limit as f64).min(1.0);
                run.report(Phase::Tin, done)?;
            }
            self.insert(place, t)?;
        }
        Ok(())
    }

    /// Returns the largest error.
    pub(super) fn error_left(&self) -> f64 {
        self.worst.iter().fold(0.0, |largest, worst| largest.max(worst.error))
    }

    /// Notes a triangle with a place that is too far from it.
    fn enqueue(&mut self, t: u32) {
        let Worst { error, place } = self.worst[t as usize];
        if error > self.max_error {
            self.queue.push((error.to_bits(), Reverse(self.places.names[place as usize]), place, t));
        }
    }

    /// Makes a place in a triangle a vertex.
    fn insert(&mut self, place: u32, t: u32) -> Result<(), Error> {
        let [x, y] = self.places.places[place as usize];
        self.mesh.push([x, y]);
        self.heights.push(self.places.heights[place as usize]);
        self.inserted.push(self.places.names[place as usize]);
        let cut = match self.mesh.place(t, [x, y]) {
            Place::Triangle(t) => {
                self.mesh.dig(t)?;
                None
            }
            Place::Piece(piece) if self.mesh.dig_at(piece)? => Some(piece),
            _ => return Err(BROKEN),
        };
        let mut moving = std::mem::take(&mut self.moving);
        for &t in self.mesh.cavity() {
            let left = self.inside[t as usize].drain(..).filter(|&other| other != place);
            moving.extend(left.map(|place| Moving { place, triangle: NONE, error: 0.0 }));
        }
        match cut {
            None => self.mesh.fill(),
            Some(piece) => {
                let e = self.mesh.edges[piece as usize];
                self.mesh.fill_cut(piece, [self.mesh.origin(e), self.mesh.target(e)]);
                self.is_constraint.push(self.is_constraint[piece as usize]);
            }
        }
        let fan = Fan::new(self);
        parallel::for_chunks(self.threads, &mut moving, |_, chunk| {
            for entry in chunk {
                let i = fan.find(self, self.places.places[entry.place as usize]);
                entry.triangle = self.mesh.made[i];
                entry.error = self.error(entry.place, &fan.faces[i]);
            }
        });
        self.inside.resize_with(self.mesh.triangles.len(), Vec::new);
        self.worst.resize(self.mesh.triangles.len(), NO_ERROR);
        for &t in &self.mesh.made {
            self.worst[t as usize] = NO_ERROR;
        }
        self.take(&mut moving);
        self.moving = moving;
        (0..self.mesh.made.len()).for_each(|i| self.enqueue(self.mesh.made[i]));
        Ok(())
    }

    /// Makes the mesh the result, and returns its vertices in space.
    pub(super) fn finish(self, found: &mut Constrained2) -> Vec<[f64; 3]> {
        let mesh = &mut found.mesh;
        mesh.triangles = self.mesh.triangles.iter().map(|triangle| triangle.vertices).collect();
        mesh.halfedges = self.mesh.triangles.iter().map(|triangle| triangle.across).collect();
        found.inside = self.mesh.triangles.iter().map(|triangle| triangle.is_inside).collect();
        mesh.duplicate_of.resize(self.mesh.points.len(), NONE);
        mesh.hull = growing::hull(mesh);
        let constrained = self.mesh.edges.iter().zip(&self.is_constraint).filter(|&(_, &is_constraint)| is_constraint);
        mesh.constraints = constrained
            .map(|(&e, _)| {
                let (from, to) = (self.mesh.origin(e), self.mesh.target(e));
                [from.min(to), from.max(to)]
            })
            .collect();
        mesh.constraints.sort_unstable();
        (0..self.mesh.points.len() as u32).map(|v| self.vertex(v)).collect()
    }
}

/// The triangles around a new vertex: counter-clockwise, and on the hull not all around it.
struct Fan {
    vertex: u32,
    /// The other end of the edge at which each triangle begins, and at last, on the hull, of that at which the last one ends.
    spokes: Vec<u32>,
    is_inside: Vec<bool>,
    faces: Vec<Face>,
}

impl Fan {
    fn new(greedy: &Greedy<'_>) -> Self {
        let mesh = &greedy.mesh;
        let made = || mesh.made.iter().map(|&t| mesh.triangles[t as usize]);
        let vertex = mesh.points.len() as u32 - 1;
        let mut spokes: Vec<u32> = made().map(|triangle| triangle.vertices[1]).collect();
        let closing = made().next_back().map(|triangle| triangle.vertices[2]);
        spokes.extend(closing);
        let faces = mesh.made.iter().map(|&t| greedy.face(t)).collect();
        Fan { vertex, spokes, is_inside: made().map(|triangle| triangle.is_inside).collect(), faces }
    }

    /// Returns the triangle that contains a place in the cavity, which is not the vertex. A place on an edge belongs to the
    /// triangle that begins there, unless only the other one is inside.
    fn find(&self, greedy: &Greedy<'_>, place: [f64; 2]) -> usize {
        let count = self.faces.len();
        let side = |i: usize| greedy.mesh.orient(self.vertex, self.spokes[i], place);
        let first = side(0);
        let mut sign = first;
        for i in 0..count {
            let next = if i + 1 == count && self.spokes[count] == self.spokes[0] { first } else { side(i + 1) };
            if sign >= 0 && next < 0 {
                return if self.is_inside[i] { i } else { (i + count - 1) % count };
            }
            sign = next;
        }
        // On the edge of the hull where the last one ends.
        count - 1
    }
}

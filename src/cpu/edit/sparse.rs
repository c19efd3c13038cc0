//! A mesh of which a few simplices change: a triangulation with ghosts that has copies of the
//! simplices that are looked at, so that the work does not depend on the size of the mesh.

use crate::{
    cpu::{
        MeshOf,
        edit::{
            dim::Edit,
            patch::{Patch, Row},
        },
    },
    dimension::Dimension,
    error::Error,
    index::NONE,
    options::Winding,
    predicates::filter::PredicateContext,
    slots::{MarkedSlots, Places, Slots},
};
use rustc_hash::{FxHashMap, FxHashSet};
use std::cell::RefCell;

/// The hull of a mesh.
pub type HullOf<const D: usize, const N: usize> = <Dimension<D> as Edit<D, N>>::Hull;

/// The two highest bits of the first vertex are for marks.
const MARKS: u32 = 3 << 30;

/// The largest number of looks at simplices, by their number, while one vertex is inserted or removed.
/// Every Delaunay triangulation needs fewer.
const FUEL: usize = 64;

/// A slot that has been looked at.
#[derive(Clone, Copy)]
struct Slot<const N: usize> {
    /// The vertices; [`NONE`] in a slot that is not used.
    simplex: [u32; N],
    /// The neighbours. Those of ghosts are [`NONE`] until they are asked for, except for the
    /// simplex inside.
    neighbors: [u32; N],
    /// Whether the mesh has other vertices or neighbours here.
    has_changed: bool,
}

impl<const N: usize> Slot<N> {
    /// Placeholder in a mesh that is broken: a simplex that contains nothing.
    const NONE: Slot<N> = Slot { simplex: [0; N], neighbors: [0; N], has_changed: false };

    fn vertices(&self) -> [u32; N] {
        let mut vertices = self.simplex;
        vertices[0] &= !MARKS;
        vertices
    }

    fn is_used(&self) -> bool {
        self.simplex[0] != NONE
    }

    /// Returns whether this is a simplex of the mesh.
    fn is_finite(&self, infinite: u32) -> bool {
        self.is_used() && !self.vertices().contains(&infinite)
    }
}

/// The slots that have been looked at or changed.
struct State<const N: usize> {
    /// Simplices of the mesh, by their numbers.
    slots: FxHashMap<u32, Slot<N>>,
    /// The slots after those of the mesh: ghosts, and what is new.
    more: Vec<Slot<N>>,
    /// Slots that are not used.
    free: Vec<u32>,
    /// The ghosts that the mesh had on its hull, as far as they have been looked at.
    hull: Vec<[u32; N]>,
    /// The slots that were filled by the insertion or removal that is going on.
    filled: Vec<u32>,
    /// The number of looks at simplices that it has left.
    fuel: usize,
    /// Whether the mesh has turned out not to be the triangulation of its points.
    is_broken: bool,
}

/// A mesh with changes that are not applied to it yet.
pub struct Sparse<'m, 'p, const D: usize, const N: usize>
where
    Dimension<D>: Edit<D, N>,
{
    mesh: &'m MeshOf<D>,
    vertices: &'m PredicateContext<'p, D>,
    winding: Winding,
    infinite: u32,
    /// The number of simplices of the mesh.
    count: u32,
    /// Looking at something copies it.
    state: RefCell<State<N>>,
}

impl<'m, 'p, const D: usize, const N: usize> Sparse<'m, 'p, D, N>
where
    Dimension<D>: Edit<D, N>,
{
    /// Looks at a mesh of the vertices, whose simplices have this orientation.
    pub(crate) fn new(mesh: &'m MeshOf<D>, vertices: &'m PredicateContext<'p, D>, winding: Winding) -> Self {
        let count = Dimension::<D>::count(mesh);
        let state = State {
            slots: FxHashMap::default(),
            more: Vec::new(),
            free: Vec::new(),
            hull: Vec::new(),
            filled: Vec::new(),
            fuel: FUEL.saturating_mul(count + FUEL),
            is_broken: false,
        };
        let infinite = vertices.len() as u32;
        Sparse { mesh, vertices, winding, infinite, count: count as u32, state: RefCell::new(state) }
    }

    /// Returns the mesh.
    pub(crate) fn mesh(&self) -> &'m MeshOf<D> {
        self.mesh
    }

    /// Returns the vertices of simplex `t`.
    pub(crate) fn corners(&self, t: u32) -> [u32; N] {
        self.with(t, |slot| slot.vertices())
    }

    /// Ends an insertion or a removal. Returns whether what it has made is positively oriented, and
    /// the mesh, as far as it has been looked at, a triangulation.
    pub(crate) fn is_sound(&mut self) -> bool {
        let state = self.state.get_mut();
        state.fuel = FUEL.saturating_mul(self.count as usize + FUEL);
        let filled = std::mem::take(&mut state.filled);
        let is_positive = |t: u32| {
            let slot = self.with(t, |slot| *slot);
            !slot.is_finite(self.infinite) || Dimension::<D>::is_positive(self.vertices, slot.vertices())
        };
        filled.into_iter().all(is_positive) && !self.state.borrow().is_broken
    }

    /// Has `work` look at slot `t`, or change it.
    fn with<R>(&self, t: u32, work: impl FnOnce(&mut Slot<N>) -> R) -> R {
        let state = &mut *self.state.borrow_mut();
        if t < self.count && !state.slots.contains_key(&t) {
            self.load(state, t);
        }
        let slot = if t < self.count { state.slots.get_mut(&t) } else { state.more.get_mut((t - self.count) as usize) };
        match slot {
            Some(slot) => work(slot),
            None => {
                state.is_broken = true;
                work(&mut Slot::NONE.clone())
            }
        }
    }

    /// Copies a simplex of the mesh, with ghosts on its facets on the hull.
    fn load(&self, state: &mut State<N>, t: u32) {
        let Some((simplex, mut neighbors)) = self.row(t) else {
            state.is_broken = true;
            return;
        };
        for (k, across) in neighbors.iter_mut().enumerate() {
            if *across == NONE {
                let ghost = Dimension::<D>::ghost(simplex, k, self.infinite);
                let mut inside = [NONE; N];
                inside[N - 1] = 4 * t + k as u32;
                *across = 4 * (self.count + state.more.len() as u32) + (N - 1) as u32;
                state.more.push(Slot { simplex: ghost, neighbors: inside, has_changed: false });
                state.hull.push(ghost);
            }
        }
        state.slots.insert(t, Slot { simplex, neighbors, has_changed: false });
    }

    /// Returns a simplex as the mesh has it; `None` if it cannot be one of a triangulation.
    fn row(&self, t: u32) -> Option<Row<N>> {
        let (simplex, neighbors) = Dimension::<D>::row(self.mesh, self.winding, t)?;
        let is_simplex = simplex.iter().all(|&v| v < self.infinite);
        if !is_simplex || !Dimension::<D>::is_positive(self.vertices, simplex) {
            return None;
        }
        for (k, across) in neighbors.into_iter().enumerate().filter(|&(_, across)| across != NONE) {
            let other = Dimension::<D>::beyond(self.mesh, self.winding, 4 * t + k as u32, across)?;
            // The same facet, seen from the other side.
            let is_shared = (0..N).all(|i| i == k || other.contains(&simplex[i]));
            if !is_shared || simplex.contains(&other[(across & 3) as usize]) {
                return None;
            }
        }
        Some((simplex, neighbors))
    }

    /// Returns the neighbour of ghost `t` across the facet opposite its vertex `s`, found around the
    /// ridge that both have on the hull.
    fn around(&self, t: u32, s: usize) -> u32 {
        let broken = || {
            self.state.borrow_mut().is_broken = true;
            0
        };
        let ghost = self.with(t, |slot| *slot);
        let corner = |t: u32, v: u32| self.corners(t).iter().position(|&w| w == v);
        let Some(at_infinity) = corner(t, self.infinite) else { return broken() };
        let inside = ghost.neighbors[at_infinity];
        // The corners of the simplex that the ridge lacks: one opposite the facet that was come
        // through, and one opposite that which is gone through.
        let (mut at, mut entered) = (inside >> 2, (inside & 3) as usize);
        let Some(mut leave) = corner(at, ghost.vertices()[s]) else { return broken() };
        let max = self.count as usize + self.state.borrow().more.len();
        for _ in 0..=max {
            let Some(&lacks) = self.corners(at).get(entered) else { break };
            let across = self.with(at, |slot| slot.neighbors[leave]);
            if across == NONE {
                break;
            }
            (at, entered) = (across >> 2, (across & 3) as usize);
            let Some(place) = corner(at, lacks) else { break };
            if self.corners(at).contains(&self.infinite) {
                return 4 * at + place as u32;
            }
            leave = place;
        }
        broken()
    }

    /// Returns what is to be changed of the mesh; `None` if it is not a triangulation.
    pub(crate) fn into_patch(self) -> Option<Patch<N, HullOf<D, N>>> {
        let (count, infinite) = (self.count, self.infinite);
        let finite = |slot: &Slot<N>| slot.is_finite(infinite);
        let (mut gaps, mut movers) = (Vec::new(), Vec::new());
        {
            let state = self.state.borrow();
            gaps.extend(state.slots.iter().filter(|(_, slot)| !finite(slot)).map(|(&t, _)| t));
            movers.extend((count..).zip(&state.more).filter(|(_, slot)| finite(slot)).map(|(t, _)| t));
        }
        gaps.sort_unstable();
        let new_count = count + movers.len() as u32 - gaps.len() as u32;
        gaps.extend(count..new_count);
        // Simplices beyond the new end move into the gaps before it.
        let beyond = new_count.min(count)..count;
        movers.extend(beyond.filter(|&t| self.with(t, |slot| finite(slot))));
        gaps.truncate(gaps.partition_point(|&t| t < new_count));
        let places: FxHashMap<u32, u32> = movers.iter().copied().zip(gaps).collect();
        // Their neighbours learn of it.
        for &t in &movers {
            for across in self.with(t, |slot| slot.neighbors) {
                self.with(across >> 2, |slot| slot.has_changed = true);
            }
            self.with(t, |slot| slot.has_changed = true);
        }
        let state = self.state.into_inner();
        if state.is_broken || places.len() != movers.len() {
            return None;
        }
        let slot = |t: u32| if t < count { state.slots.get(&t) } else { state.more.get((t - count) as usize) };
        let place = |t: u32| places.get(&t).copied().unwrap_or(t);
        let across = |facet: u32| match slot(facet >> 2) {
            Some(slot) if !finite(slot) => NONE,
            _ => 4 * place(facet >> 2) + (facet & 3),
        };
        let all = state.slots.iter().map(|(&t, slot)| (t, slot)).chain((count..).zip(&state.more));
        let rows = all
            .clone()
            .filter(|(_, slot)| slot.has_changed && finite(slot))
            .map(|(t, slot)| (place(t), (slot.vertices(), slot.neighbors.map(across))))
            .collect();

        let sorted = |ghost: &[u32; N]| {
            let mut ghost = *ghost;
            ghost.sort_unstable();
            ghost
        };
        let ghosts = all.filter(|(_, slot)| slot.is_used() && !finite(slot)).map(|(_, slot)| slot.vertices());
        let ghosts: FxHashMap<[u32; N], [u32; N]> = ghosts.map(|ghost| (sorted(&ghost), ghost)).collect();
        let before: FxHashSet<[u32; N]> = state.hull.iter().map(sorted).collect();
        let removed: FxHashSet<[u32; N]> =
            before.iter().filter(|ghost| !ghosts.contains_key(*ghost)).copied().collect();
        let added: Vec<[u32; N]> =
            ghosts.iter().filter(|(key, _)| !before.contains(*key)).map(|(_, &ghost)| ghost).collect();
        let hull = match removed.is_empty() && added.is_empty() {
            true => None,
            false => Some(Dimension::<D>::hull(self.mesh, &removed, added, infinite, self.winding)?),
        };
        Some(Patch { count: new_count as usize, rows, hull })
    }
}

impl<const D: usize, const N: usize> Slots<N> for Sparse<'_, '_, D, N>
where
    Dimension<D>: Edit<D, N>,
{
    const SHARED: bool = false;

    fn infinite(&self) -> u32 {
        self.infinite
    }

    fn simplex(&self, t: u32) -> [u32; N] {
        {
            let state = &mut *self.state.borrow_mut();
            match state.fuel.checked_sub(1) {
                Some(fuel) if !state.is_broken => state.fuel = fuel,
                // A walk ends at a simplex that contains nothing.
                _ => {
                    state.is_broken = true;
                    return [0; N];
                }
            }
        }
        self.with(t, |slot| slot.simplex)
    }

    fn set_simplex(&mut self, t: u32, vertices: [u32; N]) {
        self.with(t, |slot| (slot.simplex, slot.has_changed) = (vertices, true));
        self.state.get_mut().filled.push(t);
    }

    fn neighbors(&self, t: u32) -> [u32; N] {
        let mut neighbors = self.with(t, |slot| slot.neighbors);
        for (s, neighbor) in neighbors.iter_mut().enumerate().filter(|(_, neighbor)| **neighbor == NONE) {
            *neighbor = self.around(t, s);
            self.with(t, |slot| slot.neighbors[s] = *neighbor);
        }
        neighbors
    }

    fn set_neighbors(&mut self, t: u32, neighbors: [u32; N]) {
        self.with(t, |slot| (slot.neighbors, slot.has_changed) = (neighbors, true));
    }

    fn set_neighbor(&mut self, facet: u32, across: u32) {
        self.with(facet >> 2, |slot| {
            if let Some(neighbor) = slot.neighbors.get_mut(facet as usize & 3) {
                *neighbor = across;
            }
            slot.has_changed = true;
        });
    }

    fn push(&mut self) -> Result<u32, Error> {
        let state = self.state.get_mut();
        if let Some(slot) = state.free.pop() {
            return Ok(slot);
        }
        let (slots, limit) = (self.count as usize + state.more.len(), Dimension::<D>::MAX_SIMPLICES);
        if slots >= limit {
            return Err(Error::TooManySimplices { limit });
        }
        state.more.push(Slot { simplex: [NONE; N], ..Slot::NONE });
        Ok(slots as u32)
    }

    fn has_room(&mut self, _slots: usize) -> bool {
        true
    }

    fn claim(&mut self, _v: u32) -> bool {
        true
    }

    fn discard(&mut self, t: u32) {
        self.with(t, |slot| (slot.simplex, slot.has_changed) = ([NONE; N], true));
        self.state.get_mut().free.push(t);
    }
}

impl<const D: usize, const N: usize> MarkedSlots<N> for Sparse<'_, '_, D, N>
where
    Dimension<D>: Edit<D, N>,
{
    type Places = SparsePlaces;

    fn first(&self, t: u32) -> u32 {
        self.simplex(t)[0]
    }

    fn set_first(&mut self, t: u32, first: u32) {
        self.with(t, |slot| slot.simplex[0] = first);
    }

    fn first_and(&self, t: u32, k: usize) -> [u32; 2] {
        let simplex = self.simplex(t);
        [simplex[0], simplex[k % N]]
    }

    fn places(&self) -> SparsePlaces {
        SparsePlaces::default()
    }
}

/// The numbers of the vertices that have one.
#[derive(Default)]
pub struct SparsePlaces(FxHashMap<u32, u32>);

impl Places for SparsePlaces {
    fn place(&self, v: u32) -> u32 {
        self.0.get(&v).copied().unwrap_or(0)
    }

    fn set_place(&mut self, v: u32, place: u32) {
        self.0.insert(v, place);
    }
}

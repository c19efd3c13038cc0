"""The alpha complex of balls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from gdel._points import Indices

if TYPE_CHECKING:
    from gdel._delaunay import Delaunay


@dataclass(frozen=True)
class BallComplex:
    """The alpha complex of balls: where they meet. `Delaunay.ball_complex` returns it.

    Each face has one row, with the indices of its vertices. Facets are triangles in 3D; in 2D they are the edges.
    """

    tri: Delaunay
    alpha: float
    """The number whose square was added to all weights, in the unit of the coordinates."""
    solid: Indices
    """The indices of the simplices that are part of the complex, in ascending order."""
    surface: Indices
    """The facets of the boundary of these simplices, oriented outwards, which `AlphaShape` calls `facets`. Of points in
    a plane of 3D, or on a line of 2D, all facets of the complex, from both sides."""
    facets: Indices
    """All facets that are part of the complex, oriented as seen from outside the simplex with the lower index."""
    edges: Indices
    """All edges that are part of the complex, the lower vertex first, in ascending order."""
    vertices: Indices
    """All points that are part of the complex, in ascending order."""
    singular_facets: Indices
    """The facets that belong to no simplex of the complex."""
    singular_edges: Indices
    """The edges that belong to no larger face of the complex."""
    singular_vertices: Indices
    """The points that belong to no larger face of the complex: balls that meet no other one."""
    components: int
    """The number of components, which is that of the union of the balls."""
    component_of: Indices
    """The component of each point, counted from 0 in the order of their lowest points; −1 for points that are no part
    of the complex."""

    def __repr__(self) -> str:
        """Return a short description."""
        faces = [(self.vertices, "vertices"), (self.edges, "edges")]
        if self.tri.ndim == 3:
            faces.append((self.facets, "triangles"))
        faces.append((self.solid, "simplices"))
        counts = ", ".join(f"{len(rows)} {name}" for rows, name in faces)
        return f"<gdel.BallComplex: {counts}, {self.components} components>"

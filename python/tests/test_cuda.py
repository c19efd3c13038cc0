"""Tensors in CUDA memory. What needs a GPU of NVIDIA and PyTorch is skipped elsewhere."""

import sys

import numpy as np
import pytest

import gdel

cuda = pytest.importorskip("gdel.cuda") if sys.platform == "linux" else None
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="for Linux")

try:
    import torch

    has_cuda = torch.cuda.is_available()
except ImportError:
    has_cuda = False
needs_cuda = pytest.mark.skipif(not has_cuda, reason="needs PyTorch and a GPU of NVIDIA")


class Array:
    """An object with a CUDA array interface."""

    def __init__(self, **entries):
        self.__cuda_array_interface__ = {
            "shape": (5, 3),
            "typestr": "<f4",
            "data": (4096, False),
            "version": 3,
            **entries,
        }


class TestWrongInput:
    def test_memory_of_the_host(self):
        with pytest.raises(TypeError, match=r"must be in CUDA memory; gdel\.Delaunay takes"):
            cuda.Delaunay(np.zeros((5, 3), np.float32))

    def test_lists(self):
        with pytest.raises(TypeError, match="a tensor in CUDA memory, not list"):
            cuda.Delaunay([(0, 0, 0)])

    @pytest.mark.parametrize("kind", ["<f2", "<i4", ">f4", "<c8"])
    def test_other_types(self, kind):
        with pytest.raises(TypeError, match="must be float32 or float64"):
            cuda.Delaunay(Array(typestr=kind))

    @pytest.mark.parametrize("shape", [(), (5,), (5, 1), (5, 4), (5, 3, 1)])
    def test_other_shapes(self, shape):
        with pytest.raises(ValueError, match=r"must have the shape \(n, 2\) or \(n, 3\), not \["):
            cuda.Delaunay(Array(shape=shape))

    def test_strides(self):
        with pytest.raises(ValueError, match="must be contiguous"):
            cuda.Delaunay(Array(strides=(24, 4)))

    @pytest.mark.parametrize("entry", ["shape", "typestr", "data"])
    def test_missing_entries(self, entry):
        array = Array()
        del array.__cuda_array_interface__[entry]
        with pytest.raises(ValueError, match=f'has no "{entry}"'):
            cuda.Delaunay(array)

    @pytest.mark.skipif(has_cuda, reason="for machines without CUDA")
    def test_no_cuda(self):
        with pytest.raises(RuntimeError, match=r"libcuda\.so, cannot be loaded"):
            cuda.Delaunay(Array())

    @needs_cuda
    def test_an_address_that_is_none(self):
        with pytest.raises(RuntimeError, match="CUDA"):
            cuda.Delaunay(Array())


def points_of(count, columns, kind="float32"):
    return np.random.default_rng(count).random((count, columns)).astype(kind)


def canonical(simplices):
    """Return the simplices in an order of their own."""
    ordered = np.sort(np.asarray(simplices), axis=1)
    return ordered[np.lexsort(ordered.T[::-1])]


def tri_of(tensor, **options):
    return __import__("gdel.torch").torch.Delaunay(tensor, **options)


@needs_cuda
class TestTensors:
    @pytest.mark.parametrize("backend", ["gpu", "cpu", "auto"])
    @pytest.mark.parametrize("kind", ["float32", "float64"])
    @pytest.mark.parametrize("columns", [2, 3])
    def test_the_mesh_is_that_of_the_host(self, columns, kind, backend):
        points = points_of(20_000, columns, kind)
        tri = tri_of(torch.tensor(points, device="cuda"), backend=backend)
        expected = gdel.Delaunay(points)
        assert tri.indices.is_cuda and tri.indices.dtype == torch.int32
        assert np.array_equal(canonical(tri.indices.cpu()), canonical(expected.simplices))
        assert (tri.npoints, tri.ndim, tri.dimension) == (20_000, columns, columns)
        assert tri.nsimplex == len(tri.indices) == len(expected.simplices)
        assert len(tri.hull) == len(expected.convex_hull)

    @pytest.mark.parametrize("columns", [2, 3])
    def test_neighbors_are_opposite_their_vertices(self, columns):
        tri = tri_of(torch.rand(5000, columns, device="cuda"))
        simplices, neighbors = tri.indices.long(), tri.neighbors.long()
        for k in range(columns + 1):
            inside = neighbors[:, k] >= 0
            facet = torch.cat([simplices[inside, :k], simplices[inside, k + 1 :]], dim=1)
            other = simplices[neighbors[inside, k]]
            assert (facet[:, :, None] == other[:, None, :]).any(dim=2).all()
            assert not (simplices[inside, k, None] == other).any()
        assert int((neighbors < 0).sum()) == len(tri.hull)

    @pytest.mark.parametrize("columns", [2, 3])
    def test_adjacency_and_vertices(self, columns):
        points = points_of(3000, columns)
        points[7] = points[5]
        tri, expected = tri_of(torch.tensor(points, device="cuda")), gdel.Delaunay(points)
        offsets, indices = tri.adjacency
        indptr, neighbors = expected.vertex_neighbor_vertices
        assert np.array_equal(offsets.cpu(), indptr) and np.array_equal(indices.cpu(), neighbors)
        assert list(tri.duplicate_of[:8]) == [-1] * 7 + [5]
        of_vertex = tri.vertex_to_simplex.long()
        assert of_vertex[7] == -1
        vertices = torch.arange(3000, device="cuda")[of_vertex >= 0]
        assert (tri.indices[of_vertex[vertices]] == vertices[:, None]).any(dim=1).all()

    @pytest.mark.parametrize("columns", [2, 3])
    def test_updates_and_survivors(self, columns):
        points = torch.rand(20_000, columns, device="cuda")
        tri = tri_of(points)
        assert tri.survivors is None
        first = tri.indices
        before = first.clone()
        for _ in range(3):
            old = tri.indices
            points = points + 1e-4 * torch.randn_like(points)
            tri.update(points)
            survivors = tri.survivors.long()
            survived = survivors >= 0
            kept = tri.indices[survived].sort(dim=1).values
            assert torch.equal(kept, old[survivors[survived]].sort(dim=1).values)
            keys = [set(map(tuple, array.sort(dim=1).values.tolist())) for array in (old, tri.indices)]
            assert int(survived.sum()) == len(keys[0] & keys[1]) > len(old) // 2
            expected = gdel.Delaunay(points.cpu().numpy())
            assert np.array_equal(canonical(tri.indices.cpu()), canonical(expected.simplices))
        # Arrays outlive updates.
        assert torch.equal(first, before)

    def test_grids_spheres_and_flat_points(self):
        grid = torch.cartesian_prod(*[torch.arange(12.0, device="cuda")] * 3)
        assert tri_of(grid).nsimplex == gdel.Delaunay(grid.cpu().numpy()).nsimplex
        sphere = torch.nn.functional.normalize(torch.randn(5000, 3, device="cuda", dtype=torch.float64), dim=1)
        assert tri_of(sphere).nsimplex == gdel.Delaunay(sphere.cpu().numpy()).nsimplex
        flat = tri_of(grid * torch.tensor([1.0, 1.0, 0.0], device="cuda"))
        assert (flat.nsimplex, flat.dimension, tuple(flat.indices.shape)) == (0, 2, (0, 4))
        empty = tri_of(torch.empty(0, 3, device="cuda"))
        assert (empty.nsimplex, empty.npoints) == (0, 0)

    def test_gradients_strides_and_half_precision(self):
        points = torch.rand(1000, 3, device="cuda", requires_grad=True)
        assert tri_of(points).nsimplex == tri_of(points.t().contiguous().t()).nsimplex
        half = points.detach().half()
        assert tri_of(half).nsimplex == gdel.Delaunay(half.float().cpu().numpy()).nsimplex

    def test_work_that_has_not_ended(self):
        stream = torch.cuda.Stream()
        with torch.cuda.stream(stream):
            points = torch.rand(2000, 2000, device="cuda")
            for _ in range(30):
                points = (points @ points).fmod(1.0)
            points = points[:, :3].contiguous()
            tri = tri_of(points)
        assert tri.nsimplex == gdel.Delaunay(points.cpu().numpy()).nsimplex

    def test_arrays_of_any_library(self):
        points = torch.rand(1000, 3, device="cuda")
        tri = cuda.Delaunay(points)
        assert tri.indices.shape == (tri.nsimplex, 4)
        assert tri.indices.__dlpack_device__() == (2, 0)
        assert torch.equal(torch.from_dlpack(tri.indices), torch.as_tensor(tri.indices, device="cuda"))
        by_interface = Array(data=(points.data_ptr(), False), shape=(1000, 3), stream=1)
        assert cuda.Delaunay(by_interface).nsimplex == tri.nsimplex

    def test_wrong_tensors(self):
        with pytest.raises(TypeError, match="must be a tensor of PyTorch, not ndarray"):
            tri_of(np.zeros((5, 3)))
        with pytest.raises(TypeError, match="must be in CUDA memory"):
            tri_of(torch.zeros(5, 3))
        with pytest.raises(TypeError, match="float32 or float64"):
            tri_of(torch.zeros(5, 3, device="cuda", dtype=torch.int32))
        tri = tri_of(torch.rand(5, 3, device="cuda"))
        with pytest.raises(ValueError, match="5"):
            tri.update(torch.rand(6, 3, device="cuda"))
        with pytest.raises(ValueError, match="2 coordinates per point, not 3"):
            tri.update(torch.rand(5, 2, device="cuda"))
        broken = torch.rand(5, 3, device="cuda")
        broken[3, 1] = float("nan")
        with pytest.raises(ValueError, match="3"):
            tri.update(broken)
        assert tri.nsimplex > 0

    def test_memory_is_freed(self):
        points = torch.rand(200_000, 3, device="cuda")
        for _ in range(4):
            tri = tri_of(points)
            _ = tri.indices, tri.neighbors, tri.adjacency
        before = torch.cuda.mem_get_info()[0]
        for _ in range(12):
            tri = tri_of(points)
            _ = tri.indices, tri.neighbors, tri.adjacency
        assert before - torch.cuda.mem_get_info()[0] < 100 << 20

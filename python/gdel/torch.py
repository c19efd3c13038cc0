"""Triangulations of PyTorch's CUDA tensors, whose arrays are CUDA tensors: NVIDIA's GPUs under Linux.

>>> import torch, gdel.torch  # doctest: +SKIP
>>> xyz = torch.rand(200_000, 3, device="cuda")  # doctest: +SKIP
>>> tri = gdel.torch.Delaunay(xyz)  # doctest: +SKIP
>>> tri.indices.shape, tri.indices.device  # doctest: +SKIP
(torch.Size([1350312, 4]), device(type='cuda', index=0))
>>> tri.update(xyz + 1e-4 * torch.randn_like(xyz))  # doctest: +SKIP
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import torch

from gdel import _gdel
from gdel.cuda import Triangulation

__all__ = ["Delaunay"]


class Delaunay(Triangulation[torch.Tensor]):
    """The Delaunay triangulation of a CUDA tensor.

    Parameters
    ----------
    points
        A tensor of the shape (n, 2) or (n, 3) in CUDA memory. What is not contiguous, and half precision, is copied
        first, exactly. Gradients are not followed.
    backend
        ``"auto"`` takes the GPU where it is faster, ``"cpu"`` and ``"gpu"`` force one.
    progress
        A callable of the phase and the share that is done, or `True` for tqdm. It may raise to stop the run.

    Arrays are tensors of `int32` on the same GPU, ready when they are returned.
    """

    @staticmethod
    def _tensor(points: Any) -> Any:
        """Return what is triangulated for what the caller has passed."""
        if not isinstance(points, torch.Tensor):
            raise TypeError(f"points must be a tensor of PyTorch, not {type(points).__name__}")
        points = points.detach()
        return (points.float() if points.dtype in (torch.float16, torch.bfloat16) else points).contiguous()

    @staticmethod
    def _converter(tensor: Any) -> Callable[[_gdel.MeshArray], torch.Tensor]:
        """Return what makes the caller's arrays, on the GPU of a tensor."""
        device = tensor.device

        def convert(array: _gdel.MeshArray) -> torch.Tensor:
            # In PyTorch's memory, which it keeps for the next tensor.
            copy = torch.empty(array.shape, dtype=torch.int32, device=device)
            array.copy_into(copy, torch.cuda.current_stream(device).cuda_stream)
            return copy

        return convert

    @property
    def neighbors(self) -> torch.Tensor:
        """The simplices opposite the vertices of each simplex; −1 outside."""
        if self.ndim == 3:
            return self._state.links
        # Half-edge k is opposite vertex k + 2. Those outside are −1, which rounds down to −1.
        return torch.div(self._state.links, 3, rounding_mode="floor").roll(-1, dims=1)

# SPDX-License-Identifier: Apache-2.0
"""Meshes and their poses as arrays."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._library import doubles
from .errors import Error


class Pose(NamedTuple):
    """A rigid placement: `position` (3,) in m, `orientation` (4,), a unit quaternion w, x, y, z."""

    position: np.ndarray
    orientation: np.ndarray

    @property
    def matrix(self) -> np.ndarray:
        """(4, 4): rotation and translation, for columns of homogeneous coordinates in m."""
        w, x, y, z = self.orientation
        made = np.eye(4)
        made[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
        made[:3, 3] = self.position
        return made

    def apply(self, points: ArrayLike) -> np.ndarray:
        """Points (n, 3) or (3,), m, moved by the pose."""
        return np.asarray(points) @ self.matrix[:3, :3].T + self.position


def mesh_of(given: tuple[ArrayLike, ArrayLike], what: str) -> tuple[_library.Mesh, list[np.ndarray]]:
    """A mesh for the library, and the arrays that must outlive it. Raises Error."""
    try:
        vertices, triangles = (np.asarray(part) for part in given)
    except (TypeError, ValueError):
        raise Error(f"the {what} mesh is no pair of arrays; give (vertices, triangles)") from None
    for array, kinds, content, name in ((vertices, "fiu", "numbers", "vertices"),
                                        (triangles, "iu", "integers", "triangles")):
        if array.ndim != 2 or array.shape[1] != 3:
            raise Error(f"the {name} of the {what} mesh have the shape {array.shape}; give (n, 3)")
        if array.dtype.kind not in kinds:
            raise Error(f"the {name} of the {what} mesh hold {array.dtype}, not {content}")
    if triangles.size and not 0 <= int(triangles.min()) <= int(triangles.max()) < len(vertices):
        raise Error(f"the triangles of the {what} mesh have vertices from {triangles.min()} to {triangles.max()}; "
                    f"there are {len(vertices)}")
    vertices = np.ascontiguousarray(vertices, np.float64)
    triangles = np.ascontiguousarray(triangles, np.int32)
    indices = triangles.ctypes.data_as(ctypes.POINTER(ctypes.c_int32))
    return _library.Mesh(doubles(vertices), len(vertices), indices, len(triangles)), [vertices, triangles]

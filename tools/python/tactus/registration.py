# SPDX-License-Identifier: Apache-2.0
"""Registration of meshes in memory, by libtactus. It releases the interpreter's lock."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._library import call, doubles
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


class Registration(NamedTuple):
    """What `tactus register` finds."""

    #: "fit": clearly better than any other pose; "ambiguous": another one is about as good; "none": no pose fits
    verdict: str
    pose: Pose  #: of the moving mesh in the frame of the fixed one
    rms: float  #: m, of the distances of both surfaces, each limited; if one is a part of the other, only of the part's
    median: float  #: m, of the distances of the moving vertices from the fixed surface
    p90: float  #: m, of these distances: 90 % are smaller
    covered: float  #: 0 to 1: moving vertices within 2 mm of the fixed surface
    rival: Pose | None  #: the best other pose; None: none was found
    rival_rms: float  #: m, of the rival; inf: none was found


def _mesh(given: tuple[ArrayLike, ArrayLike], what: str) -> tuple[_library.Mesh, list[np.ndarray]]:
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


def register(moving: tuple[ArrayLike, ArrayLike], fixed: tuple[ArrayLike, ArrayLike], *,
             anywhere: bool = False) -> Registration:
    """The rigid pose that brings a mesh onto another one of the same shape, or of a part of it.

    A mesh is (vertices, triangles): (n, 3) in m and (m, 3) indices from 0, counter-clockwise seen from outside.
    Triangles share vertices; the surface need not be closed. It is 1 mm to 5 m across. The search starts from all
    alignments of the principal axes; of poses that fit equally well it returns the one nearest to the given coordinates,
    unless `anywhere`. Takes seconds. Raises Error."""
    first, kept = _mesh(moving, "moving")
    second, also_kept = _mesh(fixed, "fixed")
    found = _library.Registration()
    call("register", ctypes.byref(first), ctypes.byref(second), int(anywhere), ctypes.byref(found))
    del kept, also_kept  # the library read them until here
    rival = None
    if np.isfinite(found.rival_rms):
        rival = Pose(np.array(found.rival_position), np.array(found.rival_orientation))
    return Registration(found.verdict.decode(), Pose(np.array(found.position), np.array(found.orientation)), found.rms,
                        found.median, found.p90, found.covered, rival, found.rival_rms)

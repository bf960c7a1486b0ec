# SPDX-License-Identifier: Apache-2.0
"""Registration of meshes in memory, by libtactus. It releases the interpreter's lock."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._library import call
from .mesh import Pose, mesh_of


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


def register(moving: tuple[ArrayLike, ArrayLike], fixed: tuple[ArrayLike, ArrayLike], *,
             anywhere: bool = False) -> Registration:
    """The rigid pose that brings a mesh onto another one of the same shape, or of a part of it.

    A mesh is (vertices, triangles): (n, 3) in m and (m, 3) indices from 0, counter-clockwise seen from outside.
    Triangles share vertices; the surface need not be closed. It is 1 mm to 5 m across. The search starts from all
    alignments of the principal axes; of poses that fit equally well it returns the one nearest to the given coordinates,
    unless `anywhere`. Takes seconds. Raises Error."""
    first, kept = mesh_of(moving, "moving")
    second, also_kept = mesh_of(fixed, "fixed")
    found = _library.Registration()
    call("register", ctypes.byref(first), ctypes.byref(second), int(anywhere), ctypes.byref(found))
    del kept, also_kept  # the library read them until here
    rival = None
    if np.isfinite(found.rival_rms):
        rival = Pose(np.array(found.rival_position), np.array(found.rival_orientation))
    return Registration(found.verdict.decode(), Pose(np.array(found.position), np.array(found.orientation)), found.rms,
                        found.median, found.p90, found.covered, rival, found.rival_rms)

# SPDX-License-Identifier: Apache-2.0
"""Contact of two rigid bodies in six degrees of freedom, by libtactus. It releases the interpreter's lock."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._library import call, doubles, library
from .errors import Error
from .mesh import Pose, mesh_of

_SUM = np.dtype([("wrench", np.float64, 6), ("stiffness", np.float64, (6, 6)), ("energy", np.float64),
                 ("penetration", np.float64), ("points", np.int64)])


class ContactSum(NamedTuple):
    """The contact at n poses; without the first axis for one `Pose`, or for one row of seven numbers."""

    wrench: np.ndarray  #: (n, 6): force in N and torque in N·m on the moving mesh about the position of its pose
    #: (n, 6, 6): second derivative of the energy by a small motion vx, vy, vz, wx, wy, wz of the moving mesh, in m and
    #: rad about the position of its pose, without the part of the curvature: N/m, N/rad, N·m/rad
    stiffness: np.ndarray
    energy: np.ndarray  #: (n,) J
    penetration: np.ndarray  #: (n,) m, of the deepest point
    points: np.ndarray  #: (n,) of the surface, that have a force


class Contact:
    """Points on the surface of the moving mesh against the distance field of the fixed one (McNeely, Puterbaugh and
    Troy 1999), as in patches. Each point is a spring along the gradient of the distance: its force is stiffness · area ·
    depth, where area is the surface that the point represents.

        contact = tactus.Contact((vertices, triangles), (others, their_triangles))
        force = contact(poses).wrench[:, :3]

    A mesh is (vertices, triangles): (n, 3) in m and (m, 3) indices from 0, counter-clockwise seen from outside. The
    fixed one must be closed. `stiffness`: N/m per m² of the moving surface; the default is 10 N/mm for each point
    0.5 mm apart. `spacing` of the points and `voxel` of the field in m. Making one takes up to seconds. Raises Error.
    One thread at a time."""

    def __init__(self, moving: tuple[ArrayLike, ArrayLike], fixed: tuple[ArrayLike, ArrayLike], *,
                 stiffness: float = 4e10, spacing: float = 0.5e-3, voxel: float = 0.5e-3) -> None:
        for name, value in (("stiffness", stiffness), ("spacing", spacing), ("voxel", voxel)):
            if not value > 0:
                raise Error(f"the {name} of a contact is above 0, given {value}")
        first, kept = mesh_of(moving, "moving")
        second, also_kept = mesh_of(fixed, "fixed")
        settings = _library.ContactSettings(ctypes.sizeof(_library.ContactSettings), stiffness, spacing, voxel)
        self._pointer = call("make_contact", ctypes.byref(first), ctypes.byref(second), ctypes.byref(settings))
        del kept, also_kept  # the library read them until here

    def __del__(self) -> None:
        pointer, self._pointer = getattr(self, "_pointer", None), None
        if pointer:
            library().tactus_free_contact(pointer)

    def __call__(self, poses: Pose | ArrayLike) -> ContactSum:
        """The contact at poses of the moving mesh in the frame of the fixed one: a `Pose`, or an array (n, 7) or (7,)
        of px, py, pz in m and a unit quaternion qw, qx, qy, qz. Raises Error."""
        given = np.concatenate(poses) if isinstance(poses, Pose) else np.asarray(poses)
        if given.dtype.kind not in "fiu" or given.ndim not in (1, 2) or given.shape[-1] != 7:
            raise Error(f"poses are numbers (n, 7): px, py, pz, qw, qx, qy, qz; given {given.dtype} {given.shape}")
        rows = np.ascontiguousarray(given.reshape(-1, 7), np.float64)
        sums = np.zeros(len(rows), _SUM)
        call("contact_at", self._pointer, doubles(rows), len(rows), sums.ctypes.data)
        return ContactSum(*(sums[name] if given.ndim == 2 else sums[name][0] for name in ContactSum._fields))

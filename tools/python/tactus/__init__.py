# SPDX-License-Identifier: Apache-2.0
"""Tactus in Python: takes as arrays, patches as functions, live runs.

    import tactus

    patch = tactus.load("touch-sphere")
    patch["ball.radius"] = "30 mm"
    run = patch.render(seconds=2)
    force = run["ball.wrench"]          # Stream: values (n, 6), names, rate, t
    print(abs(force.values[:, :3]).max(), "N")

    take = tactus.open("monday")        # a folder that `tactus run --record` wrote; nothing is copied
    take["ball.wrench"].values

Units are SI. Patches need libtactus (package libtactus0.1); takes need numpy only.
"""

from .analysis import Comparison, Exposure, compare, exposure, spectrum
from .contact import Contact, ContactSum
from .live import Live
from .node import Block, Parameter, Port, Setup, node
from .mesh import Pose
from .patch import Patch, Run, load, parse, version
from .registration import Registration, register
from .stream import Stream
from .take import Take, open
from .errors import Error

__all__ = ["Block", "Comparison", "Contact", "ContactSum", "Error", "Exposure", "Live", "Parameter", "Patch", "Port",
           "Pose", "Registration", "Run", "Setup", "Stream", "Take", "compare", "exposure", "load", "node", "open",
           "parse", "register", "spectrum", "version"]

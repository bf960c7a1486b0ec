# SPDX-License-Identifier: Apache-2.0
"""libtactus by ctypes: its C functions, tactus.h. Calls release the interpreter's lock."""

from __future__ import annotations

import ctypes as c
import functools
import os

from .errors import Error

_NAME = "libtactus.so.0.1"


class ErrorText(c.Structure):
    _fields_ = [("text", c.c_char * 2048), ("file", c.c_char * 512), ("line", c.c_int), ("column", c.c_int)]


class Device(c.Structure):
    _fields_ = [("max_force", c.c_double), ("max_torque", c.c_double), ("damping", c.c_double), ("delay", c.c_double)]


class Options(c.Structure):
    _fields_ = [("size", c.c_size_t), ("seconds", c.c_double), ("seed", c.c_uint64), ("folder", c.c_char_p),
                ("audio", c.c_char_p), ("live", c.c_int), ("threads", c.c_int)]


class Motion(c.Structure):
    _fields_ = [("position", c.c_double * 3), ("orientation", c.c_double * 4), ("velocity", c.c_double * 3),
                ("turning", c.c_double * 3), ("buttons", c.c_uint32), ("invalid", c.c_int)]


class OutputInfo(c.Structure):
    _fields_ = [("type", c.c_char_p), ("names", c.POINTER(c.c_char_p)), ("columns", c.c_int), ("rate", c.c_double)]


class Comparison(c.Structure):
    _fields_ = [(name, c.c_double) for name in (
        "delay", "correlation", "lowest", "highest", "reference_rms", "output_rms", "gain_db", "spectral_distance_db",
        "spectral_cosine", "touch_cosine", "touch_gap_db", "spectrogram_similarity", "st_sim", "spqi",
        "signal_to_noise_db", "coherence", "reference_hz", "output_hz")]


class Exposure(c.Structure):
    _fields_ = [("weighted", c.c_double * 3), ("total", c.c_double), ("a8", c.c_double),
                ("seconds_to_action", c.c_double), ("seconds_to_limit", c.c_double)]


class Port(c.Structure):
    _fields_ = [("name", c.c_char_p), ("type", c.c_char_p), ("unit", c.c_char_p), ("about", c.c_char_p),
                ("optional", c.c_int)]


class Parameter(c.Structure):
    _fields_ = [("name", c.c_char_p), ("initial", c.c_char_p), ("lowest", c.c_char_p), ("highest", c.c_char_p),
                ("about", c.c_char_p)]


class Setup(c.Structure):
    _fields_ = [("name", c.c_char_p), ("rate", c.c_double), ("max_frames", c.c_int), ("seed", c.c_uint64)]


class Rows(c.Structure):
    _fields_ = [("values", c.c_void_p), ("stride", c.c_ssize_t)]


class Block(c.Structure):
    _fields_ = [("index", c.c_int64), ("rate", c.c_double), ("frames", c.c_int), ("inputs", c.POINTER(Rows)),
                ("outputs", c.POINTER(Rows)), ("parameters", c.POINTER(c.c_double))]


class Mesh(c.Structure):
    _fields_ = [("vertices", c.POINTER(c.c_double)), ("vertex_count", c.c_size_t),
                ("triangles", c.POINTER(c.c_int32)), ("triangle_count", c.c_size_t)]


class Registration(c.Structure):
    _fields_ = [("verdict", c.c_char_p), ("position", c.c_double * 3), ("orientation", c.c_double * 4),
                ("rms", c.c_double), ("median", c.c_double), ("p90", c.c_double), ("covered", c.c_double),
                ("rival_rms", c.c_double), ("rival_position", c.c_double * 3), ("rival_orientation", c.c_double * 4)]


class ContactSettings(c.Structure):
    _fields_ = [("size", c.c_size_t), ("stiffness", c.c_double), ("spacing", c.c_double), ("voxel", c.c_double)]


_ERROR, _DOUBLES = c.POINTER(ErrorText), c.POINTER(c.c_double)
PREPARE = c.CFUNCTYPE(c.c_int, c.c_void_p, c.POINTER(Setup), c.POINTER(c.c_void_p), _ERROR)
PROCESS = c.CFUNCTYPE(c.c_int, c.c_void_p, c.POINTER(Block), _ERROR)
RELEASE = c.CFUNCTYPE(None, c.c_void_p)


class NodeType(c.Structure):
    _fields_ = [("size", c.c_size_t), ("name", c.c_char_p), ("about", c.c_char_p), ("inputs", c.POINTER(Port)),
                ("input_count", c.c_int), ("outputs", c.POINTER(Port)), ("output_count", c.c_int),
                ("parameters", c.POINTER(Parameter)), ("parameter_count", c.c_int), ("context", c.c_void_p),
                ("prepare", PREPARE), ("process", PROCESS), ("release", RELEASE)]


_FUNCTIONS = {
    "version": (c.c_char_p, []),
    "load": (c.c_void_p, [c.c_char_p, _ERROR]),
    "parse": (c.c_void_p, [c.c_char_p, c.c_char_p, _ERROR]),
    "configure": (c.c_int, [c.c_void_p, c.c_char_p, _ERROR]),
    "use_asset": (c.c_int, [c.c_void_p, c.c_char_p, _ERROR]),
    "attach_hand": (c.c_int, [c.c_void_p, c.c_char_p, c.POINTER(Device), _ERROR]),
    "free_patch": (None, [c.c_void_p]),
    "start": (c.c_void_p, [c.c_void_p, c.POINTER(Options), _ERROR]),
    "advance": (c.c_int, [c.c_void_p, c.c_double, _ERROR]),
    "render": (c.c_int, [c.c_void_p, _ERROR]),
    "time": (c.c_double, [c.c_void_p]),
    "set": (c.c_int, [c.c_void_p, c.c_char_p, c.c_char_p, _ERROR]),
    "find_hand": (c.c_int, [c.c_void_p, c.c_char_p, _ERROR]),
    "move_hand": (None, [c.c_void_p, c.c_int, c.POINTER(Motion)]),
    "hand_force": (None, [c.c_void_p, c.c_int, _DOUBLES]),
    "output": (c.c_int, [c.c_void_p, c.c_char_p, c.c_int, c.POINTER(OutputInfo), _ERROR]),
    "output_name": (c.c_char_p, [c.c_void_p, c.c_int]),
    "newest": (None, [c.c_void_p, c.c_int, _DOUBLES]),
    "fetch": (c.c_size_t, [c.c_void_p, c.c_int, _DOUBLES, _DOUBLES, c.c_size_t]),
    "available": (c.c_size_t, [c.c_void_p, c.c_int]),
    "finish": (c.c_int, [c.c_void_p, _ERROR]),
    "summary": (c.c_char_p, [c.c_void_p]),
    "hash": (c.c_uint64, [c.c_void_p]),
    "free_run": (None, [c.c_void_p]),
    "declare_node": (c.c_int, [c.POINTER(NodeType), _ERROR]),
    "spectrum": (c.c_size_t, [_DOUBLES, c.c_size_t, c.c_double, c.c_size_t, _DOUBLES, _DOUBLES, c.c_size_t, _ERROR]),
    "compare": (c.c_int, [_DOUBLES, c.c_size_t, c.c_double, _DOUBLES, c.c_size_t, c.c_double, c.POINTER(Comparison),
                          _ERROR]),
    "hand_arm_exposure": (c.c_int, [_DOUBLES * 3, c.c_size_t, c.c_double, c.c_double, c.POINTER(Exposure), _ERROR]),
    "make_contact": (c.c_void_p, [c.POINTER(Mesh), c.POINTER(Mesh), c.POINTER(ContactSettings), _ERROR]),
    "contact_at": (c.c_int, [c.c_void_p, _DOUBLES, c.c_size_t, c.c_void_p, _ERROR]),
    "free_contact": (None, [c.c_void_p]),
    "register": (c.c_int, [c.POINTER(Mesh), c.POINTER(Mesh), c.c_int, c.POINTER(Registration), _ERROR]),
}


@functools.lru_cache(maxsize=None)
def library() -> c.CDLL:
    """$TACTUS_SO, or the installed one. Raises Error."""
    try:
        loaded = c.CDLL(os.environ.get("TACTUS_SO") or _NAME)
    except OSError as failure:
        raise Error(f"{failure}; install the package libtactus0.1, or name the file in TACTUS_SO") from None
    for name, (result, arguments) in _FUNCTIONS.items():
        function = getattr(loaded, "tactus_" + name)
        function.restype, function.argtypes = result, arguments
    return loaded


def doubles(array):
    """The memory of an array of float64."""
    return array.ctypes.data_as(_DOUBLES)


def call(name: str, *arguments):
    """A function that may fail: its result, or an Error."""
    error = ErrorText()
    result = getattr(library(), "tactus_" + name)(*arguments, c.byref(error))
    if error.text:
        raise Error(error.text.decode(errors="replace"), error.file.decode(errors="replace"), error.line, error.column)
    return result

# SPDX-License-Identifier: Apache-2.0
"""Node types written in Python, for patches that are rendered or advanced. They are refused in a live run: the
interpreter allocates and waits, and a force must not depend on that."""

from __future__ import annotations

import contextlib
import ctypes
import itertools
import os
import threading
import traceback
import weakref
from typing import Callable, Iterator, Mapping, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._library import call, library
from .errors import Error

_COLUMNS = {"vector": 3, "pose": 7, "twist": 6, "wrench": 6}
_DTYPES = {"signal": np.dtype(np.float32), "bool": np.dtype(np.bool_)}
_FLOAT64 = np.dtype(np.float64)


class Port(NamedTuple):
    """An input or an output. Its array has a row per frame:

    ========  =================  =========================================================================
    type      shape, dtype       content
    ========  =================  =========================================================================
    signal    (n,) float32       samples
    number    (n,) float64       a quantity in SI units
    ramp      (n,) float64       inputs only: a number that a node with signals reads once per sample
    bool      (n,) bool
    vector    (n, 3) float64     x, y, z
    pose      (n, 7) float64     position in m, unit quaternion w, x, y, z
    twist     (n, 6) float64     velocity in m/s, angular velocity in rad/s
    wrench    (n, 6) float64     force in N, torque in N·m
    ========  =================  =========================================================================
    """

    type: str
    unit: str = ""  #: of a signal, number, ramp or vector: "m/s^2". Wires between different units are refused
    about: str = ""  #: one sentence
    optional: bool = False  #: an input that may stay without a wire; its array is then None


class Parameter(NamedTuple):
    """A quantity that the patch sets. The unit of `initial` is that of the parameter; a block has the value in SI."""

    initial: str  #: "0.5 N/mm"
    lowest: str
    highest: str
    about: str = ""  #: one sentence


class Setup(NamedTuple):
    """What a node can prepare for."""

    name: str  #: of the node in the patch
    rate: float  #: frames per second, as the patch states
    max_frames: int  #: most frames of a block
    seed: int  #: for random numbers that repeat; differs from node to node


class RunMemory:
    """One run of libtactus. The arrays of its blocks lie in its memory and keep it: it is freed after the last one."""

    _now = threading.local()

    def __init__(self) -> None:
        self.pointer: int | None = None
        self.failure: BaseException | None = None  # of a callback

    def __del__(self) -> None:
        pointer, self.pointer = getattr(self, "pointer", None), None
        if pointer:
            library().tactus_free_run(pointer)

    @contextlib.contextmanager
    def starting(self) -> Iterator[None]:
        """Nodes that are prepared meanwhile, on this thread, belong to this run."""
        before, self._now.memory = getattr(self._now, "memory", None), self
        try:
            yield
        finally:
            self._now.memory = before

    @classmethod
    def of_start(cls) -> "RunMemory":
        return cls._now.memory

    def call(self, name: str, *arguments):
        """A function that may call nodes: its result, or an Error from the exception of the callback."""
        try:
            return call(name, *arguments)
        except Error as error:
            failure, self.failure = self.failure, None
            if failure is not None and not isinstance(failure, Exception):
                raise failure from error  # KeyboardInterrupt, SystemExit
            if failure is not None:
                raise error from failure
            raise


class Block:
    """The frames of one call. `block["in"]`: the array of an input, read-only, or of an output, to be written into;
    neither is a copy, but of poses. `block["out"] = values` checks shape and kind of the values and writes them.
    `block["gain"]`: a parameter, in SI units. Before the call, every row of an output has the last value before this
    block.

    Keep a copy, `block["in"].copy()`, of what is needed later: the engine reuses the memory."""

    def __init__(self, declared: "_Type", memory: RunMemory, given: _library.Block) -> None:
        self.index: int = given.index  #: of the first frame, since the start of the run
        self.rate: float = given.rate  #: frames per second
        self.frames: int = given.frames
        self._declared = declared
        self._memory = memory
        self._given: _library.Block | None = given
        self._arrays: dict[str, np.ndarray | None] = {}

    @property
    def t(self) -> np.ndarray:
        """Logical time of each frame, s: (frames,)."""
        return np.arange(self.index, self.index + self.frames) / self.rate

    def __getitem__(self, name: str) -> np.ndarray | float | None:
        if name in self._arrays:
            return self._arrays[name]
        if self._given is None:
            raise Error("the block is over; keep copies of its arrays")
        place = self._declared.places.get(name)
        if place is None:
            raise Error(f"no port or parameter '{name}'; there are {', '.join(self._declared.places)}")
        kind, number = place
        if kind == "parameter":
            return self._given.parameters[number]
        is_input = kind == "input"
        rows = self._given.inputs[number] if is_input else self._given.outputs[number]
        self._arrays[name] = self._array(self._declared.ports[name], rows, is_input)
        return self._arrays[name]

    def _array(self, port: Port, rows: _library.Rows, is_input: bool) -> np.ndarray | None:
        if not rows.values:
            return None
        dtype, columns = _DTYPES.get(port.type, _FLOAT64), _COLUMNS.get(port.type, 1)
        size = rows.stride * (self.frames - 1) + columns * dtype.itemsize
        buffer = (ctypes.c_char * size).from_address(rows.values)
        buffer.memory = self._memory
        shape, strides = (self.frames,), (rows.stride,)
        if port.type in _COLUMNS:
            shape, strides = (self.frames, columns), (rows.stride, dtype.itemsize)
        array = np.ndarray(shape, dtype, buffer, strides=strides)
        array.flags.writeable = not is_input
        return array

    def __setitem__(self, name: str, values: ArrayLike) -> None:
        array = self[name]
        if self._declared.places[name][0] != "output":
            raise Error(f"'{name}' is no output")
        given = np.asarray(values)
        if given.dtype.kind not in ("b" if array.dtype.kind == "b" else "fiub"):
            raise Error(f"output '{name}' holds {array.dtype}, given {given.dtype}")
        if given.shape not in (array.shape, array.shape[1:]):
            raise Error(f"output '{name}' has the shape {array.shape}, given {given.shape}")
        array[...] = given

    def _end(self) -> None:
        self._given = None
        self._arrays.clear()


class _Type:
    """A declared type: what its callbacks need, and what must live as long as the library may call them."""

    def __init__(self, make: Callable[[Setup], Callable[[Block], None]], inputs: Mapping[str, Port],
                 outputs: Mapping[str, Port], parameters: Mapping[str, Parameter]) -> None:
        self.make = make
        self.ports = {**inputs, **outputs}
        self.places: dict[str, tuple[str, int]] = {}
        for kind, names in (("input", inputs), ("output", outputs), ("parameter", parameters)):
            for number, name in enumerate(names):
                self.places[name] = (kind, number)
        self.callbacks = (_library.PREPARE(self._prepare), _library.PROCESS(_process), _library.RELEASE(_release))

    def _prepare(self, _context, setup, state, error) -> int:
        memory = None
        try:
            memory = RunMemory.of_start()
            given = setup.contents
            made = self.make(Setup(given.name.decode(), given.rate, given.max_frames, given.seed))
            state[0] = next(_numbers)
            _nodes[state[0]] = (self, made, weakref.ref(memory))
            return 0
        except BaseException as failure:
            return _note(failure, memory, error)


_nodes: dict[int, tuple[_Type, Callable[[Block], None], "weakref.ref[RunMemory]"]] = {}
_numbers = itertools.count(1)
_types: list[_Type] = []


def _process(state, given, error) -> int:
    memory = block = None
    try:
        declared, process, memory_of = _nodes[state]
        memory = memory_of()
        block = Block(declared, memory, given.contents)
        process(block)
        return 0
    except BaseException as failure:
        return _note(failure, memory, error)
    finally:
        if block is not None:
            block._end()


def _release(state) -> None:
    _nodes.pop(state, None)


def _note(failure: BaseException, memory: RunMemory | None, error) -> int:
    if memory is not None and memory.failure is None:
        memory.failure = failure
    text = "".join(traceback.format_exception_only(type(failure), failure)).strip()
    # The innermost line of the author's code.
    own = [frame for frame in traceback.extract_tb(failure.__traceback__)
           if os.path.dirname(frame.filename) != os.path.dirname(__file__)]
    if own:
        text = f"{text} ({own[-1].filename}, line {own[-1].lineno})"
    error.contents.text = text.encode(errors="replace")[:2000]
    return 1


def _ports(given: Mapping[str, "Port | str"]) -> dict[str, Port]:
    return {name: Port(port) if isinstance(port, str) else Port(*port) for name, port in given.items()}


_Code = TypeVar("_Code")


def node(name: str, *, inputs: Mapping[str, Port | str] | None = None, outputs: Mapping[str, Port | str] | None = None,
         parameters: Mapping[str, Parameter | tuple[str, ...]] | None = None) -> Callable[[_Code], _Code]:
    """Declares a node type, for patches that are loaded afterwards: `type = "name"`.

        @tactus.node("soft_clip", inputs={"in": "signal"}, outputs={"out": "signal"},
                     parameters={"drive": ("1", "0", "10")})
        def soft_clip(block):
            np.tanh(block["drive"] * block["in"], out=block["out"])

    A function is called with the `Block` of each call. A class is made once per node of a run; its `process(block)` is
    called, and before the first block its `prepare(setup)`, if it has one. A port is a `Port` or its type; a parameter
    is a `Parameter` or (initial, lowest, highest). The docstring describes the type.

    Runs have the same bits for every partition into blocks, if a frame is computed from this frame and the ones before
    it. An exception ends the run, which raises an Error with its text and the place of the node in the patch. Different
    nodes may be called from several threads; the interpreter's lock is held. A later declaration of the same name
    replaces the type for runs that start afterwards. Raises Error."""

    def declare(code: _Code) -> _Code:
        def make(setup: Setup) -> Callable[[Block], None]:
            if not isinstance(code, type):
                return code
            made = code()
            if hasattr(made, "prepare"):
                made.prepare(setup)
            return made.process

        if not callable(getattr(code, "process", None) if isinstance(code, type) else code):
            raise Error(f"node type '{name}': a function of a block, or a class with 'process', is needed")
        declared_inputs, declared_outputs = _ports(inputs or {}), _ports(outputs or {})
        declared_parameters = {key: Parameter(*given) for key, given in (parameters or {}).items()}
        declared = _Type(make, declared_inputs, declared_outputs, declared_parameters)

        def ports(given: Mapping[str, Port]) -> ctypes.Array:
            return (_library.Port * len(given))(
                *(_library.Port(key.encode(), port.type.encode(), port.unit.encode(), port.about.encode(),
                                int(port.optional)) for key, port in given.items()))

        settings = (_library.Parameter * len(declared_parameters))(
            *(_library.Parameter(key.encode(), *(text.encode() for text in given))
              for key, given in declared_parameters.items()))
        about = " ".join((code.__doc__ or "").split())
        _types.append(declared)  # before the library can call it, and for ever
        call("declare_node", ctypes.byref(_library.NodeType(
            ctypes.sizeof(_library.NodeType), name.encode(), about.encode(), ports(declared_inputs),
            len(declared_inputs), ports(declared_outputs), len(declared_outputs), settings, len(declared_parameters),
            None, *declared.callbacks)))
        return code

    return declare

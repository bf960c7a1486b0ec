# SPDX-License-Identifier: Apache-2.0
"""Patches and their runs, by libtactus."""

from __future__ import annotations

import concurrent.futures
import ctypes
import itertools
import json
import os
import queue
from typing import Iterable, Iterator, Mapping, Sequence

import numpy as np

from . import _library
from ._library import call, doubles, library
from .errors import Error
from .node import RunMemory
from .stream import Stream, table_of


def version() -> str:
    """Of libtactus."""
    return library().tactus_version().decode()


def load(patch: str | os.PathLike[str], assets: Mapping[str, str | os.PathLike[str]] | None = None) -> "Patch":
    """A patch file, or a patch of the library by its name. `assets`: files in place of those that it names."""
    return _with(Patch(call("load", os.fspath(patch).encode()), os.fspath(patch), assets=dict(assets or {})))


def parse(text: str, folder: str | os.PathLike[str] = ".") -> "Patch":
    """The patch in `text`; relative paths in it start at `folder`."""
    return Patch(call("parse", text.encode(), os.fspath(folder).encode()), "patch", (text, os.fspath(folder)))


def _with(patch: "Patch") -> "Patch":
    for name, file in patch._assets.items():
        call("use_asset", patch._pointer, f"{name}={os.fspath(file)}".encode())
    return patch


class Patch:
    """`patch["blade.stiffness"] = "0.5 N/mm"` sets what runs begin with. One thread at a time."""

    def __init__(self, pointer: int, name: str, text: tuple[str, str] | None = None,
                 assets: dict[str, str | os.PathLike[str]] | None = None) -> None:
        self._pointer = pointer
        self.name = name
        self._text = text
        self._assets = assets or {}
        self._settings: dict[str, str] = {}
        self._hands: dict[str, dict[str, float] | None] = {}

    def __del__(self) -> None:
        pointer, self._pointer = getattr(self, "_pointer", None), None
        if pointer:
            library().tactus_free_patch(pointer)

    def __setitem__(self, name: str, value: str | float) -> None:
        call("configure", self._pointer, f"{name}={value}".encode())
        self._settings[name] = str(value)

    def __getitem__(self, name: str) -> str:
        """What was set here."""
        return self._settings[name]

    def attach_hand(self, name: str, *, max_force: float = 0.0, max_torque: float = 0.0, damping: float = 0.0,
                    delay: float = 0.0) -> None:
        """The device [devices.NAME] is moved by Run.move_hand. Without limits it is an ideal one."""
        limits = dict(max_force=max_force, max_torque=max_torque, damping=damping, delay=delay)
        device = _library.Device(**limits) if any(limits.values()) else None
        call("attach_hand", self._pointer, name.encode(), ctypes.byref(device) if device else None)
        self._hands[name] = limits if device else None

    def start(self, seconds: float = 0.0, *, seed: int = 0, folder: str | os.PathLike[str] | None = None,
              live: bool = False, audio: str = "none", threads: int = 0, keep: Iterable[str] | None = None) -> "Run":
        """A run: `advance` it from a loop, or live. `keep`: outputs of which every value is kept for `Run.fetch`."""
        options = _library.Options(ctypes.sizeof(_library.Options), seconds, seed,
                                   os.fspath(folder).encode() if folder is not None else None, audio.encode(),
                                   int(live), threads)
        memory = RunMemory()
        with memory.starting():
            memory.pointer = memory.call("start", self._pointer, ctypes.byref(options))
        return Run(memory, keep or ())

    def render(self, seconds: float, *, seed: int = 0, outputs: Sequence[str] | None = None,
               folder: str | os.PathLike[str] | None = None, threads: int = 0) -> "Rendered":
        """Runs `seconds` as fast as the machine can. `outputs`: those to keep, default all that have numbers."""
        with self.start(seconds, seed=seed, folder=folder, threads=threads) as run:
            for port in run.outputs() if outputs is None else outputs:
                run.keep(port)
            run._memory.call("render", run._pointer)
            streams = {port: run.fetch(port) for port in run.kept()}
            run.finish()
            return Rendered(streams, run.hash, run.summary)

    def copy(self) -> "Patch":
        """Another patch with the same settings, for another thread."""
        made = parse(*self._text) if self._text else load(self.name, self._assets)
        for name, value in self._settings.items():
            made[name] = value
        for name, limits in self._hands.items():
            made.attach_hand(name, **(limits or {}))
        return made

    def sweep(self, grid: Mapping[str, Sequence[str | float]], seconds: float, *, jobs: int = 1, seed: int = 0,
              outputs: Sequence[str] | None = None) -> Iterator[tuple[dict[str, str | float], "Rendered"]]:
        """Renders every combination of `grid`; gives (settings, rendered) in the grid's order."""
        points = [dict(zip(grid, values)) for values in itertools.product(*grid.values())]
        patches: queue.Queue[Patch] = queue.Queue()
        for _ in range(max(1, jobs)):
            patches.put(self.copy())

        def one(point: dict[str, str | float]) -> "Rendered":
            patch = patches.get()
            try:
                for name, value in point.items():
                    patch[name] = value
                return patch.render(seconds, seed=seed, outputs=outputs, threads=1 if jobs > 1 else 0)
            finally:
                patches.put(patch)

        with concurrent.futures.ThreadPoolExecutor(max(1, jobs)) as pool:
            yield from zip(points, pool.map(one, points))


class Rendered(Mapping[str, Stream]):
    """Outputs by name. `hash` over every value of every output; `summary` as summary.json has it."""

    def __init__(self, streams: dict[str, Stream], value: str, summary: dict) -> None:
        self._streams = streams
        self.hash = value
        self.summary = summary

    def __getitem__(self, port: str) -> Stream:
        if port not in self._streams:
            raise KeyError(f"no output '{port}' was kept; kept are {', '.join(self._streams)}")
        return self._streams[port]

    def __iter__(self) -> Iterator[str]:
        return iter(self._streams)

    def __len__(self) -> int:
        return len(self._streams)

    def _repr_html_(self) -> str:
        return table_of(self._streams)


class Run:
    """One run of a patch; a context that finishes it. One thread at a time."""

    def __init__(self, memory: RunMemory, keep: Iterable[str]) -> None:
        self._memory = memory
        self._outputs: dict[str, tuple[int, str, list[str], float]] = {}
        self._kept: list[str] = []
        self._hands: dict[str, int] = {}
        self.summary: dict = {}
        self.hash = ""
        for port in keep:
            self.keep(port)

    @property
    def _pointer(self) -> int:
        return self._memory.pointer

    def __enter__(self) -> "Run":
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        if kind is None:
            self.finish()

    def outputs(self) -> list[str]:
        """All outputs that have numbers."""
        names = []
        for index in itertools.count():
            name = library().tactus_output_name(self._pointer, index)
            if name is None:
                return names
            names.append(name.decode())

    def _output(self, port: str, every: bool) -> tuple[int, str, list[str], float]:
        if port not in self._outputs or every:
            info = _library.OutputInfo()
            number = call("output", self._pointer, port.encode(), int(every), ctypes.byref(info))
            names = [info.names[i].decode() for i in range(info.columns)]
            self._outputs[port] = (number, info.type.decode(), names, info.rate)
        return self._outputs[port]

    def keep(self, port: str) -> None:
        """Keeps every value of an output for `fetch`; before the run begins."""
        self._output(port, True)
        if port not in self._kept:
            self._kept.append(port)

    def kept(self) -> list[str]:
        return list(self._kept)

    def advance(self, seconds: float) -> None:
        """Runs every activation before the present logical time + `seconds`."""
        self._memory.call("advance", self._pointer, seconds)

    @property
    def time(self) -> float:
        """Logical time, s."""
        return library().tactus_time(self._pointer)

    def set(self, name: str, value: str | float) -> None:
        self._memory.call("set", self._pointer, name.encode(), str(value).encode())

    def __setitem__(self, name: str, value: str | float) -> None:
        self.set(name, value)

    def move_hand(self, name: str, position: Sequence[float], orientation: Sequence[float] = (1, 0, 0, 0),
                  velocity: Sequence[float] = (0, 0, 0), turning: Sequence[float] = (0, 0, 0), buttons: int = 0,
                  invalid: bool = False) -> None:
        """Where an attached hand is from now on: m, (w, x, y, z), m/s, rad/s."""
        motion = _library.Motion((ctypes.c_double * 3)(*position), (ctypes.c_double * 4)(*orientation),
                                 (ctypes.c_double * 3)(*velocity), (ctypes.c_double * 3)(*turning), buttons,
                                 int(invalid))
        library().tactus_move_hand(self._pointer, self._hand(name), ctypes.byref(motion))

    def force(self, name: str) -> np.ndarray:
        """Force (N) and torque (N·m) on an attached hand: 6 numbers."""
        wrench = np.empty(6)
        library().tactus_hand_force(self._pointer, self._hand(name), doubles(wrench))
        return wrench

    def _hand(self, name: str) -> int:
        if name not in self._hands:
            self._hands[name] = call("find_hand", self._pointer, name.encode())
        return self._hands[name]

    def newest(self, port: str) -> np.ndarray:
        """The newest value of an output."""
        number, _, names, _ = self._output(port, False)
        values = np.empty(len(names))
        library().tactus_newest(self._pointer, number, doubles(values))
        return values

    def fetch(self, port: str) -> Stream:
        """What an output that is kept gave since the last fetch."""
        if port not in self._kept:
            raise Error(f"'{port}' is not kept; start the run with keep=['{port}']")
        number, kind, names, rate = self._outputs[port]
        count = library().tactus_available(self._pointer, number)
        t, values = np.empty(count), np.empty((count, len(names)))
        got = library().tactus_fetch(self._pointer, number, doubles(t), doubles(values), count) if count else 0
        return Stream(port, kind, names, rate, values[:got], t[:got])

    def finish(self) -> None:
        """Ends the run and writes what belongs into its folder."""
        if self.hash:
            return
        self._memory.call("finish", self._pointer)
        self.hash = f"{library().tactus_hash(self._pointer):016x}"
        self.summary = json.loads(library().tactus_summary(self._pointer).decode())

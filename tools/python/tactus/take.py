# SPDX-License-Identifier: Apache-2.0
"""Takes: folders that a run with --record wrote. Values are mapped from the files, not read."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import struct
import subprocess
import warnings
from typing import Iterator, Mapping

import numpy as np

from .errors import Error
from .stream import Stream, table_of

_FLICKS = 705_600_000
_NAMES = {
    "pose": ["px", "py", "pz", "qw", "qx", "qy", "qz"],
    "twist": ["vx", "vy", "vz", "wx", "wy", "wz"],
    "wrench": ["fx", "fy", "fz", "tx", "ty", "tz"],
    "vector": ["x", "y", "z"],
    "event": ["count", "lost", "kind", "first"],
}


def open(folder: str | os.PathLike[str]) -> "Take":  # as tactus.open
    """A take by its folder. Raises Error when it is none."""
    return Take(folder)


def _samples(path: pathlib.Path) -> tuple[int, int, int]:
    """Of a WAV or RF64 file of doubles: offset of the samples, their bytes, channels."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(12)
        if len(head) < 12 or head[:4] not in (b"RIFF", b"RF64") or head[8:] != b"WAVE":
            raise Error(f"{path}: no WAV or RF64 file")
        channels, long_data = 0, None
        while True:
            chunk = file.read(8)
            if len(chunk) < 8:
                raise Error(f"{path}: the file has no samples")
            name, length = chunk[:4], struct.unpack("<I", chunk[4:])[0]
            if name == b"data":
                offset = file.tell()
                # A run that goes on, or was killed, has written more than the header says.
                return offset, max(0, min(long_data or length, size - offset)), channels
            body = file.read(length + length % 2)
            if name == b"ds64":
                long_data = struct.unpack("<Q", body[8:16])[0]
            elif name == b"fmt ":
                kind, channels = struct.unpack("<HH", body[:4])
                bits = struct.unpack("<H", body[14:16])[0]
                if kind == 0xFFFE:
                    kind = struct.unpack("<H", body[24:26])[0]
                if kind != 3 or bits != 64:
                    raise Error(f"{path}: the samples are no doubles")


class Take(Mapping[str, Stream]):
    """Outputs by name, "node.port". `about`: what take.json says. `events`: devices, edits, parameters that were set."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = pathlib.Path(folder)
        about = self.folder / "take.json"
        if not about.is_file():
            raise Error(f"{self.folder}: no take; a take is a folder that 'tactus run PATCH --record FOLDER' writes")
        self.about = json.loads(about.read_text(encoding="utf-8"))
        self.events: list[dict] = []
        lines = (self.folder / "events.jsonl").read_text(encoding="utf-8").splitlines()
        for number, line in enumerate(lines):
            try:
                self.events.append(json.loads(line))
            except json.JSONDecodeError:
                if number + 1 < len(lines):  # the last line of a run that was killed may be cut
                    raise Error(f"{self.folder / 'events.jsonl'}: line {number + 1} is no JSON") from None
        self._places: dict[str, list[tuple[dict, int, int, str]]] = {}
        for event in self.events:
            if "stream" not in event:
                continue
            outputs = event.get("outputs") or [
                {"port": event["port"], "type": event["type"], "channels": event["channels"]}]
            first = 0
            for output in outputs:
                count = output["channels"] if isinstance(output["channels"], int) else len(output["channels"])
                self._places.setdefault(output["port"], []).append((event, first, count, output["type"]))
                first += count

    @property
    def values_end(self) -> float | None:
        """Time in s from which on the run recorded no values (without `--values`); None: it recorded all."""
        return min((event["values_end_s"] for event in self.events if "values_end_s" in event), default=None)

    def parts(self, port: str) -> list[Stream]:
        """The stretches of an output: an edit, or recording that is switched off and on, begins another file."""
        if not self._places:
            raise Error(f"{self.folder}: no values; write the take with values by "
                        f"'tactus replay {self.folder} --record NEW'")
        if port not in self._places:
            raise KeyError(f"{self.folder} has no output '{port}'; it has {', '.join(self._places)}")
        return [self._stream(port, *place) for place in self._places[port]]

    def __getitem__(self, port: str) -> Stream:
        """All of an output. One stretch is mapped; several are copied together."""
        parts = self.parts(port)
        if (end := self.values_end) is not None:
            warnings.warn(f"{self.folder}: values end at {end:.4g} s, before the run; "
                          f"'tactus replay {self.folder} --record NEW' writes all", stacklevel=2)
        if len(parts) == 1:
            return parts[0]
        return Stream(port, parts[0].type, parts[0].names, parts[0].rate, np.concatenate([p.values for p in parts]),
                      np.concatenate([p.t for p in parts]))

    def _stream(self, port: str, event: dict, first: int, count: int, kind: str) -> Stream:
        path = self.folder / event["stream"]
        if not path.is_file():
            path = self.folder / "streams" / event["stream"]
        offset, length, channels = _samples(path)
        frames = length // (8 * channels)
        period = event["period_flicks"]
        values = (np.memmap(path, "<f8", "r", offset, (frames, channels))[:, first:first + count]
                  if frames else np.empty((0, count)))
        names = _NAMES.get(kind, ["value"] if count == 1 else ["hash_high", "hash_low"])
        return Stream(port, kind, names, _FLICKS / period, values, None, event["start"] * period / _FLICKS)

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def replay(self) -> bool:
        """Repeats the run; True when every value has the same bits. Needs the command `tactus`."""
        command = os.environ.get("TACTUS_COMMAND") or shutil.which("tactus")
        if not command:
            raise Error("the command 'tactus' is not installed; TACTUS_COMMAND may name it")
        done = subprocess.run([command, "replay", str(self.folder)], capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1):
            raise Error(done.stderr.strip() or f"'tactus replay' ended with {done.returncode}")
        return done.returncode == 0

    def __repr__(self) -> str:
        return f"<take {self.folder}: {self.about.get('title') or self.about.get('patch')}, {len(self)} outputs>"

    def _repr_html_(self) -> str:
        return table_of(dict(self))

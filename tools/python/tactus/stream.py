# SPDX-License-Identifier: Apache-2.0
"""The values of one output, one after another."""

from __future__ import annotations

from typing import Sequence

import numpy as np


class Stream:
    """`values`: array (n, columns) of float64, read-only. `names`: of its columns, SI: "fx" in N, "px" in m. `rate` in Hz.
    `type`: "wrench", "signal" … `t`: logical time of each value, s."""

    def __init__(self, port: str, kind: str, names: Sequence[str], rate: float, values: np.ndarray,
                 t: np.ndarray | None = None, start: float = 0.0) -> None:
        self.port = port
        self.type = kind
        self.names = list(names)
        self.rate = rate
        self.values = values
        self.values.flags.writeable = False
        self._t = t
        self._start = start

    @property
    def t(self) -> np.ndarray:
        if self._t is None:
            self._t = self._start + np.arange(len(self.values)) / self.rate
        return self._t

    def numpy(self) -> np.ndarray:
        return self.values

    def __array__(self, dtype=None) -> np.ndarray:
        return self.values if dtype is None else self.values.astype(dtype)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, key):
        """A column by its name; anything else as of the array."""
        if isinstance(key, str):
            if key not in self.names:
                raise KeyError(f"'{self.port}' has no column '{key}'; it has {', '.join(self.names)}")
            return self.values[:, self.names.index(key)]
        return self.values[key]

    def __repr__(self) -> str:
        return f"<{self.port}: {len(self)} × {self.type} ({', '.join(self.names)}) at {self.rate:g} Hz>"


def table_of(streams: dict[str, Stream]) -> str:
    """An HTML table: a row per output, with its r.m.s. and peak."""
    rows = []
    for port, stream in streams.items():
        values = np.asarray(stream.values)
        rms, peak = (float(np.sqrt(np.mean(values**2))), float(np.abs(values).max())) if values.size else (0.0, 0.0)
        rows.append(f"<tr><td>{port}</td><td>{stream.type}</td><td>{stream.rate:g}</td><td>{len(stream)}</td>"
                    f"<td>{rms:.4g}</td><td>{peak:.4g}</td></tr>")
    head = "".join(f"<th>{name}</th>" for name in ("output", "type", "rate, Hz", "values", "r.m.s.", "peak"))
    return f"<table><tr>{head}</tr>{''.join(rows)}</table>"

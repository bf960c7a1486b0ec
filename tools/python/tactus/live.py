# SPDX-License-Identifier: Apache-2.0
"""A run of the command `tactus run`, from outside: its parameters over its control socket."""

from __future__ import annotations

import os
import pathlib
import socket

from .errors import Error


def _folder() -> pathlib.Path:
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    return pathlib.Path(runtime) / "tactus" if runtime else pathlib.Path(f"/tmp/tactus-{os.getuid()}")


class Live:
    """`live["blade.stiffness"] = "0.5 N/mm"`. Without `process` the only run of this user."""

    def __init__(self, process: int | None = None, timeout: float = 5.0) -> None:
        if process is None:
            found = sorted(_folder().glob("*.socket"))
            if len(found) != 1:
                raise Error("no run accepts changes" if not found else
                            "several runs accept changes; name one: " + ", ".join(f.stem for f in found))
            path = found[0]
        else:
            path = _folder() / f"{process}.socket"
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._socket.settimeout(timeout)
        try:
            self._socket.connect(str(path))
        except OSError as failure:
            raise Error(f"{path}: no run listens there ({failure.strerror})") from None
        self._lines = self._socket.makefile("r", encoding="utf-8", newline="\n")

    def set(self, name: str, value: str | float) -> str:
        """Sets a parameter; returns from which logical time on it holds."""
        self._socket.sendall(f"set {name}={value}\n".encode())
        answer = self._lines.readline().rstrip("\n")
        if not answer:
            raise Error("the run is over")
        if answer.startswith("error "):
            raise Error(answer.removeprefix("error "))
        return answer

    def __setitem__(self, name: str, value: str | float) -> None:
        self.set(name, value)

    def close(self) -> None:
        self._lines.close()
        self._socket.close()

    def __enter__(self) -> "Live":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

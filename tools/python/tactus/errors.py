# SPDX-License-Identifier: Apache-2.0
"""What goes wrong, with the place in the patch."""

from __future__ import annotations


class Error(Exception):
    """`file`, `line` and `column` say where in a patch; line 0: unknown."""

    def __init__(self, text: str, file: str = "", line: int = 0, column: int = 0) -> None:
        super().__init__(text)
        self.file = file
        self.line = line
        self.column = column

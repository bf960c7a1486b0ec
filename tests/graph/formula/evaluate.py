#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Evaluates formulas, one a line after the values of x, y and z; prints each value in hexadecimal, or 'none'."""
import math
import sys

names = {name: getattr(math, name) for name in
         ("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "floor", "ceil", "pi")}
names.update(abs=lambda a: abs(float(a)), min=min, max=max, sign=lambda a: (a > 0) - (a < 0),
             clip=lambda a, low, high: min(max(a, low), high), choose=lambda c, a, b: a if c else b)

for line in sys.stdin:
    x, y, z, text = line.rstrip("\n").split(" ", 3)
    names.update(x=float.fromhex(x), y=float.fromhex(y), z=float.fromhex(z))
    try:
        value = float(eval(text.replace("^", "**").replace("if(", "choose("), {"__builtins__": {}}, names))
        print(value.hex() if math.isfinite(value) else "none")
    except (ArithmeticError, ValueError, TypeError):
        print("none")

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Welch spectrum of 600 s of 48 kHz mono: Tactus beside scipy.signal.welch, by turns, on the same doubles.

usage: welch.py PATH_OF_bench_welch     (./dev bench welch builds it and runs this)
Prints the median over nine pairs of the ratio of the times, and the largest difference of the spectra.
"""
import statistics
import subprocess
import sys
import tempfile
import time

import numpy
import scipy.signal

PAIRS, SECONDS, RATE = 9, 600, 48000


def main(program):
    for name in ("double", "float"):
        x = numpy.random.default_rng(1).standard_normal(SECONDS * RATE)
        with tempfile.NamedTemporaryFile() as file:
            x.tofile(file.name)
            ours = subprocess.Popen([program, file.name, name], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            x = x.astype(name)
            for threads in (1, 2):
                ratios, mine, theirs = [], [], []
                for pair in range(PAIRS + 1):
                    begin = time.perf_counter()
                    _, power = scipy.signal.welch(x, RATE, "hann", 4096, 2048)
                    theirs.append(time.perf_counter() - begin)
                    print(threads, file=ours.stdin, flush=True)
                    seconds, total = map(float, ours.stdout.readline().split())
                    mine.append(seconds)
                    assert abs(total / power.sum(dtype="float64") - 1) < (1e-12 if name == "double" else 1e-5)
                    ratios.append(theirs[-1] / seconds)
                # The first pair warms the caches.
                print(f"{name}, {threads} thread(s): Tactus {statistics.median(mine[1:]):.3f} s, "
                      f"scipy {statistics.median(theirs[1:]):.3f} s, {statistics.median(ratios[1:]):.1f} times as fast "
                      f"({min(ratios[1:]):.1f} to {max(ratios[1:]):.1f})", flush=True)
            ours.stdin.close()
            ours.wait()


main(sys.argv[1])

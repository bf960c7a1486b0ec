#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Welch spectrum of 600 s of 48 kHz mono: Tactus beside scipy.signal.welch, by turns, on the same doubles.

usage: welch.py PATH_OF_bench_welch     (./dev bench welch builds it and runs this)
For segments of 4096, 4410 (2·3²·5·7²) and 11025 (3²·5²·7²) samples prints the median over nine pairs of the ratio of the
times, and the largest difference of the spectra relative to their largest value.
"""
import itertools
import statistics
import subprocess
import sys
import tempfile
import time

import numpy
import scipy.signal

PAIRS, SECONDS, RATE, SEGMENTS = 9, 600, 48000, (4096, 4410, 11025)


def main(program):
    for name in ("double", "float"):
        x = numpy.random.default_rng(1).standard_normal(SECONDS * RATE)
        with tempfile.NamedTemporaryFile() as file:
            x.tofile(file.name)
            ours = subprocess.Popen([program, file.name, name], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            x = x.astype(name)
            for segment, threads in itertools.product(SEGMENTS, (1, 2)):
                ratios, mine, theirs, apart = [], [], [], 0.0
                for pair in range(PAIRS + 1):
                    begin = time.perf_counter()
                    _, power = scipy.signal.welch(x, RATE, "hann", segment, segment // 2)
                    theirs.append(time.perf_counter() - begin)
                    print(threads, segment, file=ours.stdin, flush=True)
                    seconds, *powers = map(float, ours.stdout.readline().split())
                    mine.append(seconds)
                    apart = max(apart, abs(powers - power.astype("float64")).max() / power.max())
                    assert apart <= (1e-12 if name == "double" else 1e-5), apart
                    ratios.append(theirs[-1] / seconds)
                # The first pair warms the caches.
                print(f"{name}, {segment} samples, {threads} thread(s): Tactus {statistics.median(mine[1:]):.3f} s, "
                      f"scipy {statistics.median(theirs[1:]):.3f} s, {statistics.median(ratios[1:]):.1f} times as fast "
                      f"({min(ratios[1:]):.1f} to {max(ratios[1:]):.1f}), {apart:.1e} apart", flush=True)
            ours.stdin.close()
            ours.wait()


main(sys.argv[1])

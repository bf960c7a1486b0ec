#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Welch spectrum of 600 s of 48 kHz mono: Tactus beside scipy.signal.welch, by turns, on the same doubles.

usage: welch.py PATH_OF_bench_welch PATH_OF_tactus     (./dev bench welch builds them and runs this)
For segments of 4096, 4410 (2·3²·5·7²) and 11025 (3²·5²·7²) samples prints the median over nine pairs of the ratio of the
times, and the largest difference of the spectra relative to their largest value. Then the verb 'spectrum', whole and with
--psd-only, beside scipy's wavfile.read and welch of the same file, in processor time. With one argument: the verb alone.
"""
import itertools
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

import numpy
import scipy.io.wavfile
import scipy.signal

PAIRS, SECONDS, RATE, SEGMENTS = 9, 600, 48000, (4096, 4410, 11025)


def processor_s(usage):
    return usage.children_user + usage.children_system


def verb(tactus):
    """Reading, spectrum, fundamental and text of a file: processor time of each process, pair by pair."""
    with tempfile.NamedTemporaryFile(suffix=".wav") as file:
        noise = numpy.random.default_rng(1).standard_normal(SECONDS * RATE) * 0.1
        scipy.io.wavfile.write(file.name, RATE, noise.astype("float32"))
        for options in ([], ["--psd-only"]):
            mine, theirs = [], []
            for pair in range(PAIRS // 2 + 1):
                before = os.times()
                text = subprocess.run([tactus, "spectrum", file.name, "--json", *options], capture_output=True, check=True)
                mine.append(processor_s(os.times()) - processor_s(before))
                psd = json.loads(text.stdout)["rows"][0]["psd"]
                begin = time.process_time()
                rate, x = scipy.io.wavfile.read(file.name)
                scipy.signal.welch(x, rate, "hann", psd["segment"], psd["overlap"])
                theirs.append(time.process_time() - begin)
            ratios = [b / a for a, b in zip(mine[1:], theirs[1:])]
            print(f"tactus {' '.join(['spectrum', *options])}, segments of {psd['segment']}: "
                  f"{statistics.median(mine[1:]):.2f} s of processor time, scipy's load and welch "
                  f"{statistics.median(theirs[1:]):.2f} s, {statistics.median(ratios):.1f} times as fast "
                  f"({min(ratios):.1f} to {max(ratios):.1f})", flush=True)


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


if len(sys.argv) > 2:
    main(sys.argv[1])
verb(sys.argv[-1])

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Figures of the vibration verbs beside numpy and scipy, over all records of a folder.

usage: vibration.py TACTUS FOLDER       (/usr/bin/python3 of Debian, which has scipy)
Prints a Markdown table: figure, reference, largest difference, and the record that has it. Logs are compared as the
program resampled them; their level is compared with the rows.
"""
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy
import scipy.signal as signal
from scipy.io import wavfile

# Fundamentals read off spectrograms by eye: Hz in the middle of the time, and the range in most of it. None: no saw.
MARKS = {
    "chainsaw_116765a": (155, 135, 177), "chainsaw_47250a": (133, 120, 155),
    "chainsaw_cutting_149294a": (219, 215, 222), "chainsaw_cutting_tree_169127b": (158, 146, 200),
    "accel_tree_machete": None, "accel_tree_ambient": None,
}


REFERENCES = {
    "PSD,": "`scipy.signal.welch`", "rms,": "`numpy.std`", "rms": "`numpy.std`", "bands,": "`numpy.fft` of the whole record",
    "sum": "`numpy.fft` of the whole record", "weighted": "formula of ISO 5349-1, `numpy.fft`",
    "weighting": "formula of ISO 5349-1, `numpy.fft`", "A(8),": "formula of ISO 5349-1, `numpy.fft`",
    "envelope,": "`scipy.signal.hilbert`, `welch`", "coherence,": "`scipy.signal.coherence`",
    "orders": "`scipy.signal.welch`, flat top",
}


def run(tactus, *arguments):
    done = subprocess.run([tactus, *arguments], capture_output=True, text=True)
    if done.returncode == 2:
        raise SystemExit(done.stderr)
    return json.loads(done.stdout)


def samples(path, folder):
    """Rate and samples of a sound; numpy has no reader of FLAC."""
    raw = folder + "/x.raw"
    subprocess.run(["sox", path, "-t", "f64", raw], check=True)
    rate = int(subprocess.run(["soxi", "-r", path], capture_output=True, text=True).stdout)
    return rate, numpy.fromfile(raw)


def weighting(f):
    """Wh by the formula of ISO 5349-1 / ISO 8041-1, written anew for this comparison."""
    w = 2j * math.pi * numpy.maximum(f, 1e-9)
    w1, w2, w3 = 2 * math.pi * 10 ** 0.8, 2 * math.pi * 10 ** 3.1, 100.0
    return (w ** 2 / (w ** 2 + math.sqrt(2) * w1 * w + w1 ** 2) * w2 ** 2 / (w ** 2 + math.sqrt(2) * w2 * w + w2 ** 2)
            * (w3 ** 2 + w3 * w) / (w ** 2 + w3 / 0.64 * w + w3 ** 2))


def weighted(x, rate):
    x = x - x.mean()
    size = 2 ** math.ceil(math.log2(len(x) + rate))
    spectrum = numpy.fft.rfft(x, size)
    f = numpy.fft.rfftfreq(size, 1 / rate)
    sides = numpy.full(len(f), 2.0)
    sides[[0, -1]] = 1.0
    return math.sqrt((sides * numpy.abs(spectrum * weighting(f)) ** 2).sum() / size / len(x))


def main(tactus, folder):
    worst = {}

    def note(figure, difference, name):
        if abs(difference) > abs(worst.get(figure, (0.0, ""))[0]) or figure not in worst:
            worst[figure] = (difference, name)

    with tempfile.TemporaryDirectory() as scratch:
        sounds = sorted(pathlib.Path(folder).glob("*.flac")) + sorted(pathlib.Path(folder).glob("*.wav"))
        for path in sounds:
            rate, x = samples(str(path), scratch)
            spectrum = run(tactus, "spectrum", "--json", "--csv", scratch + "/psd.csv", "--envelope", "300:1500", str(path))
            row = spectrum["rows"][0]
            channel, psd = row["channels"][0], row["psd"]
            table = numpy.loadtxt(scratch + "/psd.csv", delimiter=",", skiprows=1)
            _, wanted = signal.welch(x, rate, "hann", psd["segment"], psd["overlap"], detrend="constant")
            note("PSD, dB (bins within 80 dB of the strongest)",
                 numpy.abs(10 * numpy.log10(table[1:, 1] / wanted[1:]))[wanted[1:] > 1e-8 * wanted.max()].max(), path.name)
            note("rms, %", 100 * (channel["rms"] / x.std() - 1), path.name)
            whole = numpy.abs(numpy.fft.rfft(x - x.mean())) ** 2 * 2 / len(x) ** 2
            f = numpy.fft.rfftfreq(len(x), 1 / rate)
            total = 0.0
            for band in channel["bands"]:
                low, high = band["hz"] * 10 ** -0.05, band["hz"] * 10 ** 0.05
                total += band["rms"] ** 2
                power = whole[(f >= low) & (f < high)].sum()
                if power > 1e-4 * x.var() and band["hz"] > 40:
                    note("bands, third octaves, dB (within 40 dB of the whole, above 40 Hz)",
                         band["rms_db"] - 10 * math.log10(power), path.name)
            inside = whole[(f >= channel["bands"][0]["hz"] * 10 ** -0.05) & (f < channel["bands"][-1]["hz"] * 10 ** 0.05)]
            note("sum of the bands, dB", 10 * math.log10(total / inside.sum()), path.name)
            exposure = run(tactus, "exposure", "--json", "--full-scale", "49 m/s^2", "--duration", "2", str(path))
            one = exposure["operations"][0]
            note("weighted acceleration a_hw, %", 100 * (one["a_hw"][0] / weighted(49 * x, rate) - 1), path.name)
            note("weighting by filter, %", 100 * (one["a_hw_filter"][0] / weighted(49 * x, rate) - 1), path.name)
            note("A(8), %", 100 * (exposure["a8"] / (weighted(49 * x, rate) * 0.5) - 1), path.name)
            sos = signal.butter(4, [300, 1500], "bandpass", fs=rate, output="sos")
            envelope = numpy.abs(signal.hilbert(signal.sosfilt(sos, x)))
            ef, ep = signal.welch(envelope, rate, "hann", rate, rate // 2)
            lines = [line for line in channel["envelope"] if line["hz"] > 20]
            if lines:
                line = max(lines, key=lambda l: l["rms"])
                near = (ef > line["hz"] - 3) & (ef < line["hz"] + 3)
                note("envelope, strongest line, Hz", line["hz"] - ef[near][ep[near].argmax()], path.name)
            noisy, extra = scratch + "/noisy.wav", numpy.random.default_rng(1).standard_normal(len(x)) * x.std()
            wavfile.write(scratch + "/clean.wav", rate, x.astype("float32"))
            wavfile.write(noisy, rate, (x + extra).astype("float32"))
            pair = run(tactus, "compare", "--json", scratch + "/clean.wav", noisy)["pairs"][0]
            if pair["coherence_mean"] is not None:
                down = signal.resample_poly(x, 8000, rate), signal.resample_poly(x + extra, 8000, rate)
                cf, coherence = signal.coherence(*down, 8000, "hann", 2048, 1024)
                _, power = signal.welch(down[0], 8000, "hann", 2048, 1024)
                band = (cf >= 40) & (cf <= 1000)
                band &= power > 1e-4 * power[band].max()
                note("coherence, mean of the band", pair["coherence_mean"] - coherence[band].mean(), path.name)
            turns = run(tactus, "orders", "--json", "--rate", "100", "--orders", "10", str(path))["channels"][0]
            if int(len(x) / rate * 100) >= 32:
                segment = int(round(0.32 * rate))
                of, op = signal.welch(x, rate, "flattop", segment, segment * 3 // 4, scaling="spectrum", detrend="constant")
                for order in turns["orders"][:5]:
                    wanted_rms = math.sqrt(numpy.interp(100 * order["order"], of, op))
                    if wanted_rms > 0.02 * x.std():
                        note("orders 1 to 5 of 100 Hz, dB", 20 * math.log10(order["rms"] / wanted_rms), path.name)
        for path in sorted(pathlib.Path(folder).glob("*.csv")):
            with open(path, newline="") as file:
                rows = list(csv.DictReader(file))
            for channel in run(tactus, "spectrum", "--json", str(path))["rows"][0]["channels"]:
                raw = numpy.array([float(row[channel["name"]]) for row in rows])
                note("rms of a log against its rows, %", 100 * (channel["rms"] / raw.std() - 1),
                     path.name + " " + channel["name"])
        print("| figure | reference | largest difference | record |\n|---|---|---|---|")
        for figure, (difference, name) in worst.items():
            print(f"| {figure} | {REFERENCES[figure.split()[0]]} | {difference:.2g} | {name} |")
        print("\n| record | fundamental by eye, Hz | found, Hz | confidence |\n|---|---|---|---|")
        for path in sounds + sorted(pathlib.Path(folder).glob("*.csv")):
            if path.stem not in MARKS:
                continue
            mark = MARKS[path.stem]
            for channel in run(tactus, "spectrum", "--json", str(path))["rows"][0]["channels"]:
                found = channel["fundamental_hz"]
                certain = channel["fundamental"]["certain"]
                print(f"| {path.name} {channel['name'] if path.suffix == '.csv' else ''} | "
                      f"{'none' if mark is None else f'{mark[0]}, {mark[1]} to {mark[2]}'} | "
                      f"{'none' if found is None else f'{found:.1f}'} | "
                      f"{channel['confidence']:.2f}{'' if certain or found is None else ', uncertain'} |")


main(*sys.argv[1:])

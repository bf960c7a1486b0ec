# SPDX-License-Identifier: Apache-2.0
"""Analyses of records in memory, by libtactus: arrays in, arrays and plain values out. They release the interpreter's lock."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._library import call, doubles
from .errors import Error


class Comparison(NamedTuple):
    """What `tactus compare` finds of two vibrations. NaN: not known of these two."""

    delay: float  #: s by which the output lags the reference; NaN: they were not recorded together
    correlation: float  #: of the waveforms at that delay
    lowest: float  #: Hz, of the band of all that follows
    highest: float  #: Hz
    reference_rms: float
    output_rms: float
    gain_db: float  #: that gives the output the reference's power
    spectral_distance_db: float
    spectral_cosine: float  #: 1: equal spectra
    touch_cosine: float  #: weighted by how well touch perceives each frequency
    touch_gap_db: float
    spectrogram_similarity: float
    st_sim: float
    spqi: float
    signal_to_noise_db: float
    coherence: float
    reference_hz: float  #: fundamental; 0: none
    output_hz: float


class Exposure(NamedTuple):
    """Vibration exposure of the hand, ISO 5349-1; accelerations in m/s²."""

    weighted: tuple[float, float, float]  #: a_hw of each axis
    total: float  #: a_hv
    a8: float  #: A(8) of the day
    seconds_to_action: float  #: a day until 2.5 m/s² A(8); inf: never
    seconds_to_limit: float  #: a day until 5 m/s² A(8)


def _record(samples: ArrayLike, what: str) -> np.ndarray:
    array = np.asarray(samples)
    if array.dtype.kind not in "fiub":
        raise Error(f"the {what} holds {array.dtype}, not numbers")
    array = np.ascontiguousarray(array, dtype=np.float64)
    if array.ndim == 2 and 1 in array.shape:
        array = array.reshape(-1)
    if array.ndim != 1:
        raise Error(f"the {what} has the shape {array.shape}; give one column of it, n samples")
    return array


def spectrum(samples: ArrayLike, rate: float, segment: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Power spectral density of n samples at `rate` Hz: (frequencies in Hz, density in unit²/Hz), as scipy.signal.welch with
    Hann segments that overlap by half. `segment`: samples; 0: 0.75 s, or as long as eight of them fit."""
    record = _record(samples, "record")
    if segment < 0:
        raise Error("a segment has at least one sample")
    arguments = doubles(record), len(record), rate, segment
    count = call("spectrum", *arguments, None, None, 0)
    frequencies, density = np.empty(count), np.empty(count)
    call("spectrum", *arguments, doubles(frequencies), doubles(density), count)
    return frequencies, density


def compare(reference: ArrayLike, output: ArrayLike, rate: float, output_rate: float | None = None) -> Comparison:
    """How like the output is to the reference: n and m samples at `rate` and `output_rate` Hz, at least 0.5 s of each."""
    first, second = _record(reference, "reference"), _record(output, "output")
    found = _library.Comparison()
    call("compare", doubles(first), len(first), rate, doubles(second), len(second),
         rate if output_rate is None else output_rate, ctypes.byref(found))
    return Comparison(*(getattr(found, name) for name in Comparison._fields))


def exposure(acceleration: ArrayLike, rate: float, seconds_a_day: float = 8 * 3600.0) -> Exposure:
    """Exposure of a hand to accelerations in m/s², an array (n, 3) at `rate` Hz, for so many seconds a day."""
    axes = np.asarray(acceleration)
    if axes.ndim != 2 or axes.shape[1] != 3:
        raise Error(f"the accelerations have the shape {axes.shape}; give (n, 3), a column for each axis")
    columns = [_record(axes[:, axis], "record of an axis") for axis in range(3)]
    found = _library.Exposure()
    pointers = (ctypes.POINTER(ctypes.c_double) * 3)(*(doubles(column) for column in columns))
    call("hand_arm_exposure", pointers, len(axes), rate, seconds_a_day, ctypes.byref(found))
    return Exposure(tuple(found.weighted), found.total, found.a8, found.seconds_to_action, found.seconds_to_limit)

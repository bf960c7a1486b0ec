// SPDX-License-Identifier: Apache-2.0
// The angle of a machine over time: from a tachometer, a ridge in the spectrum, or a known rate.
#pragma once

#include "dsp/geometry/spline.hpp"
#include "dsp/signal/spectrum/fft.hpp"

#include <complex>
#include <cstddef>
#include <span>

namespace tactus::signal {

/// Time (s from the first sample) as a smooth function of revolutions.
using Rotation = geometry::Spline;

/// Rising crossings of the middle between the tachometer's low and high level, with a hysteresis of a tenth of their
/// distance; `pulses` per revolution. The time of an edge that is steeper than a sample is known to a sample only, of
/// which the difference between two pulses would make a wrong rate: such times are smoothed as far as that uncertainty
/// accounts for. Throws Error for fewer than four.
Rotation rotation_from_tacho(std::span<const double> tacho, double rate, double pulses);

/// The same for a channel that comes in pieces; `low` and `high` are its extremes.
class TachoStream {
public:
    TachoStream(double low, double high, double rate)
        : middle_(0.5 * (low + high)), hysteresis_(0.1 * (high - low)), steep_edge_(0.8 * (high - low)), rate_(rate) {}
    void push(std::span<const double> tacho);
    /// Throws Error for fewer than four pulses.
    Rotation rotation(double pulses) const;

private:
    double middle_, hysteresis_, steep_edge_, rate_, before_ = 0.0;
    std::size_t count_ = 0, steep_ = 0;  // samples; edges within one sample
    bool armed_ = false;
    std::vector<double> times_;
};

/// A constant rate in Hz over `seconds`.
Rotation rotation_at(double frequency, double seconds);

struct RidgeSettings {
    double lowest = 20.0, highest = 400.0;  ///< Hz: range of the rate
    int orders = 5;  ///< number of orders expected to be strong together
    double frame = 0.25;  ///< s
    double max_change = 0.08;  ///< greatest relative change of the rate per quarter frame
};

struct Ridge {
    std::vector<double> time, frequency;  ///< s, Hz, one per quarter frame
    /// Mean over time of the orders' level above the rest of their frame, dB.
    double prominence_db = 0.0;

    Rotation rotation(double seconds) const;
};

/// `track_ridge` for a record that comes in pieces: the path is chosen minute by minute, each continuing the previous
/// one.
class RidgeStream {
public:
    /// Throws Error for settings that are invalid.
    RidgeStream(double rate, const RidgeSettings& settings);

    void push(std::span<const double> samples);
    /// Throws Error when the record was shorter than two frames.
    Ridge finish();

private:
    void track(std::size_t frames);
    double power_of(std::span<const double> samples);

    double rate_;
    RidgeSettings settings_;
    std::size_t frame_, hop_, max_frames_, done_ = 0, top_;
    double bins_per_hz_, grid_;
    std::vector<double> candidates_, score_, next_, window_, held_, x_, power_, sorted_;
    std::vector<std::complex<double>> spectrum_;
    RealFft<double> fft_;
    Ridge ridge_;
};

/// Ridge tracking: the path of the rate with the strongest orders (dynamic programming on a logarithmic grid, then
/// refined between grid points). Throws Error when the record is shorter than two frames.
Ridge track_ridge(std::span<const double> record, double rate, const RidgeSettings& settings);

}  // namespace tactus::signal

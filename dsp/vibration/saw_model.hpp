// SPDX-License-Identifier: Apache-2.0
// A parametric model of a saw's vibration: orders that are locked to the stroke, and a residual (noise through an
// all-pole filter) whose level varies over the stroke. Its parameters are interpolated between the recorded conditions.
#pragma once

#include "dsp/vibration/saw_voice.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::vibration {

/// Sizes of every model.
struct SawModelSize {
    static constexpr std::size_t max_orders = 40;
    static constexpr std::size_t lines = 36;  ///< order of the residual's filter
    static constexpr std::size_t swells = 4;  ///< orders of the residual's power over the stroke
    static constexpr double residual_rate = 8000.0;  ///< Hz: the residual is modelled up to 3.2 kHz
};

/// Sound of one condition, in the unit of the recordings.
struct SawSound {
    std::array<double, SawModelSize::max_orders> orders{};  ///< rms of order 1, 2, …
    double residual = 0.0;  ///< rms
    /// Line spectral frequencies, rad per sample at `residual_rate`.
    std::array<double, SawModelSize::lines> lines{};
    /// Power of the residual's excitation over the blade's phase φ: 1 + Σ cos[m] cos(m φ) + sin[m] sin(m φ), m = 1, 2, …
    std::array<double, SawModelSize::swells> swell_cos{}, swell_sin{};
};

struct SawCondition {
    double rate = 0.0;  ///< strokes per second, Hz
    bool cutting = false;
    double load = 0.0;  ///< thrust, N; 0 in free air
    double density = 0.0;  ///< of the bone, kg/m³; 0: unknown
    SawSound sound;
};

struct SawModel {
    std::vector<SawCondition> conditions;
    /// Phase of each order in every condition, rad at phase 0 of the blade: Σ √2 orders[k] cos((k + 1) φ + phases[k]).
    std::array<double, SawModelSize::max_orders> phases{};

    static constexpr std::size_t max_conditions = SawVoice::max_recordings;
};

/// Fits one condition per recording. The rate is refined within ±2 %. Orders: Hann-weighted Fourier sums over 32
/// strokes, their power less that of the noise between the orders. Residual: what remains, at `residual_rate`, by
/// Burg's method. Phases: those of the recording with the strongest orders, to which the others are aligned.
/// Throws Error as SawVoice::prepare does. Allocates.
SawModel fit_saw_model(std::span<const SawRecording> recordings);

}  // namespace tactus::vibration

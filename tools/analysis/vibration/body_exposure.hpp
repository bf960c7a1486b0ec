// SPDX-License-Identifier: Apache-2.0
// Vibration exposure of the whole body from records: health (ISO 2631-1) and comfort in trains (ISO 2631-4).
#pragma once

#include "dsp/signal/exposure/whole_body.hpp"
#include "tools/analysis/vibration/exposure.hpp"

namespace tactus::analysis {

/// Vibration of one seat or floor during a day.
struct BodyOperation {
    struct Axis {
        std::string channel;
        signal::BodyAxis axis;
        signal::BodyAxisVibration vibration;
        double filtered = 0.0;  ///< a_w by filter, m/s²; that of the vibration is by transform
    };
    std::string file;
    signal::BodyJudgement judgement = signal::BodyJudgement::health;
    sound::ReadStretch stretch;
    std::vector<Axis> axes;
    double rate = 0.0, duration = 0.0;  ///< Hz; s per day
    bool calibrated = false;
    sound::Calibration calibration;
    std::optional<sound::LogFacts> log;
    double band_high = signal::weighting_k.highest;  ///< Hz
    std::size_t clipped = 0;  ///< samples
    std::vector<std::string> notes;

    /// √(Σ a_w²) of the axes without factors: of all three, the vibration total value of comfort.
    double total() const;
    /// True when axes or a part of the band are missing, or samples are clipped or lost: values are then lower bounds.
    bool is_lower_bound() const { return band_high < 80.0 || axes.size() < 3 || clipped > 0 || is_incomplete(log); }
};

/// As `analyse_exposure`, for the whole body. Throws Error, also if the axes of the channels are unknown.
BodyOperation analyse_body_exposure(const std::filesystem::path& file, const ExposureSettings& settings,
                                    signal::BodyJudgement judgement, double duration,
                                    const std::function<void(double)>& progress);

/// Exposure of a day: the maxima of k·A(8) and of k·VDV over the axes (directive 2002/44/EC, annex, part B). Health
/// only.
struct BodyDay {
    double a8 = 0.0, dose = 0.0;  ///< m/s², m/s^1.75
    signal::BodyAxis a8_axis = signal::BodyAxis::z, dose_axis = signal::BodyAxis::z;
    bool has_shocks = false;  ///< the rms is not sufficient: the worse of both verdicts applies
    bool is_lower_bound = false;
    ExposureVerdict by_rms = ExposureVerdict::cannot_be_judged, by_dose = ExposureVerdict::cannot_be_judged;

    ExposureVerdict verdict() const noexcept;
};

/// Empty if the durations exceed a day.
std::optional<BodyDay> body_day(std::span<const BodyOperation> operations);

}  // namespace tactus::analysis

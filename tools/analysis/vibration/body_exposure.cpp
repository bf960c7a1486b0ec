// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/body_exposure.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace tactus::analysis {

namespace {

using signal::BodyAxis;

/// The axis that ends the name of a channel, as in "x", "accel_y" or "az".
std::optional<BodyAxis> axis_of(const std::string& name) {
    std::string letters = name;
    for (char& c : letters) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (letters.empty() || letters.back() < 'x' || letters.back() > 'z') return std::nullopt;
    const bool is_alone = letters.size() == 1 ||
                          !std::isalpha(static_cast<unsigned char>(letters[letters.size() - 2])) ||
                          (letters.size() == 2 && letters.front() == 'a');
    if (!is_alone) return std::nullopt;
    return static_cast<BodyAxis>(letters.back() - 'x');
}

std::vector<BodyAxis> axes_of(const std::string& given, const std::vector<std::string>& names,
                              const std::string& file) {
    std::vector<BodyAxis> axes;
    if (!given.empty()) {
        for (const char c : given)
            if (c >= 'x' && c <= 'z') axes.push_back(static_cast<BodyAxis>(c - 'x'));
        if (axes.size() != given.size() || axes.size() != names.size())
            throw Error(fmt::format("--axes must have a letter, x, y or z, for each of the {} channels of {}, not '{}'",
                                    names.size(), file, given));
    } else {
        for (const std::string& name : names)
            if (const std::optional<BodyAxis> axis = axis_of(name)) axes.push_back(*axis);
        if (axes.size() != names.size()) {
            if (names.size() != 3)
                throw Error(
                    fmt::format("{}: the names of the channels do not end in x, y or z; state the axis of each "
                                "with --axes, such as --axes z (z is along the spine)",
                                file));
            axes = {BodyAxis::x, BodyAxis::y, BodyAxis::z};
        }
    }
    for (std::size_t i = 0; i < axes.size(); ++i)
        if (std::find(axes.begin(), axes.begin() + static_cast<std::ptrdiff_t>(i), axes[i]) !=
            axes.begin() + static_cast<std::ptrdiff_t>(i))
            throw Error(fmt::format("{}: two channels are of one axis; choose channels with --channel", file));
    return axes;
}

/// The worse of two verdicts; "cannot be judged" is worse than "below", as it may hide any other.
ExposureVerdict worse(ExposureVerdict a, ExposureVerdict b) noexcept {
    constexpr std::array order{ExposureVerdict::below_action, ExposureVerdict::cannot_be_judged,
                               ExposureVerdict::above_action, ExposureVerdict::at_least_above_action,
                               ExposureVerdict::above_limit};
    return std::ranges::find(order, a) < std::ranges::find(order, b) ? b : a;
}

}  // namespace

double BodyOperation::total() const {
    double sum = 0.0;
    for (const Axis& one : axes) sum += one.vibration.rms * one.vibration.rms;
    return std::sqrt(sum);
}

BodyOperation analyse_body_exposure(const std::filesystem::path& file, const ExposureSettings& settings,
                                    signal::BodyJudgement judgement, double duration,
                                    const std::function<void(double)>& progress) {
    OpenAcceleration record = open_acceleration(file, settings);
    const sound::RecordReader& reader = record.reader;
    BodyOperation out;
    out.file = file.string();
    out.judgement = judgement;
    out.stretch = reader.stretch();
    out.rate = reader.rate();
    out.duration = duration;
    out.calibrated = reader.calibration().known;
    out.calibration = reader.calibration();
    out.log = reader.log();
    out.band_high = std::min(signal::weighting_k.highest, record.usable);
    std::vector<std::string> names;
    for (const std::size_t channel : record.channels) names.push_back(reader.channels()[channel]);
    const std::vector<BodyAxis> axes = axes_of(settings.axes, names, out.file);
    std::vector<const signal::Weighting*> weightings;
    for (const BodyAxis axis : axes) weightings.push_back(&signal::body_weighting(judgement, axis));
    double seconds = 0.0;
    for (const WeightedChannel& one : weight_channels(record, weightings, progress)) {
        const signal::WeightedRecord& weighted = one.record;
        seconds = weighted.seconds();
        out.axes.push_back(
            {one.name,
             axes[out.axes.size()],
             {weighted.by_transform(), weighted.peak(), weighted.max_running_rms(), weighted.dose(), seconds},
             weighted.by_filter()});
        out.clipped += one.clipped;
        if (one.clipped > 0)
            out.notes.push_back(
                fmt::format("axis {} is clipped in {} samples: the value is too low", one.name, one.clipped));
    }
    note_lost(out.log, out.notes);
    if (!out.calibrated) out.notes.push_back("uncalibrated: the values are interpreted as m/s^2");
    if (out.band_high < 80.0)
        out.notes.push_back(
            fmt::format("the record ends at {:.0f} Hz, below 80 Hz: the values are lower bounds", out.band_high));
    if (out.axes.size() < 3)
        out.notes.push_back(fmt::format("{} of three axes: the values are lower bounds", out.axes.size()));
    if (out.rate < 16.0 * signal::weighting_k.high)
        out.notes.push_back(
            "below 1.6 kHz sample rate the filter of VDV, MTVV and peak deviates from the standard by more than 0.5 %; "
            "a_w is by transform of the record, which does not");
    if (seconds < 227.0)
        out.notes.push_back(fmt::format("{:.0f} s of measurement; for 0.5 Hz the standard requires 227 s", seconds));
    return out;
}

ExposureVerdict BodyDay::verdict() const noexcept { return has_shocks ? worse(by_rms, by_dose) : by_rms; }

std::optional<BodyDay> body_day(std::span<const BodyOperation> operations) {
    BodyDay day;
    std::array<double, 3> squares{}, fourths{};
    double seconds = 0.0;
    for (const BodyOperation& one : operations) {
        seconds += one.duration;
        day.is_lower_bound = day.is_lower_bound || one.is_lower_bound();
        for (const BodyOperation::Axis& axis : one.axes) {
            const double k = signal::body_factor(one.judgement, axis.axis);
            const auto i = static_cast<std::size_t>(axis.axis);
            squares[i] += std::pow(k * axis.vibration.rms, 2.0) * one.duration;
            fourths[i] += std::pow(k * axis.vibration.dose_of(one.duration), 4.0);
            day.has_shocks = day.has_shocks || axis.vibration.has_shocks();
        }
    }
    if (seconds > 24.0 * 3600.0) return std::nullopt;
    const auto strongest_rms = std::ranges::max_element(squares), strongest_dose = std::ranges::max_element(fourths);
    day.a8_axis = static_cast<BodyAxis>(strongest_rms - squares.begin());
    day.dose_axis = static_cast<BodyAxis>(strongest_dose - fourths.begin());
    day.a8 = std::sqrt(*strongest_rms / signal::reference_day);
    day.dose = std::pow(*strongest_dose, 0.25);
    day.by_rms = judge_exposure(day.a8, signal::whole_body_limits, day.is_lower_bound);
    day.by_dose = judge_exposure(day.dose, signal::whole_body_dose_limits, day.is_lower_bound);
    return day;
}

}  // namespace tactus::analysis

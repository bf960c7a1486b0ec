// SPDX-License-Identifier: Apache-2.0
#include "tools/study/vibration/exposure.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::study {

ExposureOperation analyse_exposure(const std::filesystem::path& file, const ExposureSettings& settings, double duration,
                                   const std::function<void(double)>& progress) {
    sound::RecordReader reader = open_record(file, settings.record);
    const sound::Calibration& calibration = reader.calibration();
    if (!calibration.known && !settings.uncalibrated)
        throw Error(
            fmt::format("{}: the record is not calibrated; give the value of full scale with --full-scale \"49 "
                        "m/s^2\", or interpret its values as m/s^2 with --uncalibrated{}{}",
                        file.string(), calibration.remark.empty() ? "" : "; ", calibration.remark));
    if (calibration.known && !calibration.is_acceleration)
        throw Error(fmt::format("{}: exposure needs an acceleration, not {}", file.string(), calibration.unit));
    const std::vector<std::size_t> chosen = chosen_channels(reader, file, settings.record);
    if (chosen.size() > 3)
        throw Error(fmt::format("{}: {} channels; choose the axes with --channel", file.string(), chosen.size()));
    ExposureOperation out;
    out.file = file.string();
    out.stretch = reader.stretch();
    out.rate = reader.rate();
    out.duration = duration;
    out.calibrated = calibration.known;
    out.calibration = calibration;
    out.log = reader.log();
    out.three_axes = chosen.size() == 3;
    const double nyquist = reader.log() ? std::min(0.5 * out.rate, reader.log()->usable) : 0.5 * out.rate;
    out.band_high = std::min(signal::hand_arm_highest, nyquist);

    std::vector<double> scaled;
    std::vector<signal::Level> levels(chosen.size());
    std::size_t count = 0;
    sound::RecordBlock block;
    const auto read = [&](double from, const auto& use) {
        reader.rewind();
        std::size_t done = 0;
        while (reader.next(block)) {
            for (std::size_t i = 0; i < chosen.size(); ++i) {
                scaled = block.channels[chosen[i]];
                for (double& x : scaled) x *= calibration.si;
                use(i, scaled);
            }
            done += block.size();
            progress(from +
                     0.5 * static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, reader.frames())));
        }
        count = done;
    };
    read(0.0, [&](std::size_t i, const std::vector<double>& samples) { levels[i].push(samples); });
    std::vector<signal::WeightedRecord> records;
    for (const signal::Level& level : levels) records.emplace_back(out.rate, level.mean());
    read(0.5, [&](std::size_t i, const std::vector<double>& samples) {
        if (block.after_gap) records[i].end_piece();
        records[i].push(samples);
    });
    for (signal::WeightedRecord& record : records) record.end_piece();
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        out.axes.push_back(reader.channels()[chosen[i]]);
        out.weighted.push_back(records[i].by_transform());
        out.filtered.push_back(records[i].by_filter());
        const std::size_t clipped =
            std::max(levels[i].clipped(), reader.log() ? reader.log()->at_limit[chosen[i]] : std::size_t{0});
        out.clipped += clipped;
        if (clipped > 0)
            out.notes.push_back(
                fmt::format("axis {} is clipped in {} samples: the value is too low", out.axes.back(), clipped));
    }
    if (!out.calibrated) out.notes.push_back("uncalibrated: the values are interpreted as m/s^2");
    if (out.band_high < 1250.0)
        out.notes.push_back(
            fmt::format("the record ends at {:.0f} Hz, below 1250 Hz: the values are lower bounds", out.band_high));
    if (!out.three_axes)
        out.notes.push_back(
            fmt::format("{} of three axes: there is no total value a_hv; A(8) and minutes are computed from these axes "
                        "only and are bounds",
                        out.axes.size()));
    if (out.rate < 20000.0)
        out.notes.push_back(
            "below 20 kHz sample rate the filter deviates from the standard by more than 0.5 %; what counts is the "
            "transform of the record, which does not");
    const double minutes = static_cast<double>(count) / out.rate / 60.0;
    if (minutes < 1.0) out.notes.push_back("the standard requires at least one minute of measurement in total");
    return out;
}

ExposureVerdict judge_exposure(double a8, bool is_lower_bound) noexcept {
    if (a8 > signal::limit_value) return ExposureVerdict::above_limit;
    if (a8 > signal::action_value)
        return is_lower_bound ? ExposureVerdict::at_least_above_action : ExposureVerdict::above_action;
    return is_lower_bound ? ExposureVerdict::cannot_be_judged : ExposureVerdict::below_action;
}

std::optional<double> exposure_of_day(std::span<const ExposureOperation> operations) {
    std::vector<signal::HandArmOperation> day;
    double seconds = 0.0;
    for (const ExposureOperation& one : operations) {
        day.push_back({one.total(), one.duration});
        seconds += one.duration;
    }
    if (seconds > 24.0 * 3600.0) return std::nullopt;
    return signal::daily_exposure(day);
}

}  // namespace tactus::study

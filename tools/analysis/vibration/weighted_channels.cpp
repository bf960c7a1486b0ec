// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/weighted_channels.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/level.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::analysis {

bool is_incomplete(const std::optional<sound::LogFacts>& log) { return log && log->lost_fraction > max_lost_fraction; }

void note_lost(const std::optional<sound::LogFacts>& log, std::vector<std::string>& notes) {
    if (is_incomplete(log))
        notes.push_back(
            fmt::format("{:.3g} % of the record is missing, more than {:g} %: the values are those of the rest, which "
                        "cannot show that exposure is below an action or limit value",
                        100.0 * log->lost_fraction, 100.0 * max_lost_fraction));
}

OpenAcceleration open_acceleration(const std::filesystem::path& file, const ExposureSettings& settings) {
    OpenAcceleration out{open_record(file, settings.record), {}, 0.0};
    const sound::Calibration& calibration = out.reader.calibration();
    if (!calibration.known && !settings.uncalibrated)
        throw Error(
            fmt::format("{}: the record is not calibrated; give the value of full scale with --full-scale \"49 "
                        "m/s^2\", or interpret its values as m/s^2 with --uncalibrated{}{}",
                        file.string(), calibration.remark.empty() ? "" : "; ", calibration.remark));
    if (calibration.known && !calibration.is_acceleration)
        throw Error(fmt::format("{}: exposure needs an acceleration, not {}", file.string(), calibration.unit));
    out.channels = chosen_channels(out.reader, file, settings.record);
    if (out.channels.size() > 3)
        throw Error(fmt::format("{}: {} channels; choose the axes with --channel", file.string(), out.channels.size()));
    out.usable = 0.5 * out.reader.rate();
    if (out.reader.log()) out.usable = std::min(out.usable, out.reader.log()->usable);
    return out;
}

std::vector<WeightedChannel> weight_channels(OpenAcceleration& record,
                                             const std::vector<const signal::Weighting*>& weightings,
                                             const std::function<void(double)>& progress) {
    sound::RecordReader& reader = record.reader;
    const double si = reader.calibration().si;
    std::vector<double> scaled;
    sound::RecordBlock block;
    const auto read = [&](double from, const auto& use) {
        reader.rewind();
        std::size_t done = 0;
        while (reader.next(block)) {
            for (std::size_t i = 0; i < record.channels.size(); ++i) {
                scaled = block.channels[record.channels[i]];
                for (double& x : scaled) x *= si;
                use(i, scaled);
            }
            done += block.size();
            progress(from +
                     0.5 * static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, reader.frames())));
        }
    };
    std::vector<signal::Level> levels(record.channels.size());
    read(0.0, [&](std::size_t i, const std::vector<double>& samples) { levels[i].push(samples); });
    std::vector<WeightedChannel> out;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const std::size_t channel = record.channels[i];
        out.push_back({reader.channels()[channel],
                       {*weightings[i], reader.rate(), levels[i].mean()},
                       std::max(levels[i].clipped(), reader.log() ? reader.log()->at_limit[channel] : std::size_t{0})});
    }
    read(0.5, [&](std::size_t i, const std::vector<double>& samples) {
        if (block.after_gap) out[i].record.end_piece();
        out[i].record.push(samples);
    });
    for (WeightedChannel& one : out) one.record.end_piece();
    return out;
}

}  // namespace tactus::analysis

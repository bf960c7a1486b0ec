// SPDX-License-Identifier: Apache-2.0
#include "tools/run/take_file.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "dsp/signal/spectrum/level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::run {

namespace {

constexpr double worth_a_note = 1e-4;  // fraction of clipped samples

}  // namespace

std::size_t ChannelLevels::strongest() const {
    return static_cast<std::size_t>(std::max_element(rms.begin(), rms.end()) - rms.begin());
}

ChannelLevels channel_levels(const std::filesystem::path& file, const table::LogSelection& log,
                             const sound::Stretch& stretch) {
    sound::RecordReader reader(file, log, std::nullopt, std::nullopt, stretch);
    ChannelLevels out{reader.channels(), std::vector<double>(reader.channels().size())};
    if (out.names.size() == 1) return out;
    std::vector<signal::Level> levels(out.names.size());
    sound::RecordBlock block;
    while (reader.next(block))
        for (std::size_t c = 0; c < levels.size(); ++c) levels[c].push(block.channels[c]);
    for (std::size_t c = 0; c < levels.size(); ++c) out.rms[c] = levels[c].rms();
    return out;
}

namespace {

/// A stated scale counts more than what the file states.
std::optional<sound::Calibration> stated_scale(const TakeChoice& choice) {
    if (choice.scale == 1.0) return std::nullopt;
    sound::Calibration scale;
    scale.factor = choice.scale;
    scale.unit = "unit of the scale";
    return scale;
}

}  // namespace

TakeFile::TakeFile(const TakeChoice& choice)
    : choice_(choice),
      reader_(std::make_shared<sound::RecordReader>(choice.file, choice.log, stated_scale(choice), std::nullopt,
                                                    choice.stretch)) {
    const std::string& role = choice.role;
    const sound::Calibration& calibration = reader_->calibration();
    is_calibrated_ = calibration.known;
    if (calibration.known) {
        factor_ = calibration.si;
        notes_.push_back(fmt::format("the {} is in {}, from {}", role, calibration.unit, calibration.source));
    }
    if (!calibration.remark.empty()) notes_.push_back(fmt::format("the {}: {}", role, calibration.remark));
    if (!(choice.scale > 0.0) || !std::isfinite(choice.scale))
        throw Error(fmt::format("the scale of the {} must be above 0", role));
    const std::size_t channels = reader_->channels().size();
    if (static_cast<std::size_t>(choice.channel) > channels)
        throw Error(fmt::format("{}: has {} channels; channel {} does not exist", choice.file.string(), channels,
                                choice.channel));
    sound::RecordBlock block;
    std::vector<double> mixed;
    std::vector<std::size_t> pieces{0};
    signal::Level level, longest;
    while (reader_->next(block)) {
        if (block.after_gap) {
            pieces.push_back(0);
            level = {};
        }
        mix(block, mixed);
        level.push(mixed);
        pieces.back() += mixed.size();
        if (pieces.back() < frames_) continue;
        longest = level;
        piece_ = pieces.size() - 1;
        frames_ = pieces.back();
    }
    peak_ = longest.largest();
    if (choice.channel == 0 && channels > 1)
        notes_.push_back(fmt::format("the {} is the mean of {} channels", role, channels));
    if (reader_->log())
        for (const std::string& missing : reader_->log()->missing())
            notes_.push_back(fmt::format("the {}: {}", role, missing));
    if (pieces.size() > 1)
        notes_.push_back(fmt::format("the {}: only the longest of its {} parts is compared, {}", role,
                                     pieces.size(), readable(static_cast<double>(frames_) / rate(), "s")));
    if (reader_->log())
        notes_.push_back(fmt::format("the {} is a log with {} rows per second, reliable to about {:.0f} Hz; read as {}",
                                     role, plain(rate()), reader_->log()->usable,
                                     table::describe(reader_->log()->form)));
    double share = static_cast<double>(longest.clipped()) / static_cast<double>(std::max<std::size_t>(1, frames_));
    if (reader_->log() && choice.channel > 0)
        share = std::max(share,
                         static_cast<double>(reader_->log()->at_limit[static_cast<std::size_t>(choice.channel - 1)]) /
                             static_cast<double>(reader_->log()->rows));
    if (share > worth_a_note)
        notes_.push_back(
            fmt::format("the {} is clipped: {:.2g} % of its samples are at the limits", role, 100.0 * share));
}

void TakeFile::mix(const sound::RecordBlock& block, std::vector<double>& out) const {
    const std::size_t channels = block.channels.size();
    const std::size_t first = choice_.channel == 0 ? 0 : static_cast<std::size_t>(choice_.channel) - 1;
    out = block.channels[first];
    if (choice_.channel == 0)
        for (std::size_t c = 1; c < channels; ++c)
            for (std::size_t i = 0; i < out.size(); ++i) out[i] += block.channels[c][i];
    const double factor = factor_ / (choice_.channel == 0 ? static_cast<double>(channels) : 1.0);
    for (double& x : out) x *= factor;
}

signal::Take TakeFile::take() const {
    signal::Take take(rate(), frames_, [this] {
        reader_->rewind();
        return [this, block = sound::RecordBlock(), mixed = std::vector<double>(),
                piece = std::size_t{0}]() mutable -> std::span<const double> {
            while (reader_->next(block)) {
                if (block.after_gap) ++piece;
                if (piece < piece_) continue;
                if (piece > piece_) break;
                mix(block, mixed);
                return mixed;
            }
            return {};
        };
    });
    if (reader_->log()) take.usable = std::min(take.usable, reader_->log()->usable);
    return take;
}

}  // namespace tactus::run

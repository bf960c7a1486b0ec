// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/waterfall.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::analysis {

namespace {

constexpr std::size_t max_speeds = 60;  // rows against speed
constexpr double min_change = 1.05;    // highest over lowest rate
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

signal::WelchSettings welch_of(const WaterfallSettings& settings, const signal::OrderStream& stream, double rate,
                               std::size_t frames) {
    signal::WelchSettings welch;
    welch.scaling = signal::Scaling::spectrum;
    if (settings.of_orders) {
        welch.rate = static_cast<double>(stream.per_turn());
        welch.segment = std::min<std::size_t>(16, stream.turns() / 2 * 2) * stream.per_turn();
    } else {
        welch.rate = rate;
        welch.window = signal::WindowKind::flat_top;
        welch.segment = std::bit_floor(
            static_cast<std::size_t>(std::max(16.0, std::min(0.25 * rate, static_cast<double>(frames)))));
    }
    welch.overlap = welch.segment / 2;
    return welch;
}

/// Up to a little above the highest order.
std::size_t columns_of(const WaterfallSettings& settings, const signal::WelchSettings& welch,
                       const signal::Rotation& rotation, int highest) {
    const double end = (highest + 0.5) * (settings.of_orders ? 1.0 : signal::highest_rate(rotation));
    return static_cast<std::size_t>(end * static_cast<double>(welch.segment) / welch.rate) + 1;
}

double turn_at(const signal::Rotation& rotation, double time) {
    double low = rotation.first(), high = rotation.last();
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (rotation(middle).value < time ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Means of the powers of all rows in each of evenly spaced ranges of the rate.
std::vector<WaterfallRow> by_rate(const std::vector<WaterfallRow>& rows) {
    double lowest = rows.front().rate, highest = lowest;
    for (const WaterfallRow& row : rows) lowest = std::min(lowest, row.rate), highest = std::max(highest, row.rate);
    if (highest < min_change * lowest)
        throw Error(fmt::format("the rate hardly changes, {:.2f} to {:.2f} Hz: draw the waterfall --against time",
                                lowest, highest));
    const std::size_t ranges = std::clamp<std::size_t>(rows.size() / 2, 2, max_speeds);
    std::vector<WaterfallRow> out;
    for (std::size_t i = 0; i < ranges; ++i) {
        const double width = (highest - lowest) / static_cast<double>(ranges),
                     from = lowest + width * static_cast<double>(i);
        WaterfallRow mean{nothing, 0.0, std::vector<float>(rows.front().rms.size())};
        std::vector<double> power(mean.rms.size());
        std::size_t count = 0;
        for (const WaterfallRow& row : rows) {
            if (row.rate < from || (row.rate >= from + width && i + 1 < ranges)) continue;
            ++count;
            mean.rate += row.rate;
            for (std::size_t k = 0; k < power.size(); ++k) power[k] += std::pow(static_cast<double>(row.rms[k]), 2);
        }
        if (count == 0) continue;
        mean.rate /= static_cast<double>(count);
        for (std::size_t k = 0; k < power.size(); ++k)
            mean.rms[k] = static_cast<float>(std::sqrt(power[k] / static_cast<double>(count)));
        out.push_back(std::move(mean));
    }
    return out;
}

}  // namespace

WaterfallStream::WaterfallStream(const WaterfallSettings& settings, const signal::OrderStream& stream,
                                 const signal::Rotation& rotation, double rate, std::size_t frames, int highest,
                                 double begin)
    : settings_(settings),
      rotation_(rotation),
      rate_(rate),
      first_turn_(stream.first_turn()),
      per_turn_(static_cast<double>(stream.per_turn())),
      begin_(begin),
      step_([&] {
          const signal::WelchSettings welch = welch_of(settings, stream, rate, frames);
          return welch.rate / static_cast<double>(welch.segment);
      }()),
      rows_(welch_of(settings, stream, rate, frames), settings.of_orders ? stream.turns() * stream.per_turn() : frames,
            columns_of(settings, welch_of(settings, stream, rate, frames), rotation, highest)) {}

void WaterfallStream::push(std::span<const double> samples, std::span<const double> turned) {
    rows_.push(settings_.of_orders ? turned : samples);
}

Waterfall WaterfallStream::finish() const {
    Waterfall out{settings_, step_, {}};
    for (std::size_t i = 0; i < rows_.rows().size(); ++i) {
        const auto from = static_cast<double>(i * rows_.hop()), to = from + static_cast<double>(rows_.length());
        double times[3], turns[3];  // of begin, middle and end
        for (int at = 0; at < 3; ++at) {
            const double value = from + (to - from) * 0.5 * at;
            if (settings_.of_orders) {
                turns[at] = std::min(first_turn_ + value / per_turn_, rotation_.last());
                times[at] = rotation_(turns[at]).value;
            } else {
                times[at] = value / rate_;
                turns[at] = turn_at(rotation_, times[at]);
            }
        }
        // A tachometer may begin after the record does, and end before.
        const double seconds = rotation_(turns[2]).value - rotation_(turns[0]).value;
        WaterfallRow row{
            begin_ + times[1], seconds > 0.0 ? (turns[2] - turns[0]) / seconds : 1.0 / rotation_(turns[1]).slope, {}};
        const double end = settings_.of_orders ? 0.5 * rate_ / row.rate : 0.5 * rate_;
        for (std::size_t k = 0; k < rows_.rows()[i].size(); ++k)
            row.rms.push_back(static_cast<double>(k) * step_ <= end ? std::sqrt(rows_.rows()[i][k])
                                                                    : std::numeric_limits<float>::quiet_NaN());
        out.rows.push_back(std::move(row));
    }
    if (out.rows.empty()) throw Error("the record is too short for a waterfall");
    if (settings_.against_speed) out.rows = by_rate(out.rows);
    return out;
}

}  // namespace tactus::analysis

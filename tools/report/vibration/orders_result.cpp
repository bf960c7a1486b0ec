// SPDX-License-Identifier: Apache-2.0
#include "tools/report/vibration/orders_result.hpp"

#include "tools/analysis/vibration/level_reference.hpp"
#include "tools/report/figures/waterfall_figure.hpp"
#include "tools/report/vibration/record_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

using analysis::LevelReference;
using analysis::Waterfall;
using analysis::WaterfallRow;

struct Level {
    const signal::OrderLevel* of;
    LevelReference reference;
    std::string unit;

    double square() const { return 0.5 * of->amplitude * of->amplitude; }
    /// None above half the sample rate.
    std::optional<double> if_measured(double value) const {
        return of->above_nyquist ? std::nullopt : std::optional(value);
    }
};

struct Channel {
    const analysis::OrdersOfChannel* of;
    const sound::Calibration* calibration;
};

const Fields<Level>& level_fields() {
    static const Fields<Level> all =
        Fields<Level>("level of an order")
            .number("order", "order", significant(6), [](const Level& l) { return l.of->order; })
            .number("rms", "rms", prefixed(5),
                    [](const Level& l) {
                        Number number = l.if_measured(std::sqrt(l.square()));
                        number.unit = l.unit;
                        return number;
                    })
            .omitted()
            .number("amplitude", "peak", prefixed(5),
                    [](const Level& l) {
                        Number number = l.if_measured(l.of->amplitude);
                        number.unit = l.unit;
                        return number;
                    })
            .omitted()
            .number("rms_db", "rms", fixed(1, "dB"),
                    [](const Level& l) { return l.if_measured(l.reference.db(l.square())); })
            .omitted()
            .number("db", "", fixed(1, "dB"),
                    [](const Level& l) { return l.if_measured(10.0 * std::log10(std::max(l.square(), 1e-30))); })
            .omitted()
            .number("snr_db", "SNR", fixed(0, "dB"), [](const Level& l) { return l.if_measured(l.of->snr_db); })
            .omitted()
            .flag("above_nyquist", "above half the sample rate",
                  [](const Level& l) { return l.of->above_nyquist ? std::optional(true) : std::nullopt; })
            .omitted();
    return all;
}

const Fields<WaterfallRow>& waterfall_row_fields() {
    static const Fields<WaterfallRow> all =
        Fields<WaterfallRow>("levels at one time or rate")
            .number("time_s", "", significant(6, "s"), [](const WaterfallRow& r) { return r.time; })
            .number("rate_hz", "", significant(6, "Hz"), [](const WaterfallRow& r) { return r.rate; })
            .series("rms", [](const WaterfallRow& r) {
                return ResultEntry::Series{r.rms.size(), [&r](std::size_t n) { return static_cast<double>(r.rms[n]); }};
            });
    return all;
}

const Fields<Channel>& channel_fields() {
    static const Fields<Channel> all =
        Fields<Channel>("orders of one channel")
            .titled([](const Channel& c) {
                return fmt::format("channel {}, {:.0f} turns", c.of->name, c.of->spectrum.turns);
            })
            .text("name", "", [](const Channel& c) { return c.of->name; })
            .text("unit", "", [](const Channel& c) { return c.calibration->unit; })
            .flag("calibrated", "", [](const Channel& c) { return c.calibration->known; })
            .number("turns", "", fixed(0), [](const Channel& c) { return c.of->spectrum.turns; })
            .integer("segments", "segments", [](const Channel& c) { return c.of->spectrum.segments; })
            .rows("orders", "levels", level_fields(),
                  [](const Channel& c) {
                      std::vector<Level> levels;
                      for (const signal::OrderLevel& level : c.of->spectrum.orders)
                          levels.push_back({&level, analysis::level_reference(*c.calibration), c.calibration->unit});
                      return levels;
                  })
            .text("db_re", "", [](const Channel& c) { return analysis::level_reference(*c.calibration).text; })
            .child("waterfall", "", waterfall_fields(),
                   [](const Channel& c) -> const std::optional<Waterfall>& { return c.of->waterfall; })
            .omitted();
    return all;
}

const Fields<analysis::RateRange>& rate_fields() {
    using analysis::RateRange;
    static const Fields<RateRange> all =
        Fields<RateRange>("rate of the machine")
            .number("min", "", fixed(2, "Hz"), [](const RateRange& r) { return r.low; })
            .number("max", "", fixed(2, "Hz"), [](const RateRange& r) { return r.high; })
            .number("mean", "", fixed(2, "Hz"), [](const RateRange& r) { return r.mean; });
    return all;
}

/// Orders without a level, by channel.
std::vector<std::string> unmeasured(const FileOrders& f) {
    std::vector<std::string> all;
    for (const analysis::OrdersOfChannel& one : f.found->channels)
        if (const auto first = std::ranges::find(one.spectrum.orders, true, &signal::OrderLevel::above_nyquist);
            first != one.spectrum.orders.end())
            all.push_back(
                fmt::format("channel {}: order {:g} and those above it exceed half the sample rate: no levels",
                            one.name, first->order));
    return all;
}

}  // namespace

const Fields<Waterfall>& waterfall_fields() {
    static const Fields<Waterfall> all =
        Fields<Waterfall>("levels over order or frequency, row by row")
            .text("over", "", [](const Waterfall& w) { return w.settings.of_orders ? "orders" : "frequency"; })
            .text("against", "", [](const Waterfall& w) { return w.settings.against_speed ? "speed" : "time"; })
            .series("columns",
                    [](const Waterfall& w) {
                        return ResultEntry::Series{w.rows.empty() ? 0 : w.rows.front().rms.size(),
                                                   [&w](std::size_t n) { return static_cast<double>(n) * w.step; }};
                    })
            .rows("rows", "", waterfall_row_fields(),
                  [](const Waterfall& w) -> const std::vector<WaterfallRow>& { return w.rows; });
    return all;
}

const Fields<FileOrders>& orders_fields() {
    static const Fields<FileOrders> all =
        Fields<FileOrders>("orders of a machine with a changing rate")
            .titled([](const FileOrders& f) {
                return fmt::format("{}: {} from {:.2f} to {:.2f} Hz", f.file.string(), f.found->source,
                                   f.found->rate.low, f.found->rate.high);
            })
            .text("file", "", [](const FileOrders& f) { return f.file.string(); })
            .number("sample_rate_hz", "sample rate", prefixed(6, "Hz"),
                    [](const FileOrders& f) { return f.found->sample_rate; })
            .number("duration_s", "duration", fixed(3, "s"), [](const FileOrders& f) { return f.found->duration; })
            .text(
                "", "levels",
                [](const FileOrders& f) { return "dB rms re " + analysis::level_reference(f.found->calibration).text; })
            .part(record_fields(),
                  [](const FileOrders& f) {
                      return ReadRecord{f.found->stretch, f.found->calibration, f.found->log, f.found->sample_rate};
                  })
            .omitted()
            .text("source", "rate from", [](const FileOrders& f) { return f.found->source; })
            .child("rate_hz", "", rate_fields(),
                   [](const FileOrders& f) -> const analysis::RateRange& { return f.found->rate; })
            .number("", "mean rate", fixed(2, "Hz"), [](const FileOrders& f) { return f.found->rate.mean; })
            .number("ridge_prominence_db", "prominence of the ridge", fixed(1, "dB"),
                    [](const FileOrders& f) {
                        return f.found->source == "ridge" ? std::optional(f.found->prominence_db) : std::nullopt;
                    })
            .omitted()
            .figure(
                "levels row by row",
                [](const FileOrders& f) {
                    return !f.found->channels.empty() && f.found->channels.front().waterfall.has_value();
                },
                [](const FileOrders& f, const FigureStyle& style) { return draw_waterfall(*f.found, f.file, style); })
            .warnings("", unmeasured)
            .children("channels", "channel", channel_fields(), [](const FileOrders& f) {
                std::vector<Channel> channels;
                for (const analysis::OrdersOfChannel& one : f.found->channels)
                    channels.push_back({&one, &f.found->calibration});
                return channels;
            });
    return all;
}

}  // namespace tactus::report

// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/orders.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/filter/resample.hpp"
#include "dsp/signal/spectrum/fundamental.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

namespace tactus::analysis {

namespace {

constexpr double min_prominence_db = 6.0;  // noise alone reaches 5

RateRange rates_of(const signal::Rotation& rotation) {
    const double turns = rotation.last() - rotation.first();
    RateRange rates{1e300, 0.0, turns / (rotation(rotation.last()).value - rotation(rotation.first()).value)};
    for (int i = 0; i <= 1000; ++i)
        rates.low = std::min(rates.low, 1.0 / rotation(rotation.first() + turns * i / 1000.0).slope);
    rates.high = signal::highest_rate(rotation);
    return rates;
}

/// The selected channels without the tachometer.
std::vector<std::size_t> wanted_channels(const sound::RecordReader& reader, const OrdersSettings& settings) {
    std::vector<std::size_t> wanted;
    const std::vector<int>& asked_for = settings.record.channels;
    for (std::size_t i = 0; i < reader.channels().size(); ++i) {
        const int channel = static_cast<int>(i) + 1;
        const bool asked =
            asked_for.empty() || std::find(asked_for.begin(), asked_for.end(), channel) != asked_for.end();
        if (asked && channel != settings.tacho) wanted.push_back(i);
    }
    return wanted;
}

/// Reads the record from its start; calls use(block).
template <class Use>
void read_all(sound::RecordReader& reader, const Use& use) {
    reader.rewind();
    sound::RecordBlock block;
    while (reader.next(block)) {
        if (block.after_gap) throw Error("the record has gaps; cut out the part to analyse");
        use(block);
    }
}

signal::Rotation rotation_of_tacho(sound::RecordReader& reader, const OrdersSettings& settings) {
    if (static_cast<std::size_t>(settings.tacho) > reader.channels().size())
        throw Error(fmt::format("there is no channel {} with a tachometer", settings.tacho));
    const auto channel = static_cast<std::size_t>(settings.tacho - 1);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    read_all(reader, [&](const sound::RecordBlock& block) {
        for (const double x : block.channels[channel]) low = std::min(low, x), high = std::max(high, x);
    });
    if (!(low <= high)) throw Error("the tachometer channel is empty");
    signal::TachoStream tacho(low, high, reader.rate());
    read_all(reader, [&](const sound::RecordBlock& block) { tacho.push(block.channels[channel]); });
    return tacho.rotation(settings.pulses);
}

/// The rate as it varies, near the fundamental of the record where that is certain.
signal::Rotation rotation_of_ridge(sound::RecordReader& reader, std::size_t channel, const OrdersSettings& settings,
                                   Orders& out) {
    const double rate = reader.rate();
    signal::RidgeSettings ridge_settings;
    std::tie(ridge_settings.lowest, ridge_settings.highest) = settings.range.value_or(OrdersSettings::usual_range);
    if (!settings.range) {
        signal::FundamentalStream fundamental(rate, reader.frames());
        read_all(reader, [&](const sound::RecordBlock& block) { fundamental.push(block.channels[channel]); });
        if (const signal::FundamentalEstimate found = fundamental.estimate(); found.is_certain()) {
            // Beyond the middle 80 % of its path the rate goes further, but a steady one not to its double or half.
            const double beyond = found.steady ? 1.4 : 1.3;
            ridge_settings.lowest = found.low / beyond;
            ridge_settings.highest = found.high * beyond;
            // A frame holds enough periods to resolve neighbouring orders.
            ridge_settings.frame = std::max(ridge_settings.frame, 8.0 / ridge_settings.lowest);
        }
    }
    // A lower sample rate holds all the orders that are tracked.
    const double enough = 2.56 * 1.2 * ridge_settings.orders * ridge_settings.highest;
    std::optional<signal::ResamplingStream> thinned;
    if (rate > 1.5 * enough) thinned.emplace(reader.frames(), rate, enough);
    signal::RidgeStream ridge(thinned ? enough : rate, ridge_settings);
    std::vector<double> values;
    read_all(reader, [&](const sound::RecordBlock& block) {
        const std::span<const double> samples = block.channels[channel];
        if (!thinned) {
            ridge.push(samples);
            return;
        }
        values.clear();
        thinned->push(samples, values);
        ridge.push(values);
    });
    const signal::Ridge found = ridge.finish();
    out.prominence_db = found.prominence_db;
    if (found.prominence_db < min_prominence_db)
        throw Error("no rate can be tracked in the record; state it with --rate, or give a --tacho channel");
    return found.rotation(out.duration);
}

/// The rotation; sets its source in `out`.
signal::Rotation rotation_of(sound::RecordReader& reader, std::size_t channel, const OrdersSettings& settings,
                             Orders& out) {
    if (settings.tacho > 0) {
        out.source = "tachometer";
        return rotation_of_tacho(reader, settings);
    }
    if (settings.fixed) {
        out.source = "fixed";
        return signal::rotation_at(*settings.fixed, out.duration);
    }
    out.source = "ridge";
    return rotation_of_ridge(reader, channel, settings, out);
}

}  // namespace

Orders analyse_orders(const std::filesystem::path& file, const OrdersSettings& settings) {
    sound::RecordReader reader = open_record(file, settings.record);
    chosen_channels(reader, file, settings.record);  // refuses channels that there are not
    Orders out;
    out.sample_rate = reader.rate();
    out.duration = static_cast<double>(reader.frames()) / reader.rate();
    out.calibration = reader.calibration();
    out.stretch = reader.stretch();
    out.log = reader.log();
    try {
        const std::vector<std::size_t> wanted = wanted_channels(reader, settings);
        if (wanted.empty()) throw Error("there is no channel beside the tachometer");
        const signal::Rotation rotation = rotation_of(reader, wanted.front(), settings, out);
        out.rate = rates_of(rotation);
        out.highest = settings.highest;
        std::vector<signal::OrderStream> streams(
            wanted.size(), signal::OrderStream(reader.rate(), reader.frames(), rotation, settings.highest));
        std::vector<WaterfallStream> waterfalls;
        if (settings.waterfall)
            for (const signal::OrderStream& stream : streams)
                waterfalls.emplace_back(*settings.waterfall, stream, rotation, reader.rate(), reader.frames(),
                                        settings.highest, out.stretch.from);
        read_all(reader, [&](const sound::RecordBlock& block) {
            for (std::size_t i = 0; i < wanted.size(); ++i) {
                streams[i].push(block.channels[wanted[i]]);
                if (settings.waterfall) waterfalls[i].push(block.channels[wanted[i]], streams[i].turned());
            }
        });
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            OrdersOfChannel& channel = out.channels.emplace_back();
            channel.name = reader.channels()[wanted[i]];
            channel.spectrum = streams[i].spectrum();
            if (!settings.waterfall) continue;
            waterfalls[i].push({}, streams[i].turned());
            channel.waterfall = waterfalls[i].finish();
        }
    } catch (const Error& error) {
        if (error.message().starts_with(file.string())) throw;
        throw Error(fmt::format("{}: {}", file.string(), error.message()));
    }
    return out;
}

}  // namespace tactus::analysis

// SPDX-License-Identifier: Apache-2.0
#include "tools/study/vibration/orders.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::study {

namespace {

constexpr double least_prominence_db = 6.0;  // noise alone reaches 5

RateRange rates_of(const signal::Rotation& rotation) {
    const double turns = rotation.last() - rotation.first();
    RateRange rates{1e300, 0.0, turns / (rotation(rotation.last()).value - rotation(rotation.first()).value)};
    for (int i = 0; i <= 1000; ++i) {
        const double rate = 1.0 / rotation(rotation.first() + turns * i / 1000.0).slope;
        rates.low = std::min(rates.low, rate);
        rates.high = std::max(rates.high, rate);
    }
    return rates;
}

/// The selected channels without the tachometer.
std::vector<std::size_t> wanted_channels(const WholeRecord& record, const OrdersSettings& settings) {
    std::vector<std::size_t> wanted;
    const std::vector<int>& asked_for = settings.record.channels;
    for (std::size_t i = 0; i < record.channels.size(); ++i) {
        const int channel = static_cast<int>(i) + 1;
        const bool asked = settings.tacho == 0 || asked_for.empty() ||
                           std::find(asked_for.begin(), asked_for.end(), channel) != asked_for.end();
        if (asked && channel != settings.tacho) wanted.push_back(i);
    }
    return wanted;
}

/// The rotation; sets its source in `out`.
signal::Rotation rotation_of(const WholeRecord& record, const OrdersSettings& settings, Orders& out) {
    if (settings.tacho > 0) {
        out.source = "tachometer";
        if (static_cast<std::size_t>(settings.tacho) > record.channels.size())
            throw Error(fmt::format("there is no channel {} with a tachometer", settings.tacho));
        return signal::rotation_from_tacho(record.channels[static_cast<std::size_t>(settings.tacho - 1)], record.rate,
                                           settings.pulses);
    }
    if (settings.fixed) {
        out.source = "fixed";
        return signal::rotation_at(*settings.fixed, out.duration);
    }
    out.source = "ridge";
    signal::RidgeSettings ridge_settings;
    std::tie(ridge_settings.lowest, ridge_settings.highest) = settings.range;
    const signal::Ridge ridge = signal::track_ridge(record.channels.front(), record.rate, ridge_settings);
    out.prominence_db = ridge.prominence_db;
    if (ridge.prominence_db < least_prominence_db)
        throw Error("no rate can be tracked in the record; state it with --rate, or give a --tacho channel");
    return ridge.rotation(out.duration);
}

}  // namespace

Orders analyse_orders(const std::filesystem::path& file, const OrdersSettings& settings) {
    RecordSettings reading = settings.record;
    if (settings.tacho > 0) reading.channels.clear();
    const WholeRecord record = read_whole(file, reading);
    Orders out;
    out.sample_rate = record.rate;
    out.duration = static_cast<double>(record.channels.front().size()) / record.rate;
    out.calibration = record.calibration;
    const std::vector<std::size_t> wanted = wanted_channels(record, settings);
    try {
        const signal::Rotation rotation = rotation_of(record, settings, out);
        if (wanted.empty()) throw Error("there is no channel beside the tachometer");
        out.rate = rates_of(rotation);
        for (const std::size_t i : wanted)
            out.channels.push_back(
                {record.names[i], signal::order_spectrum(record.channels[i], record.rate, rotation, settings.highest)});
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", file.string(), error.message()));
    }
    return out;
}

}  // namespace tactus::study

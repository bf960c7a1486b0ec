// SPDX-License-Identifier: Apache-2.0
// Levels of the orders of a machine whose rate changes.
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/order/order_spectrum.hpp"
#include "tools/session/summary.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tactus {

using Json = nlohmann::ordered_json;

namespace {

constexpr double least_prominence_db = 6.0;  // noise alone comes to 5

struct Rates {
    double low = 0.0, high = 0.0, mean = 0.0;  // Hz
};

Rates rates_of(const Rotation& rotation) {
    const double turns = rotation.last() - rotation.first();
    Rates rates{1e300, 0.0, turns / (rotation(rotation.last()).value - rotation(rotation.first()).value)};
    for (int i = 0; i <= 1000; ++i) {
        const double rate = 1.0 / rotation(rotation.first() + turns * i / 1000.0).slope;
        rates.low = std::min(rates.low, rate);
        rates.high = std::max(rates.high, rate);
    }
    return rates;
}

}  // namespace

int orders_verb(const OrdersChoice& choice) {
    if (choice.files.size() != 1) throw Error("orders takes one file");
    const std::filesystem::path& file = choice.files.front();
    RecordOptions all = choice;
    all.channels.clear();
    const WholeRecord record = read_whole(file, choice.tacho > 0 ? all : static_cast<const RecordOptions&>(choice));
    const double seconds = static_cast<double>(record.channels.front().size()) / record.rate;
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < record.channels.size(); ++i) {
        const int channel = static_cast<int>(i) + 1;
        const bool asked = choice.tacho == 0 || choice.channels.empty() ||
                           std::find(choice.channels.begin(), choice.channels.end(), channel) != choice.channels.end();
        if (asked && channel != choice.tacho) wanted.push_back(i);
    }
    std::string source;
    double prominence = 0.0;
    const auto rotation = [&]() -> Rotation {
        if (choice.tacho > 0) {
            source = "tachometer";
            if (static_cast<std::size_t>(choice.tacho) > record.channels.size())
                throw Error(fmt::format("there is no channel {} with a tachometer", choice.tacho));
            return rotation_from_tacho(record.channels[static_cast<std::size_t>(choice.tacho - 1)], record.rate,
                                       choice.pulses);
        }
        if (choice.fixed) {
            source = "fixed";
            return rotation_at(*choice.fixed, seconds);
        }
        source = "ridge";
        RidgeSettings settings;
        std::tie(settings.lowest, settings.highest) = parse_band(choice.range, "--range");
        const Ridge ridge = track_ridge(record.channels.front(), record.rate, settings);
        prominence = ridge.prominence_db;
        if (prominence < least_prominence_db)
            throw Error("no rate can be followed in the record; state it with --rate, or give a --tacho channel");
        return ridge.rotation(seconds);
    };
    try {
        const Rotation turned = rotation();
        if (wanted.empty()) throw Error("there is no channel beside the tachometer");
        const Rates rates = rates_of(turned);
        Json json{{"file", file.string()},
                  {"sample_rate_hz", record.rate},
                  {"duration_s", seconds},
                  {"source", source},
                  {"rate_hz", {{"min", rates.low}, {"max", rates.high}, {"mean", rates.mean}}},
                  {"channels", Json::array()}};
        if (source == "ridge") json["ridge_prominence_db"] = prominence;
        std::string text =
            fmt::format("{}: {} from {:.2f} to {:.2f} Hz\n", file.string(), source, rates.low, rates.high);
        std::string csv = "order";
        std::vector<OrderSpectrum> spectra;
        for (const std::size_t i : wanted) {
            spectra.push_back(order_spectrum(record.channels[i], record.rate, turned, choice.highest));
            const OrderSpectrum& spectrum = spectra.back();
            Json channel{
                {"name", record.names[i]}, {"unit", record.calibration.unit}, {"calibrated", record.calibration.known},
                {"turns", spectrum.turns}, {"segments", spectrum.segments},   {"orders", Json::array()}};
            text += fmt::format("  channel {}, {:.0f} turns\n", record.names[i], spectrum.turns);
            for (const OrderLevel& level : spectrum.orders) {
                channel["orders"].push_back(
                    {{"order", level.order},
                     {"amplitude", level.amplitude},
                     {"db", 20.0 * std::log10(std::max(level.amplitude / std::sqrt(2.0), 1e-15))},
                     {"snr_db", level.snr_db}});
                text += fmt::format("    order {:3g}  {:.5g} {}  SNR {:.0f} dB\n", level.order, level.amplitude,
                                    record.calibration.unit, level.snr_db);
            }
            json["channels"].push_back(channel);
            csv += "," + record.names[i];
        }
        if (!choice.csv.empty()) {
            csv += '\n';
            for (std::size_t k = 0; k < spectra.front().amplitude.size(); ++k) {
                csv += fmt::format("{}", static_cast<double>(k) * spectra.front().step);
                for (const OrderSpectrum& spectrum : spectra) csv += fmt::format(",{}", spectrum.amplitude[k]);
                csv += '\n';
            }
            write_whole_file(choice.csv, csv);
        }
        fmt::print("{}", choice.json ? json.dump(2) + "\n" : text);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", file.string(), error.message()));
    }
    return done;
}

}  // namespace tactus

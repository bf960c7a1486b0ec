// SPDX-License-Identifier: Apache-2.0
// From a measured response to a filter that undoes it, and what the actuator's limits say to it.
#include "assets/equaliser/equaliser_file.hpp"
#include "assets/response/response_file.hpp"
#include "assets/sound/sound.hpp"
#include "dsp/filter/fir.hpp"
#include "dsp/filter/resample.hpp"
#include "dsp/vibration/actuator.hpp"
#include "dsp/vibration/headroom.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tactus {

using Json = nlohmann::ordered_json;

namespace {

double decibel(double ratio) { return 20.0 * std::log10(ratio); }

/// The chain of actuator and equaliser within the band, by third octaves.
struct Flatness {
    double before_db = 0.0, after_db = 0.0;  ///< greatest deviation from the mean gain
    double boost_db = -400.0, boost_hz = 0.0;
    struct Band {
        double hz, filter_db, loudest;  ///< `loudest`: peak of what the actuator can make of a sine there
    };
    std::vector<Band> bands;
};

Flatness flatness(const FrequencyResponse& response, const Equaliser& equaliser, double drive_limit) {
    Flatness result;
    for (int n = 0; n <= 40; ++n) {
        const double hz = std::pow(10.0, n / 10.0);
        if (hz < 0.99 * equaliser.lowest || hz > 1.01 * equaliser.highest) continue;
        const double plant = std::abs(interpolate(response, std::span(&hz, 1)).front());
        const double filter = std::abs(equaliser.gain(hz));
        result.before_db = std::max(result.before_db, std::abs(decibel(plant / equaliser.mean_gain)));
        result.after_db = std::max(result.after_db, std::abs(decibel(plant * filter / equaliser.mean_gain)));
        if (decibel(filter) > result.boost_db) result.boost_db = decibel(filter), result.boost_hz = hz;
        result.bands.push_back({hz, decibel(filter), drive_limit * plant});
    }
    return result;
}

struct Programme {
    Headroom plain, equalised;
};

/// The recording at the drive, without and with the equaliser.
Programme play(const EqualiseChoice& choice, const Equaliser& equaliser, double limit) {
    const Sound sound = load_sound(choice.signal);
    const std::vector<double> samples = resample(mix_to_mono(sound), sound.rate, equaliser.rate);
    std::vector<double> plain, equalised;
    Fir fir(equaliser.taps);
    const double volts = choice.volts * choice.scale;
    for (const double x : samples) {
        plain.push_back(volts * x);
        equalised.push_back(volts * static_cast<double>(fir(static_cast<float>(x))));
    }
    return {headroom(plain, equaliser.rate, limit), headroom(equalised, equaliser.rate, limit)};
}

Json headroom_json(const Headroom& h) {
    Json json{{"peak_v", h.peak}, {"headroom_db", h.headroom_db}, {"limited_fraction", h.limited_fraction}};
    json["lost"] = Json::array();
    for (const BandLoss& loss : h.losses) json["lost"].push_back({{"hz", loss.hz}, {"db", loss.lost_db}});
    return json;
}

void print_headroom(const char* name, const Headroom& h, double limit) {
    fmt::print("  {}  peak {:.3f} V, {}\n", name, h.peak,
               h.headroom_db >= 0.0
                   ? fmt::format("{:.1f} dB below the limit of {:g} V", h.headroom_db, limit)
                   : fmt::format("{:.1f} dB above the limit of {:g} V: {:.2g} % of the samples are cut; play it "
                                 "{:.1f} dB softer",
                                 -h.headroom_db, limit, 100.0 * h.limited_fraction, -h.headroom_db));
    for (const BandLoss& loss : h.losses)
        fmt::print("                 the band at {:.0f} Hz loses {:.1f} dB\n", loss.hz, loss.lost_db);
}

}  // namespace

int equalise_verb(const EqualiseChoice& choice) {
    const ActuatorModel& actuator = find_actuator(choice.actuator);
    if (!(choice.volts != 0.0 && std::isfinite(choice.volts) && choice.scale > 0.0 && std::isfinite(choice.scale)))
        throw Error("--volts and --scale are numbers other than 0");
    const ResponseFile file = load_response(choice.response);
    const FrequencyResponse& response = file.identified.response;
    EqualiserDesign design;
    design.kind = choice.kind == "linear" ? EqualiserKind::linear_phase : EqualiserKind::minimum_phase;
    design.rate = choice.rate;
    design.lowest = choice.lowest;
    design.highest = choice.highest;
    design.length = choice.length;
    design.greatest_gain = std::pow(10.0, choice.greatest_boost_db / 20.0);
    design.regularisation = choice.regularisation;
    Equaliser equaliser = design_equaliser(response, design);
    equaliser.unit = file.unit;

    const double limit = voltage_within(actuator.voltage_limit, actuator.current_limit, actuator.resistance);
    const Flatness flat = flatness(response, equaliser, limit / std::abs(choice.volts));
    std::optional<Programme> programme;
    if (!choice.signal.empty()) programme = play(choice, equaliser, limit);
    save_equaliser(equaliser, file.title.empty() ? choice.response.stem().string() : file.title, choice.out);

    if (choice.json) {
        Json json{{"equaliser", choice.out.string()},
                  {"kind", choice.kind},
                  {"rate_hz", equaliser.rate},
                  {"delay_s", equaliser.delay},
                  {"taps", equaliser.taps.size()},
                  {"band_hz", {equaliser.lowest, equaliser.highest}},
                  {"mean_gain", equaliser.mean_gain},
                  {"unit", equaliser.unit},
                  {"deviation_before_db", flat.before_db},
                  {"deviation_after_db", flat.after_db},
                  {"greatest_boost", {{"hz", flat.boost_hz}, {"db", flat.boost_db}}},
                  {"actuator", std::string(actuator.name)},
                  {"voltage_limit_v", actuator.voltage_limit},
                  {"current_limit_a", actuator.current_limit},
                  {"bands", Json::array()}};
        for (const auto& band : flat.bands)
            json["bands"].push_back({{"hz", band.hz}, {"filter_db", band.filter_db}, {"loudest_peak", band.loudest}});
        if (programme)
            json["headroom"] = {{"before", headroom_json(programme->plain)},
                                {"after", headroom_json(programme->equalised)}};
        fmt::print("{}\n", json.dump(2));
        return done;
    }
    fmt::print("{}: {} phase, {} taps at {:g} Hz, adds {:.2f} ms\n", choice.out.string(), choice.kind,
               equaliser.taps.size(), equaliser.rate, 1e3 * equaliser.delay);
    fmt::print("  deviation    from {:g} to {:g} Hz: {:.1f} dB without it, {:.1f} dB with it\n", equaliser.lowest,
               equaliser.highest, flat.before_db, flat.after_db);
    fmt::print("  boost        {:.1f} dB at most, at {:.0f} Hz\n", flat.boost_db, flat.boost_hz);
    const auto softest = std::ranges::min_element(flat.bands, {}, &Flatness::Band::loudest);
    fmt::print(
        "  limits       {}: {:g} V and {:g} A through {:g} ohm; the loudest sine is {:.3g}{}{} peak at {:.0f} Hz, "
        "where it is weakest\n",
        actuator.name, actuator.voltage_limit, actuator.current_limit, actuator.resistance, softest->loudest,
        file.unit.empty() ? "" : " ", file.unit.substr(0, file.unit.find(" per ")), softest->hz);
    if (programme) {
        print_headroom("as recorded ", programme->plain, limit);
        print_headroom("equalised   ", programme->equalised, limit);
    } else {
        fmt::print("  headroom     unknown: give --signal FILE, --scale and --volts for what will be played\n");
    }
    return done;
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
// tactus equalise: designs an inverse filter from a measured response and checks the actuator's limits.
#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/vibration/equalisation.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace tactus::command {

namespace {

using file::Json;

struct EqualiseChoice {
    analysis::EqualiseSettings settings;
    std::filesystem::path out;
    std::string kind = "minimum";
    double greatest_boost_db = 20.0;
    bool json = false;
};

Json headroom_json(const vibration::Headroom& h) {
    Json json{{"peak_v", h.peak}, {"headroom_db", h.headroom_db}, {"limited_fraction", h.limited_fraction}};
    json["lost"] = Json::array();
    for (const vibration::BandLoss& loss : h.losses) json["lost"].push_back({{"hz", loss.hz}, {"db", loss.lost_db}});
    return json;
}

void print_headroom(const char* name, const vibration::Headroom& h, double limit) {
    fmt::print("  {}  peak {:.3f} V, {}\n", name, h.peak,
               h.headroom_db >= 0.0
                   ? fmt::format("{:.1f} dB below the limit of {:g} V", h.headroom_db, limit)
                   : fmt::format("{:.1f} dB above the limit of {:g} V: {:.2g} % of the samples are cut; play it "
                                 "{:.1f} dB softer",
                                 -h.headroom_db, limit, 100.0 * h.limited_fraction, -h.headroom_db));
    for (const vibration::BandLoss& loss : h.losses)
        fmt::print("                 the band at {:.0f} Hz loses {:.1f} dB\n", loss.hz, loss.lost_db);
}

int equalise(const EqualiseChoice& choice) {
    analysis::EqualiseSettings settings = choice.settings;
    settings.design.kind =
        choice.kind == "linear" ? vibration::EqualiserKind::linear_phase : vibration::EqualiserKind::minimum_phase;
    settings.design.greatest_gain = std::pow(10.0, choice.greatest_boost_db / 20.0);
    const analysis::Equalisation made = analysis::equalise(settings);
    sound::save_equaliser(made.equaliser, made.title.empty() ? settings.response.stem().string() : made.title,
                          choice.out);
    const vibration::Equaliser& equaliser = made.equaliser;
    const analysis::Flatness& flat = made.flat;
    const vibration::ActuatorModel& actuator = *made.actuator;
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
                  {"deviation_after_hz", flat.after_hz},
                  {"loudest_sine", {{"hz", flat.loudest_hz}, {"peak", flat.loudest}}},
                  {"greatest_boost", {{"hz", flat.boost_hz}, {"db", flat.boost_db}}},
                  {"actuator", std::string(actuator.name)},
                  {"voltage_limit_v", actuator.voltage_limit},
                  {"current_limit_a", actuator.current_limit},
                  {"bands", Json::array()}};
        for (const auto& band : made.flat.bands)
            json["bands"].push_back({{"hz", band.hz}, {"filter_db", band.filter_db}, {"loudest_peak", band.loudest}});
        if (made.programme)
            json["headroom"] = {{"before", headroom_json(made.programme->plain)},
                                {"after", headroom_json(made.programme->equalised)}};
        fmt::print("{}\n", json.dump(2));
        return done;
    }
    fmt::print("{}: {} phase, {} taps at {:g} Hz, adds {:.2f} ms\n", choice.out.string(), choice.kind,
               equaliser.taps.size(), equaliser.rate, 1e3 * equaliser.delay);
    fmt::print("  deviation    from {:g} to {:g} Hz: {:.1f} dB without it, {:.1f} dB with it, at {:.0f} Hz\n",
               equaliser.lowest, equaliser.highest, flat.before_db, flat.after_db, flat.after_hz);
    fmt::print("  boost        {:.1f} dB at most, at {:.0f} Hz\n", flat.boost_db, flat.boost_hz);
    fmt::print(
        "  limits       {}: {:g} V and {:g} A through {:g} ohm; the loudest sine is {:.3g}{}{} peak at {:.0f} Hz, "
        "where it is weakest\n",
        actuator.name, actuator.voltage_limit, actuator.current_limit, actuator.resistance, flat.loudest,
        made.unit.empty() ? "" : " ", made.unit.substr(0, made.unit.find(" per ")), flat.loudest_hz);
    if (made.programme) {
        print_headroom("as recorded ", made.programme->plain, made.limit);
        print_headroom("equalised   ", made.programme->equalised, made.limit);
    } else {
        fmt::print("  headroom     unknown: give --signal FILE, --scale and --volts for what will be played\n");
    }
    return done;
}

Action declare_equalise(VerbOptions& verb) {
    const auto choice = std::make_shared<EqualiseChoice>();
    analysis::EqualiseSettings& settings = choice->settings;
    vibration::EqualiserDesign& design = settings.design;
    verb.add("response", settings.response, "file of 'tactus measure', or a table of Hz, dB and degrees").required();
    verb.add("-o,--out", choice->out, "TOML file for the filter").required();
    verb.add("--kind", choice->kind,
             "minimum: minimum phase, adds at most 2 ms; linear: also corrects the phase, adds half its length")
        .shows_default()
        .one_of({"minimum", "linear"});
    verb.add("--rate", design.rate, "sample rate of the node that will use the filter, Hz").unit("Hz").shows_default();
    verb.band("--band", design.lowest, design.highest, "band to be made flat, Hz");
    verb.add("--from", design.lowest, "lower limit of the band, Hz").hidden();
    verb.add("--to", design.highest, "upper limit of the band, Hz").hidden();
    verb.add("--length", design.length, "length of the impulse response, s").unit("s").shows_default();
    verb.add("--max-boost", choice->greatest_boost_db, "greatest gain of the filter, dB")
        .shows_default()
        .range(0.0, 60.0);
    verb.add("--regularisation", design.regularisation,
             "fraction of the mean power gain below which the filter does not boost")
        .shows_default()
        .range(0.0, 1.0);
    verb.add("--actuator", settings.actuator, "actuator with the voltage and current limits").shows_default();
    verb.add("--volts", settings.volts, "drive voltage per unit of the response's input").shows_default();
    verb.add("--signal", settings.signal, "a recording to check against the limits");
    verb.add("--scale", settings.scale, "units of the response's input per full scale of the recording")
        .shows_default();
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return equalise(*choice); };
}

}  // namespace

Verb equalise_verb() {
    return {"equalise", "make a filter for the 'equaliser' node from a measured response", declare_equalise};
}

}  // namespace tactus::command

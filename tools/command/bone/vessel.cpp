// SPDX-License-Identifier: Apache-2.0
// tactus vessel: follows a vessel in a scan from one seed.
#include "tools/analysis/bone/vessel.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/bone/scan_options.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/bone/scan_result.hpp"
#include "tools/report/figures/straightened_picture.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

namespace tactus::command {

namespace {

struct VesselChoice {
    analysis::VesselSettings settings;
    std::string seed, leg, tibia, fibula;
    std::filesystem::path straightened;
    ResultChoice result;
    double min_mm = 0.4, max_mm = 20.0, max_length_mm = 2000.0;
    std::optional<double> bone_above;
    bool trunk_only = false;
};

/// "X,Y,Z" in mm → m.
Vec3 parse_place(const std::string& text, const std::string& option) {
    std::vector<double> numbers;
    std::size_t start = 0;
    while (start <= text.size()) {
        const std::size_t comma = std::min(text.find(',', start), text.size());
        const std::string word = text.substr(start, comma - start);
        std::size_t used = 0;
        double value = std::nan("");
        try {
            value = std::stod(word, &used);
        } catch (const std::exception&) {
        }
        constexpr double farthest_mm = 1e5;
        if (used == 0 || used != word.size() || !(std::abs(value) <= farthest_mm))
            throw Error(fmt::format("{}: '{}' is not X,Y,Z in mm, as in 7.8,-179.2,753.2 (LPS)", option, text));
        numbers.push_back(value * 1e-3);
        start = comma + 1;
    }
    if (numbers.size() != 3)
        throw Error(fmt::format("{}: '{}' is not X,Y,Z in mm, as in 7.8,-179.2,753.2 (LPS)", option, text));
    return {numbers[0], numbers[1], numbers[2]};
}

/// "X,Y,Z:X,Y,Z" → two places.
std::pair<Vec3, Vec3> parse_axis(const std::string& text, const std::string& option) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos)
        throw Error(fmt::format("{}: '{}' is not TOP:BOTTOM, each X,Y,Z in mm (LPS)", option, text));
    return {parse_place(text.substr(0, colon), option), parse_place(text.substr(colon + 1), option)};
}

std::optional<vessel::LegGeometry> leg_of(const VesselChoice& choice) {
    if (choice.leg.empty() && choice.tibia.empty() && choice.fibula.empty()) return std::nullopt;
    if (choice.leg.empty() || choice.tibia.empty() || choice.fibula.empty())
        throw Error("the run-off of a leg needs --leg, --tibia and --fibula");
    vessel::LegGeometry leg;
    leg.is_right = choice.leg == "right";
    std::tie(leg.tibia_top, leg.tibia_bottom) = parse_axis(choice.tibia, "--tibia");
    std::tie(leg.fibula_top, leg.fibula_bottom) = parse_axis(choice.fibula, "--fibula");
    return leg;
}

int follow(const VesselChoice& given) {
    VesselChoice choice = given;
    analysis::VesselSettings& settings = choice.settings;
    settings.seed = parse_place(choice.seed, "--seed");
    settings.leg = leg_of(choice);
    check_result_files(choice.result, {settings.scan}, {choice.straightened});
    settings.out = choice.result.products();
    settings.track.min_radius = choice.min_mm * 1e-3;
    settings.track.max_radius = choice.max_mm * 1e-3;
    settings.track.max_length = choice.max_length_mm * 1e-3;
    settings.track.exclude_above = choice.bone_above;
    settings.track.branches = !choice.trunk_only;
    if (choice.min_mm >= choice.max_mm) throw Error("--min-radius must be below --max-radius");
    settings.straightened = choice.straightened;
    const analysis::FoundVessel result = analysis::follow_vessel(settings);
    const vessel::Track& track = result.found.track;
    if (result.straightened)
        report::write_picture(*result.straightened, track.background, track.contrast, choice.straightened);
    write_result(report::vessel_track_fields().of({settings.seed, &result}), choice.result);
    return !track.branches.empty() && track.doubts.empty() ? done : answer_is_no;
}

Action declare_vessel(VerbOptions& verb) {
    const auto choice = std::make_shared<VesselChoice>();
    verb.add("scan", choice->settings.scan, "CT or MR angiography, in a format of import").required();
    verb.add("--seed", choice->seed, "a place in the vessel, mm, LPS").required().value_name("X,Y,Z");
    add_result_options(verb, choice->result, ResultFigure::none,
                       {{".csv", ".vtp", ".mrk.json", ".stl", ".ply"}, "the centre line, or tubes"});
    verb.output("--straightened", choice->straightened, {{".png"}}, "a PNG of the seed's branch pulled straight");
    verb.add("--min-radius", choice->min_mm, "least radius of a vessel, mm")
        .unit("mm")
        .shows_default()
        .range(0.1, 20.0);
    verb.add("--max-radius", choice->max_mm, "greatest radius of a vessel, mm")
        .unit("mm")
        .shows_default()
        .range(0.2, 40.0);
    verb.add("--max-length", choice->max_length_mm, "greatest length of a branch from its start, mm")
        .unit("mm")
        .shows_default()
        .range(5.0, 10000.0);
    verb.add("--bone-above", choice->bone_above,
             "value above which something is bone or a stent (default: from the brightness of the vessel)");
    verb.flag("--no-branches", choice->trunk_only, "follow the seed's vessel alone");
    verb.add("--leg", choice->leg, "judge the arteries of this lower leg").one_of({"left", "right"});
    verb.add("--tibia", choice->tibia, "middle of the tibia's plateau and of the ankle's surface, mm, LPS")
        .value_name("X,Y,Z:X,Y,Z");
    verb.add("--fibula", choice->fibula, "head of the fibula and tip of the lateral malleolus, mm, LPS")
        .value_name("X,Y,Z:X,Y,Z");
    verb.add("--series", choice->settings.series,
             "DICOM: the series to read, by its UID or the end of it; several between commas are joined");
    add_unit(verb, choice->settings.unit);
    return [choice] { return follow(*choice); };
}

}  // namespace

Verb vessel_verb() {
    return {.name = "vessel", .about = "follow a vessel in a scan from one seed", .add = declare_vessel, .schema = [] {
                return report::schema_of_output({report::vessel_track_fields().schema()});
            }};
}

}  // namespace tactus::command

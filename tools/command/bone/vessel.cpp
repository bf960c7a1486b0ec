// SPDX-License-Identifier: Apache-2.0
// tactus vessel: follows a vessel in a scan from one seed.
#include "tools/analysis/bone/vessel.hpp"
#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"
#include "dsp/vessel/track_warnings.hpp"
#include "tools/command/bone/scan_options.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/straightened_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

namespace tactus::command {

namespace {

using file::Json;
using vessel::Branch;
using vessel::Node;

struct VesselChoice {
    analysis::VesselSettings settings;
    std::string seed, leg, tibia, fibula;
    std::vector<std::filesystem::path> out;
    std::filesystem::path straightened;
    double min_mm = 0.4, max_mm = 20.0, max_length_mm = 2000.0;
    std::optional<double> bone_above;
    bool trunk_only = false, json = false;
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

Json in_mm(const Vec3& p) { return Json::array({p.x * 1e3, p.y * 1e3, p.z * 1e3}); }

const Node* narrowest(const Branch& branch) {
    const Node* found = nullptr;
    for (const Node& node : branch.nodes)
        if (!node.is_lost && (!found || node.radius < found->radius)) found = &node;
    return found;
}

Json json_of(const Branch& branch) {
    double contrast = 0.0, confidence = 0.0, radius = 0.0;
    for (const Node& node : branch.nodes) {
        contrast += node.contrast / double(branch.nodes.size());
        confidence += node.confidence / double(branch.nodes.size());
        radius += node.radius / double(branch.nodes.size());
    }
    Json json{{"parent", branch.parent},
              {"nodes", branch.nodes.size()},
              {"length_mm", branch.length() * 1e3},
              {"mean_radius_mm", radius * 1e3},
              {"mean_contrast", contrast},
              {"mean_confidence", confidence},
              {"from_mm", in_mm(branch.nodes.front().position)},
              {"to_mm", in_mm(branch.nodes.back().position)},
              {"starts", branch.parent < 0 ? std::string(vessel::reason_of(branch.start)) : "at its parent"},
              {"ends", vessel::reason_of(branch.end)}};
    if (branch.end == vessel::End::meets_track) json["meets"] = branch.meets;
    if (const Node* const node = narrowest(branch))
        json["minimum"] = {{"radius_mm", node->radius * 1e3},
                           {"at_mm", in_mm(node->position)},
                           {"uncertain", node->is_radius_uncertain}};
    json["stenosis"] = nullptr;
    if (const auto& stenosis = branch.stenosis)
        json["stenosis"] = {{"percent", stenosis->percent},
                            {"error_percent", stenosis->error_percent},
                            {"radius_mm", stenosis->radius * 1e3},
                            {"reference_radius_mm", stenosis->reference_radius * 1e3},
                            {"at_mm", in_mm(branch.nodes[stenosis->node].position)},
                            {"uncertain", stenosis->is_uncertain}};
    Json lost = Json::array();
    for (const vessel::LostStretch& stretch : branch.lost())
        lost.push_back({{"from_mm", stretch.from * 1e3}, {"to_mm", stretch.to * 1e3}});
    json["lost"] = lost;
    return json;
}

Json json_of(const vessel::RunOff& run_off) {
    Json json{{"judged", run_off.is_judged}, {"arteries", Json::object()}, {"warnings", run_off.warnings}};
    for (std::size_t n = 0; n < run_off.arteries.size(); ++n) {
        const vessel::SeenArtery& artery = run_off.arteries[n];
        json["arteries"][vessel::name_of(static_cast<vessel::LegArtery>(n))] = {{"seen", artery.is_seen},
                                                                                {"from_level", artery.from},
                                                                                {"to_level", artery.to},
                                                                                {"reaches_foot", artery.reaches_foot},
                                                                                {"lost", artery.has_lost_stretch}};
    }
    return json;
}

Json json_of(const analysis::FoundVessel& result, const VesselChoice& choice) {
    const vessel::Track& track = result.found.track;
    Json json{{"found", !track.branches.empty()}, {"seed_mm", in_mm(choice.settings.seed)}};
    if (track.branches.empty()) json["why"] = result.found.why;
    json["length_mm"] = track.length() * 1e3;
    json["noise"] = track.noise.sigma;
    json["contrast"] = track.contrast;
    json["excluded_above"] = track.excluded_above;
    json["seconds"] = result.seconds;
    Json branches = Json::array();
    for (const Branch& branch : track.branches) branches.push_back(json_of(branch));
    json["branches"] = branches;
    if (result.run_off) json["run_off"] = json_of(*result.run_off);
    json["notes"] = result.notes;
    json["warnings"] = result.warnings;
    json["doubts"] = track.doubts;
    return json;
}

void print_branch(std::size_t index, const Branch& branch) {
    std::string from = branch.parent < 0 ? fmt::format("starts where {}", vessel::reason_of(branch.start))
                                         : fmt::format("leaves branch {}", branch.parent);
    fmt::print("branch {}: {:.1f} mm, {}, ends where {}\n", index, branch.length() * 1e3, from,
               vessel::reason_of(branch.end));
    if (const Node* const node = narrowest(branch))
        fmt::print("  least radius {:.2f} mm at {:.1f}, {:.1f}, {:.1f}{}\n", node->radius * 1e3, node->position.x * 1e3,
                   node->position.y * 1e3, node->position.z * 1e3, node->is_radius_uncertain ? ", uncertain" : "");
    if (const auto& stenosis = branch.stenosis; stenosis && stenosis->percent >= 20.0)
        fmt::print("  {}\n", vessel::text_of(branch, *stenosis));
    for (const vessel::LostStretch& stretch : branch.lost())
        fmt::print("  no contrast from {:.1f} to {:.1f} mm along it: bridged\n", stretch.from * 1e3, stretch.to * 1e3);
}

void print_run_off(const vessel::RunOff& run_off) {
    for (std::size_t n = 0; n < run_off.arteries.size(); ++n) {
        const vessel::SeenArtery& artery = run_off.arteries[n];
        fmt::print("{} artery: {}\n", vessel::name_of(static_cast<vessel::LegArtery>(n)),
                   !artery.is_seen       ? "not seen"
                   : artery.reaches_foot ? fmt::format("seen down to level {:.2f}", artery.to)
                                         : fmt::format("seen down to level {:.2f} only", artery.to));
    }
}

int follow(const VesselChoice& given) {
    VesselChoice choice = given;
    analysis::VesselSettings& settings = choice.settings;
    settings.seed = parse_place(choice.seed, "--seed");
    settings.leg = leg_of(choice);
    settings.out = choice.out;
    settings.track.min_radius = choice.min_mm * 1e-3;
    settings.track.max_radius = choice.max_mm * 1e-3;
    settings.track.max_length = choice.max_length_mm * 1e-3;
    settings.track.exclude_above = choice.bone_above;
    settings.track.branches = !choice.trunk_only;
    if (choice.min_mm >= choice.max_mm) throw Error("--min-radius must be below --max-radius");
    settings.straightened = choice.straightened;
    if (!choice.straightened.empty() && choice.straightened.extension() != ".png")
        throw Error(choice.straightened.string() + ": the straightened view is a .png");
    const analysis::FoundVessel result = analysis::follow_vessel(settings);
    const vessel::Track& track = result.found.track;
    if (result.straightened)
        report::write_picture(*result.straightened, track.background, track.contrast, choice.straightened);
    for (const std::string& warning : result.warnings) fmt::print(stderr, "warning: {}\n", warning);
    const bool is_vessel = !track.branches.empty() && track.doubts.empty();
    if (choice.json) {
        fmt::print("{}\n", json_of(result, choice).dump(2));
        return is_vessel ? done : answer_is_no;
    }
    if (track.branches.empty()) {
        fmt::print("{}\n", result.found.why);
        return answer_is_no;
    }
    fmt::print("{} branch{}, {:.1f} mm in all, {:.2f} s\n", track.branches.size(),
               track.branches.size() == 1 ? "" : "es", track.length() * 1e3, result.seconds);
    for (std::size_t n = 0; n < track.branches.size(); ++n) print_branch(n, track.branches[n]);
    if (result.run_off) print_run_off(*result.run_off);
    for (const std::string& note : result.notes) fmt::print("  {}\n", note);
    for (const std::string& doubt : track.doubts) fmt::print("! {}: this may be no vessel\n", doubt);
    return is_vessel ? done : answer_is_no;
}

Action declare_vessel(VerbOptions& verb) {
    const auto choice = std::make_shared<VesselChoice>();
    verb.add("scan", choice->settings.scan, "CT or MR angiography, in a format of import").required();
    verb.add("--seed", choice->seed, "a place in the vessel, mm, LPS").required().value_name("X,Y,Z");
    verb.add("-o,--out", choice->out,
             "centre line as .csv, .vtp or .mrk.json, or tubes as .stl or .ply; may be repeated")
        .one_each();
    verb.add("--straightened", choice->straightened, "a PNG of the seed's branch pulled straight");
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
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return follow(*choice); };
}

}  // namespace

Verb vessel_verb() { return {"vessel", "follow a vessel in a scan from one seed", declare_vessel}; }

}  // namespace tactus::command

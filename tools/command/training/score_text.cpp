// SPDX-License-Identifier: Apache-2.0
#include "tools/command/training/score_text.hpp"

#include "assets/file/json.hpp"
#include "tools/command/batch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::command {

namespace {

using file::Json;

constexpr const char* not_validated = "not validated";

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json json_of(const analysis::Score& s) {
    Json json{
        {"plane", {{"rms_mm", or_null(s.rms_mm)}, {"max_mm", or_null(s.max_mm)}, {"angle_deg", or_null(s.angle_deg)}}},
        {"over_mm3", s.over_mm3},
        {"under_mm3", s.under_mm3},
        {"spared", Json::array()},
        {"force",
         {{"mean_N", s.mean_N},
          {"contact_s", s.contact_s},
          {"over_limit_Ns", s.over_limit_Ns},
          {"shown", or_null(s.shown_share)},
          {"device_scale", s.device_scale},
          {"limited", s.limited},
          {"jerk", or_null(s.jerk)}}},
        {"breakthrough",
         {{"depth_mm", or_null(s.breakthrough_mm)}, {"speed_mm_per_s", or_null(s.breakthrough_mm_per_s)}}},
        {"strokes", s.strokes},
        {"seconds", s.seconds},
        {"path_mm", s.path_mm},
        {"heat_s", or_null(s.heat_s)}};
    if (s.cuts.size() > 1) {
        json["cuts"] = Json::array();
        for (const analysis::CutScore& one : s.cuts)
            json["cuts"].push_back({{"name", one.name},
                                    {"plane",
                                     {{"rms_mm", or_null(one.rms_mm)},
                                      {"max_mm", or_null(one.max_mm)},
                                      {"angle_deg", or_null(one.angle_deg)}}},
                                    {"over_mm3", one.over_mm3},
                                    {"under_mm3", one.under_mm3},
                                    {"breakthrough",
                                     {{"depth_mm", or_null(one.breakthrough_mm)},
                                      {"speed_mm_per_s", or_null(one.breakthrough_mm_per_s)}}}});
    }
    for (const analysis::SparedScore& one : s.spared)
        json["spared"].push_back(
            {{"name", one.name}, {"injured_mm3", one.injured_mm3}, {"closest_mm", one.closest_mm}});
    json["validity"] = not_validated;
    return json;
}

Json row_of(const analysis::ScoredRun& run, std::span<const analysis::ReferenceMeasure> reference) {
    Json json{{"run", run.name}, {"task", run.task.title}};
    if (!run.trainee.empty()) json["trainee"] = run.trainee;
    json.update(json_of(run.score));
    if (reference.empty()) return json;
    Json percentiles = Json::object();
    const auto all = analysis::measures();
    for (std::size_t n = 0; n < all.size(); ++n)
        percentiles[all[n].name] = or_null(analysis::percentile(all[n], all[n].of(run.score), reference[n]));
    json["percentiles"] = percentiles;
    return json;
}

}  // namespace

std::string score_json(const analysis::ScoredRun& run) { return json_of(run.score).dump(2) + "\n"; }

std::string score_json(std::span<const analysis::ScoredRun> runs,
                       std::span<const analysis::ReferenceMeasure> reference) {
    if (runs.size() == 1 && reference.empty()) return score_json(runs.front());
    Json json{{"version", 1}, {"validity", not_validated}, {"rows", Json::array()}, {"learning", Json::array()}};
    for (const analysis::ScoredRun& run : runs) json["rows"].push_back(row_of(run, reference));
    for (const analysis::LearningCurve& curve : analysis::learning_curves(runs)) {
        Json values = Json::array();
        for (const auto& value : curve.values) values.push_back(or_null(value));
        json["learning"].push_back({{"task", curve.task},
                                    {"measure", curve.measure},
                                    {"values", values},
                                    {"exponent", or_null(curve.exponent)}});
    }
    if (!reference.empty()) {
        json["reference"] = Json::array();
        for (const analysis::ReferenceMeasure& one : reference)
            json["reference"].push_back({{"measure", one.measure},
                                         {"n", one.values.size()},
                                         {"mean", one.values.empty() ? Json(nullptr) : Json(one.mean)},
                                         {"deviation", or_null(one.deviation)}});
    }
    return json.dump(2) + "\n";
}

std::string score_csv(std::span<const analysis::ScoredRun> runs) {
    std::string text = "run,trainee,task";
    for (const analysis::Measure& measure : analysis::measures()) text += "," + measure.name;
    text += ",validity\n";
    for (const analysis::ScoredRun& run : runs) {
        text += fmt::format("{},{},{}", csv_field(run.name), csv_field(run.trainee), csv_field(run.task.title));
        for (const analysis::Measure& measure : analysis::measures()) {
            const auto value = measure.of(run.score);
            text += value ? fmt::format(",{:.6g}", *value) : ",";
        }
        text += fmt::format(",{}\n", not_validated);
    }
    return text;
}

std::string score_text(std::span<const analysis::ScoredRun> runs,
                       std::span<const analysis::ReferenceMeasure> reference) {
    std::string text;
    const auto all = analysis::measures();
    for (const analysis::ScoredRun& run : runs) {
        text += fmt::format("{}: {}\n", run.name, run.task.title);
        for (std::size_t n = 0; n < all.size(); ++n) {
            const auto value = all[n].of(run.score);
            text += fmt::format("  {:<28} {:>10}", all[n].name, value ? fmt::format("{:.4g}", *value) : "-");
            if (!reference.empty())
                if (const auto rank = analysis::percentile(all[n], value, reference[n]))
                    text += fmt::format("   percentile {:.0f} of {}", *rank, reference[n].values.size());
            text += "\n";
        }
        if (run.score.cuts.size() > 1)
            for (const analysis::CutScore& one : run.score.cuts)
                text += one.rms_mm ? fmt::format("  cut {}: {:.2f} mm rms, {:.2f} mm at most{} from the plan\n",
                                                 one.name, *one.rms_mm, *one.max_mm,
                                                 one.angle_deg ? fmt::format(", {:.2f}°", *one.angle_deg) : "")
                                   : fmt::format("  cut {}: not made\n", one.name);
        for (const analysis::SparedScore& one : run.score.spared)
            if (one.injured_mm3 > 0.0) text += fmt::format("  injured: {}, {:.3g} mm³\n", one.name, one.injured_mm3);
        if (run.score.device_scale != 1.0)
            text += fmt::format("  forces are those of the tool; those on the device were {:g} times as large\n",
                                run.score.device_scale);
        if (run.score.limited >= 0.005)
            text += fmt::format(
                "  the force was limited {:.0f} % of the time in contact: the device gave less than the tool "
                "wanted\n",
                100.0 * run.score.limited);
        if (run.score.shown_share && *run.score.shown_share < analysis::complete_share)
            text += "  the blade was in the bone without force on the hand: do not compare this attempt with others\n";
    }
    return text + "scores are not validated\n";
}

}  // namespace tactus::command

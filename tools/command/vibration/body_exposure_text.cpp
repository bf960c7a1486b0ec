// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/body_exposure_text.hpp"

#include "dsp/core/readable.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/vibration/exposure_verdict.hpp"
#include "tools/command/vibration/record_json.hpp"
#include "tools/command/vibration/stretch_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::command {

using analysis::BodyOperation;
using file::Json;

namespace {

char letter(signal::BodyAxis axis) { return static_cast<char>('x' + static_cast<int>(axis)); }

double factor(const BodyOperation& one, const BodyOperation::Axis& axis) {
    return signal::body_factor(one.judgement, axis.axis);
}

double a8_of(const BodyOperation& one, const BodyOperation::Axis& axis) {
    return factor(one, axis) *
           signal::daily_exposure(std::array{signal::HandArmOperation{axis.vibration.rms, one.duration}});
}

/// Time until the axis alone makes A(8) reach `value`, s.
double time_of(const BodyOperation& one, const BodyOperation::Axis& axis, double value) {
    return signal::time_to_reach(value, factor(one, axis) * axis.vibration.rms);
}

bool is_health(const BodyOperation& one) { return one.judgement == signal::BodyJudgement::health; }

const BodyOperation::Axis& strongest(const BodyOperation& one) {
    return *std::ranges::max_element(one.axes, {}, [&](const auto& axis) { return a8_of(one, axis); });
}

}  // namespace

std::string body_text(const BodyOperation& one) {
    std::string text = fmt::format("{}: {:.0f} min a day, whole body, {}\n", one.file, one.duration / 60.0,
                                   is_health(one) ? "health (ISO 2631-1)" : "comfort in trains (ISO 2631-4)");
    if (!one.stretch.is_whole()) text += fmt::format("  of the record: {}\n", one.stretch.text());
    for (const std::string& line : analysis::understood(one.calibration, one.log, one.rate)) text += "  " + line + "\n";
    for (const BodyOperation::Axis& axis : one.axes) {
        const signal::BodyAxisVibration& v = axis.vibration;
        text += fmt::format(
            "  axis {} ({}, channel {}): a_w {} m/s^2 rms, MTVV {} m/s^2, VDV {} m/s^1.75 in {:.0f} s, crest factor "
            "{:.1f}\n",
            letter(axis.axis), signal::body_weighting(one.judgement, axis.axis).name, axis.channel, plain(v.rms, 3),
            plain(v.running, 3), plain(v.dose, 3), v.seconds, v.crest());
        if (v.has_shocks())
            text += fmt::format(
                "    shocks: crest factor {:.1f} (limit 9), MTVV/a_w {:.2f} (1.5), VDV/(a_w T^1/4) {:.2f} (1.75)\n",
                v.crest(), v.running_ratio(), v.dose_ratio());
    }
    if (is_health(one)) {
        const BodyOperation::Axis& axis = strongest(one);
        const double k = factor(one, axis);
        text +=
            fmt::format("  {}a_w of axis {} counts: {} m/s^2; action value {}, limit value {}\n",
                        k == 1.0 ? "" : fmt::format("{:g} × ", k), letter(axis.axis), plain(k * axis.vibration.rms, 3),
                        reached_text(time_of(one, axis, signal::whole_body_limits.action), one.is_lower_bound()),
                        reached_text(time_of(one, axis, signal::whole_body_limits.limit), one.is_lower_bound()));
    } else {
        text += fmt::format("  total a_v {}{} m/s^2\n", one.is_lower_bound() ? "at least " : "", plain(one.total(), 3));
    }
    for (const std::string& note : one.notes) text += "  " + note + "\n";
    return text;
}

std::string body_day_text(const analysis::BodyDay& day) {
    std::string text = verdict_text(fmt::format("A(8) of axis {}", letter(day.a8_axis)), "m/s^2", day.a8,
                                    signal::whole_body_limits, day.is_lower_bound) +
                       "\n" +
                       verdict_text(fmt::format("VDV of axis {}", letter(day.dose_axis)), "m/s^1.75", day.dose,
                                    signal::whole_body_dose_limits, day.is_lower_bound) +
                       "\n";
    text += day.has_shocks ? "the vibration has shocks, which A(8) underestimates: the worse of both counts\n"
                           : "the vibration has no shocks: A(8) is sufficient\n";
    return text;
}

Json body_json(const BodyOperation& one) {
    Json json{{"file", one.file},
              {"standard", is_health(one) ? "ISO 2631-1" : "ISO 2631-4"},
              {"duration_s", one.duration},
              {"sample_rate_hz", one.rate},
              {"stretch", stretch_json(one.stretch)},
              {"calibrated", one.calibrated},
              {"calibration", calibration_json(one.calibration)},
              {"log", one.log ? log_json(*one.log, one.rate) : Json()},
              {"band_hz", {signal::weighting_k.lowest, one.band_high}},
              {"lower_bound", one.is_lower_bound()},
              {"a_v", one.axes.size() == 3 ? Json(one.total()) : Json(nullptr)},
              {"axes", Json::array()},
              {"notes", one.notes}};
    for (const BodyOperation::Axis& axis : one.axes) {
        const signal::BodyAxisVibration& v = axis.vibration;
        const double k = factor(one, axis);
        Json row{{"axis", std::string(1, letter(axis.axis))},
                 {"channel", axis.channel},
                 {"weighting", signal::body_weighting(one.judgement, axis.axis).name},
                 {"factor", k},
                 {"a_w", v.rms},
                 {"a_w_filter", axis.filtered},
                 {"peak", v.peak},
                 {"crest", v.crest()},
                 {"mtvv", v.running},
                 {"mtvv_ratio", v.running_ratio()},
                 {"vdv", v.dose},
                 {"vdv_ratio", v.dose_ratio()},
                 {"measured_s", v.seconds},
                 {"shocks", v.has_shocks()}};
        if (is_health(one)) {
            row["a8"] = a8_of(one, axis);
            row["vdv_day"] = k * v.dose_of(one.duration);
            row["minutes_to_action"] = minutes_json(time_of(one, axis, signal::whole_body_limits.action));
            row["minutes_to_limit"] = minutes_json(time_of(one, axis, signal::whole_body_limits.limit));
            row["minutes_to_action_vdv"] =
                minutes_json(signal::time_to_dose(signal::whole_body_dose_limits.action, v, k));
            row["minutes_to_limit_vdv"] =
                minutes_json(signal::time_to_dose(signal::whole_body_dose_limits.limit, v, k));
        }
        json["axes"].push_back(row);
    }
    return json;
}

Json body_day_json(const std::optional<analysis::BodyDay>& day) {
    if (!day) return nullptr;
    return {{"a8", day->a8},
            {"a8_axis", std::string(1, letter(day->a8_axis))},
            {"vdv", day->dose},
            {"vdv_axis", std::string(1, letter(day->dose_axis))},
            {"shocks", day->has_shocks},
            {"lower_bound", day->is_lower_bound},
            {"verdict_a8", verdict_name(day->by_rms)},
            {"verdict_vdv", verdict_name(day->by_dose)},
            {"verdict", verdict_name(day->verdict())}};
}

std::string body_table_header() {
    return "file,axis,weighting,factor,a_w,mtvv,vdv,crest,measured_s,duration_s,a8,vdv_day,calibrated,lower_bound,"
           "error\n";
}

std::string body_table_rows(const BodyOperation& one) {
    std::string rows;
    for (const BodyOperation::Axis& axis : one.axes) {
        const signal::BodyAxisVibration& v = axis.vibration;
        const bool health = is_health(one);
        rows += fmt::format("{},{},{},{:g},{},{},{},{},{},{},{},{},{},{},\n", csv_field(one.file), letter(axis.axis),
                            signal::body_weighting(one.judgement, axis.axis).name, factor(one, axis), v.rms, v.running,
                            v.dose, v.crest(), v.seconds, one.duration,
                            health ? fmt::format("{}", a8_of(one, axis)) : std::string(),
                            health ? fmt::format("{}", factor(one, axis) * v.dose_of(one.duration)) : std::string(),
                            one.calibrated, one.is_lower_bound());
    }
    return rows;
}

}  // namespace tactus::command

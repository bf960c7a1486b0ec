// SPDX-License-Identifier: Apache-2.0
#include "tools/command/gripper/rig_text.hpp"

#include "assets/file/json.hpp"
#include "tools/command/batch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::command {

using analysis::RigCell;
using analysis::RigCrossover;
using analysis::RigFinding;
using analysis::RigLead;
using analysis::RigReport;
using analysis::RigRow;

namespace {

using file::Json;

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(); }
Json finite(const std::optional<double>& value) { return value ? finite(*value) : Json(); }

Json cell_json(const RigCell& cell) {
    const bool wall = cell.object.kind == control::ObjectKind::wall;
    return {{"motor", cell.motor},
            {"object", cell.object.name},
            {"stiffness_N_per_mm", wall ? Json() : Json(cell.object.stiffness * 1e-3)},
            {"damping_Ns_per_mm", wall ? Json() : Json(cell.object.damping * 1e-3)},
            {"rate_hz", cell.rate},
            {"amplitude_mm", cell.amplitude * 1e3}};
}

Json row_json(const RigRow& row) {
    const control::Fidelity& f = row.fidelity;
    const bool good = row.failure.empty();
    const auto number = [good](double v) { return good ? finite(v) : Json(); };
    Json json = cell_json(row.cell);
    json.update(
        {{"gain_error_db", finite(f.gain_error_db)},
         {"phase_error_deg", finite(f.phase_error_deg)},
         {"nrmse", finite(f.nrmse)},
         {"rendered_stiffness_N_per_mm", number(f.rendered_stiffness * 1e-3)},
         {"rendered_damping_Ns_per_mm", number(f.rendered_damping * 1e-3)},
         {"slip", f.slip_share > 0.0},
         {"saturated", f.saturated_share > 0.0},
         {"slip_share", number(f.slip_share)},
         {"saturated_share", number(f.saturated_share)},
         {"penetration_mm", row.cell.object.kind == control::ObjectKind::wall ? number(f.penetration * 1e3) : Json()},
         {"position_error_rms_mm", number(f.position_rms_error * 1e3)},
         {"limit_cycle_rms_mm", number(f.limit_cycle_rms * 1e3)},
         {"force_N", number(std::abs(f.force))},
         {"position_mm", number(std::abs(f.position) * 1e3)},
         {"peak_speed_mm_s", number(f.speed_peak * 1e3)}});
    if (!good) json["failure"] = row.failure;
    return json;
}

std::string cell_text(const Json& value) {
    if (value.is_null()) return "";
    if (value.is_string()) return csv_field(value.get<std::string>());
    return value.is_number_float() ? fmt::format("{:.6g}", value.get<double>()) : value.dump();
}

}  // namespace

std::string rig_json(const RigReport& report) {
    Json json{{"rows", Json::array()}, {"facts", Json::object()}};
    for (const RigRow& row : report.rows) json["rows"].push_back(row_json(row));
    Json& facts = json["facts"];
    facts["peak_cord_speed_mm_s"] = report.peak_cord_speed * 1e3;
    facts["saturation_hz"] = finite(report.saturation_rate);
    facts["saturation_closed_form_hz"] = finite(report.saturation_closed_form);
    facts["crossover"] = Json::array();
    for (const RigCrossover& c : report.crossover)
        facts["crossover"].push_back({{"stiffness_N_per_mm", c.stiffness * 1e-3},
                                      {"rate_hz_low", finite(c.low)},
                                      {"rate_hz_high", finite(c.high)},
                                      {"amplitude_mm", c.amplitude * 1e3},
                                      {"crossed", c.crossed},
                                      {"of", c.of}});
    facts["findings"] = Json::array();
    for (const RigFinding& f : report.findings)
        facts["findings"].push_back({{"claim", f.claim}, {"holds", f.holds}, {"of", f.of}});
    facts["feed_forward"] = Json::array();
    for (const RigLead& lead : report.leads) {
        Json entry = cell_json(lead.cell);
        entry.update({{"nrmse", finite(lead.nrmse)},
                      {"nrmse_feed_forward", finite(lead.led_nrmse)},
                      {"ratio", finite(lead.ratio())}});
        facts["feed_forward"].push_back(std::move(entry));
    }
    facts["assumed"] = Json::array();
    for (const analysis::RigAssumption& a : report.assumptions)
        facts["assumed"].push_back({{"motor", a.motor}, {"option", a.option}, {"low", a.low}, {"high", a.high}});
    json["notes"] = report.notes;
    return json.dump(2) + "\n";
}

std::string rig_csv(const RigReport& report) {
    std::string out;
    for (const RigRow& row : report.rows) {
        const Json json = row_json(row);
        if (out.empty()) {
            for (const auto& [key, value] : json.items())
                if (key != "failure") out += (out.empty() ? "" : ",") + key;
            out += '\n';
        }
        bool first = true;
        for (const auto& [key, value] : json.items()) {
            if (key == "failure") continue;
            out += (first ? "" : ",") + cell_text(value);
            first = false;
        }
        out += '\n';
    }
    return out;
}

std::string rig_text(const RigReport& report) {
    std::string out = fmt::format("{}: {}\n", report.title, report.source);
    out += fmt::format("  {:<6} {:<36} {:>7} {:>6} {:>9} {:>8} {:>8} {:>12}\n", "motor", "object", "Hz", "mm",
                       "gain dB", "phase °", "NRMSE %", "k N/mm");
    const auto show = [](const std::optional<double>& v, double scale, const char* format) {
        return v ? fmt::format(fmt::runtime(format), *v * scale) : std::string("-");
    };
    for (const RigRow& row : report.rows) {
        const control::Fidelity& f = row.fidelity;
        if (!row.failure.empty()) {
            out += fmt::format("  {:<6} {:<36} {:>7g} {:>6g} {}\n", row.cell.motor, row.cell.object.name, row.cell.rate,
                               row.cell.amplitude * 1e3, row.failure);
            continue;
        }
        out += fmt::format(
            "  {:<6} {:<36} {:>7g} {:>6g} {:>9} {:>8} {:>8} {:>12}{}{}\n", row.cell.motor, row.cell.object.name,
            row.cell.rate, row.cell.amplitude * 1e3, show(f.gain_error_db, 1.0, "{:.2f}"),
            show(f.phase_error_deg, 1.0, "{:.1f}"), show(f.nrmse, 100.0, "{:.1f}"),
            row.cell.object.kind == control::ObjectKind::wall ? fmt::format("gave {:.3g} mm", f.penetration * 1e3)
                                                              : fmt::format("{:.4g}", f.rendered_stiffness * 1e-3),
            f.slip_share > 0.0 ? "  slips" : "", f.saturated_share > 0.0 ? "  saturated" : "");
    }
    out += fmt::format("  peak speed of the cord at 1 Hz: {:.2f} mm/s\n", report.peak_cord_speed * 1e3);
    if (report.saturation_rate)
        out += fmt::format("  free motion saturates from {:.3f} Hz on (closed form {:.3f} Hz)\n",
                           *report.saturation_rate, report.saturation_closed_form.value_or(NAN));
    for (const RigCrossover& c : report.crossover)
        out +=
            c.low
                ? fmt::format(
                      "  at {:g} N/mm and ±{:.3g} mm the second motor is the better one from {:.2f} to {:.2f} Hz on\n",
                      c.stiffness * 1e-3, c.amplitude * 1e3, *c.low, c.high.value_or(*c.low))
                : fmt::format("  at {:g} N/mm and ±{:.3g} mm the second motor is never the better one\n",
                              c.stiffness * 1e-3, c.amplitude * 1e3);
    for (const RigFinding& f : report.findings) out += fmt::format("  {}: in {} of {} cases\n", f.claim, f.holds, f.of);
    double least = 1e300, most = 0.0;
    for (const RigLead& lead : report.leads) {
        least = std::min(least, lead.ratio());
        most = std::max(most, lead.ratio());
    }
    if (!report.leads.empty())
        out +=
            fmt::format("  feed-forward: error of the thesis loop is {:.1f} to {:.1f} times as large\n", least, most);
    for (const std::string& note : report.notes) out += "  " + note + "\n";
    return out;
}

}  // namespace tactus::command

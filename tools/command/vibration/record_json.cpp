// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/record_json.hpp"

namespace tactus::command {

using Json = file::Json;

Json calibration_json(const sound::Calibration& calibration) {
    Json json{{"known", calibration.known}, {"factor", calibration.factor}, {"unit", calibration.unit}};
    json["from"] = calibration.source.empty() ? Json() : Json(calibration.source);
    if (!calibration.remark.empty()) json["remark"] = calibration.remark;
    if (!calibration.file_note.empty()) json["file_note"] = calibration.file_note;
    return json;
}

Json log_json(const sound::LogFacts& log, double rate) {
    const auto line = [](int number) { return number > 0 ? Json(number) : Json(); };
    return {{"rows", log.rows},
            {"lost_rows", log.lost_rows},
            {"repeated_rows", log.form.repeated},
            {"gaps", log.gaps},
            {"lost_s", log.lost_seconds},
            {"step_s", {log.shortest_step, log.longest_step}},
            {"step_deviation_s", log.step_deviation},
            {"even", log.is_even()},
            {"clock_step_s", log.clock_step > 0.0 ? Json(log.clock_step) : Json()},
            {"nyquist_hz", 0.5 * rate},
            {"usable_hz", log.usable},
            {"form",
             {{"format", log.form.format.empty() ? Json() : Json(log.form.format)},
              {"separator", log.form.separator_name()},
              {"decimal", log.form.decimal_name()},
              {"header_line", line(log.form.header_line)},
              {"units_line", line(log.form.units_line)},
              {"first_row", line(log.form.first_row)},
              {"lines_not_used", log.form.skipped},
              {"time", log.form.time},
              {"time_unit_stated", log.form.is_time_unit_stated}}}};
}

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
#include "tools/report/vibration/record_fields.hpp"

#include "tools/analysis/vibration/record.hpp"

#include <optional>
#include <string>

namespace tactus::report {

namespace {

std::optional<std::string> if_any(const std::string& text) { return text.empty() ? std::nullopt : std::optional(text); }

std::optional<int> line(int number) { return number > 0 ? std::optional(number) : std::nullopt; }

const Fields<table::LogForm>& form_fields() {
    using table::LogForm;
    static const Fields<LogForm> all =
        Fields<LogForm>("format of a log")
            .text("format", "", [](const LogForm& f) { return if_any(f.format); })
            .text("separator", "", [](const LogForm& f) { return std::string(f.separator_name()); })
            .text("decimal", "", [](const LogForm& f) { return std::string(f.decimal_name()); })
            .integer("header_line", "", [](const LogForm& f) { return line(f.header_line); })
            .integer("units_line", "", [](const LogForm& f) { return line(f.units_line); })
            .integer("first_row", "", [](const LogForm& f) { return line(f.first_row); })
            .integer("lines_not_used", "", [](const LogForm& f) { return f.skipped; })
            .integer("statistics_lines", "", [](const LogForm& f) { return f.trailer; })
            .text("time", "", [](const LogForm& f) { return std::string(f.time); })
            .flag("time_unit_stated", "", [](const LogForm& f) { return f.is_time_unit_stated; });
    return all;
}

const Fields<sound::Calibration>& calibration_fields() {
    using sound::Calibration;
    static const Fields<Calibration> all =
        Fields<Calibration>("scale of the values of a record")
            .flag("known", "", [](const Calibration& c) { return c.known; })
            .number("factor", "", significant(6), [](const Calibration& c) { return c.factor; })
            .text("unit", "", [](const Calibration& c) { return c.unit; })
            .text("from", "", [](const Calibration& c) { return if_any(c.source); })
            .text("remark", "", [](const Calibration& c) { return if_any(c.remark); })
            .omitted()
            .text("file_note", "", [](const Calibration& c) { return if_any(c.file_note); })
            .omitted();
    return all;
}

const Fields<ReadLog>& log_fields() {
    static const Fields<ReadLog> all =
        Fields<ReadLog>("rows and steps of a log")
            .integer("rows", "", [](const ReadLog& l) { return l.facts->rows; })
            .integer("lost_rows", "", [](const ReadLog& l) { return l.facts->lost_rows; })
            .integer("repeated_rows", "", [](const ReadLog& l) { return l.facts->form.repeated; })
            .integer("gaps", "", [](const ReadLog& l) { return l.facts->gaps; })
            .number("lost_s", "", significant(4, "s"), [](const ReadLog& l) { return l.facts->lost_seconds; })
            .range("step_s", "", significant(4, "s"),
                   [](const ReadLog& l) {
                       return std::optional(std::pair(l.facts->shortest_step, l.facts->longest_step));
                   })
            .number("step_deviation_s", "", significant(4, "s"),
                    [](const ReadLog& l) { return l.facts->step_deviation; })
            .flag("even", "", [](const ReadLog& l) { return l.facts->is_even(); })
            .number("clock_step_s", "", significant(4, "s"),
                    [](const ReadLog& l) {
                        return l.facts->clock_step > 0.0 ? std::optional(l.facts->clock_step) : std::nullopt;
                    })
            .number("nyquist_hz", "", significant(6, "Hz"), [](const ReadLog& l) { return 0.5 * l.rate; })
            .number("usable_hz", "", significant(6, "Hz"), [](const ReadLog& l) { return l.facts->usable; })
            .child("form", "", form_fields(), [](const ReadLog& l) -> const table::LogForm& { return l.facts->form; });
    return all;
}

}  // namespace

const Fields<sound::ReadStretch>& stretch_fields() {
    using sound::ReadStretch;
    static const Fields<ReadStretch> all =
        Fields<ReadStretch>("stretch of a record that was read")
            .number("from_s", "from", significant(6, "s"), [](const ReadStretch& s) { return s.from; })
            .number("to_s", "to", significant(6, "s"), [](const ReadStretch& s) { return s.to; })
            .number("of_s", "length of the record", significant(6, "s"), [](const ReadStretch& s) { return s.of; });
    return all;
}

const Fields<ReadRecord>& record_fields() {
    static const Fields<ReadRecord> all =
        Fields<ReadRecord>("record that was read")
            .child("stretch", "", stretch_fields(),
                   [](const ReadRecord& r) -> const sound::ReadStretch& { return r.stretch; })
            .text("", "of the record",
                  [](const ReadRecord& r) { return r.stretch.is_whole() ? std::string() : r.stretch.text(); })
            .warnings("missing",
                      [](const ReadRecord& r) { return r.log ? r.log->missing() : std::vector<std::string>(); })
            .notes("", "record", [](const ReadRecord& r) { return analysis::understood(r.calibration, r.log, r.rate); })
            .child("calibration", "", calibration_fields(),
                   [](const ReadRecord& r) -> const sound::Calibration& { return r.calibration; })
            .child("log", "", log_fields(),
                   [](const ReadRecord& r) { return r.log ? std::optional(ReadLog{&*r.log, r.rate}) : std::nullopt; });
    return all;
}

}  // namespace tactus::report

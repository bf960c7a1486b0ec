// SPDX-License-Identifier: Apache-2.0
// tactus exposure: vibration exposure of the hand (ISO 5349-1) and of the whole body (ISO 2631-1, -4).
#include "tools/analysis/vibration/exposure.hpp"
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "dsp/core/units.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/vibration/body_exposure_text.hpp"
#include "tools/command/vibration/exposure_verdict.hpp"
#include "tools/command/vibration/record_json.hpp"
#include "tools/command/vibration/record_options.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>

namespace tactus::command {

namespace {

using file::Json;
using Operation = analysis::ExposureOperation;

struct ExposureChoice : RecordChoice {
    std::vector<std::string> durations;  // quantities of time; a bare number is hours
    std::string body = "hand", axes;     // of the body: hand, whole or rail; "xyz"
    bool uncalibrated = false;           // take values of a record without calibration as m/s²
    int jobs = 0;                        // files at a time, 0: one per core
    std::filesystem::path table;
};

double parse_duration(const std::string& text) {
    double hours = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), hours);
    const double seconds =
        failure == std::errc{} && end == text.data() + text.size() ? 3600.0 * hours : parse_as(text, "s");
    if (!(seconds > 0.0) || !(seconds <= 24.0 * 3600.0))
        throw Error(fmt::format("--duration must be a time up to 24 h, such as \"90 min\", not '{}'", text));
    return seconds;
}

Json minutes_until(double value, const Operation& one) {
    return minutes_json(signal::time_to_reach(value, one.total()));
}

std::string reached(double value, const Operation& one) {
    return reached_text(signal::time_to_reach(value, one.total()), one.is_lower_bound());
}

Json operation_json(const Operation& one) {
    return {{"a_hw", one.weighted},
            {"a_hv", one.three_axes ? Json(one.total()) : Json(nullptr)},
            {"a8", signal::daily_exposure(std::array{signal::HandArmOperation{one.total(), one.duration}})},
            {"minutes_to_action", minutes_until(signal::hand_arm_limits.action, one)},
            {"minutes_to_limit", minutes_until(signal::hand_arm_limits.limit, one)},
            {"calibrated", one.calibrated},
            {"band_hz", {signal::weighting_h.lowest, one.band_high}},
            {"lower_bound", one.is_lower_bound()},
            {"a_hw_filter", one.filtered},
            {"a_hw_by", "transform of the record"},
            {"axes", one.axes},
            {"file", one.file},
            {"stretch", stretch_json(one.stretch)},
            {"duration_s", one.duration},
            {"sample_rate_hz", one.rate},
            {"calibration", calibration_json(one.calibration)},
            {"log", one.log ? log_json(*one.log, one.rate) : Json()},
            {"notes", one.notes}};
}

std::string table_row(const Operation& one) {
    std::string axes, notes;
    for (std::size_t i = 0; i < 3; ++i)
        axes += i < one.weighted.size() ? fmt::format("{},", one.weighted[i]) : std::string(",");
    for (const std::string& note : one.notes) notes += (notes.empty() ? "" : "; ") + note;
    const auto minutes = [&](double value) {
        const double found = signal::time_to_reach(value, one.total()) / 60.0;
        return std::isfinite(found) ? fmt::format("{}", found) : std::string();
    };
    return fmt::format("{},{}{},{},{},{},{},{},{},{},{},\n", csv_field(one.file), axes,
                       one.three_axes ? fmt::format("{}", one.total()) : std::string(),
                       signal::daily_exposure(std::array{signal::HandArmOperation{one.total(), one.duration}}),
                       one.duration, minutes(signal::hand_arm_limits.action), minutes(signal::hand_arm_limits.limit),
                       one.calibrated, signal::weighting_h.lowest, one.band_high, csv_field(notes));
}

void write_table(const ExposureChoice& choice, const std::vector<Operation>& operations,
                 const std::vector<std::filesystem::path>& files, const std::vector<std::string>& failures) {
    std::string table =
        "file,a_hw_1,a_hw_2,a_hw_3,a_hv,a8,duration_s,minutes_to_action,minutes_to_limit,calibrated,band_low_hz,"
        "band_high_hz,notes,error\n";
    for (std::size_t i = 0; i < files.size(); ++i)
        table += failures[i].empty()
                     ? table_row(operations[i])
                     : fmt::format("{},,,,,,,,,,,,,{}\n", csv_field(files[i].string()), csv_field(failures[i]));
    file::write_whole_file(choice.table, table);
}

void print_operation(const Operation& one) {
    fmt::print("{}: {:.0f} min a day\n", one.file, one.duration / 60.0);
    if (!one.stretch.is_whole()) fmt::print("  of the record: {}\n", one.stretch.text());
    for (const std::string& line : analysis::understood(one.calibration, one.log, one.rate)) fmt::print("  {}\n", line);
    for (std::size_t i = 0; i < one.axes.size(); ++i)
        fmt::print("  axis {}: a_hw {} m/s^2 rms, by transform of the record (by filter {})\n", one.axes[i],
                   plain(one.weighted[i]), plain(one.filtered[i]));
    if (one.three_axes) fmt::print("  a_hv {} m/s^2\n", plain(one.total(), 3));
    fmt::print("  action value {}, limit value {}\n", reached(signal::hand_arm_limits.action, one),
               reached(signal::hand_arm_limits.limit, one));
    for (const std::string& note : one.notes) fmt::print("  {}\n", note);
}

/// One line per file, for many files.
void print_table(const std::vector<Operation>& operations) {
    std::size_t width = 4;
    for (const Operation& one : operations) width = std::max(width, one.file.size());
    fmt::print("{:<{}}  {:>9}  {:>9}  {:>8}  {:>18}  {}\n", "file", width, "a, m/s^2", "A(8)", "min/day",
               "action value", "limit value");
    for (const Operation& one : operations)
        if (!one.file.empty())
            fmt::print(
                "{:<{}}  {:>9}  {:>9}  {:>8.0f}  {:>18}  {}{}\n", one.file, width, plain(one.total(), 3),
                plain(signal::daily_exposure(std::array{signal::HandArmOperation{one.total(), one.duration}}), 3),
                one.duration / 60.0, reached(signal::hand_arm_limits.action, one),
                reached(signal::hand_arm_limits.limit, one),
                one.is_lower_bound() || !one.calibrated ? "  (see --table)" : "");
}

/// Durations of the files, s: one for all, or one each.
std::vector<double> durations_of(const ExposureChoice& choice, std::size_t files) {
    if (choice.durations.size() > 1 && choice.durations.size() != files)
        throw Error(fmt::format("there are {} durations for {} files; give one, or one per file",
                                choice.durations.size(), files));
    std::vector<double> durations;
    for (const std::string& text : choice.durations) durations.push_back(parse_duration(text));
    if (durations.empty()) durations.push_back(signal::reference_day);
    durations.resize(files, durations.front());
    return durations;
}

std::string no_day(bool bad) {
    return bad ? "a file could not be used" : "the durations add up to more than 24 h; state them with --duration";
}

int hand_exposure(const ExposureChoice& choice, const std::vector<std::filesystem::path>& files) {
    if (!choice.axes.empty())
        throw Error("--axes is of --body whole and --body rail; the hand has one weighting for all");
    const std::vector<double> durations = durations_of(choice, files.size());
    const analysis::ExposureSettings settings{choice.settings(), choice.uncalibrated, {}};
    std::vector<Operation> operations(files.size());
    const std::vector<std::string> failures =
        run_batch(files.size(), choice.jobs, "files", [&](std::size_t i, const std::function<void(double)>& progress) {
            operations[i] = analysis::analyse_exposure(files[i], settings, durations[i], progress);
        });
    const bool bad = tell_failures(failures) > 0;
    if (!choice.table.empty()) write_table(choice, operations, files, failures);
    if (bad && files.size() == 1 && !choice.json) return bad_input;
    // Without all files there is no A(8) of the day.
    std::optional<double> a8;
    if (!bad) a8 = analysis::exposure_of_day(operations);
    const double day = a8.value_or(0.0);
    const bool is_bound = std::ranges::any_of(operations, &Operation::is_lower_bound);
    if (choice.json) {
        Json json{{"a8", a8 ? Json(day) : Json()}, {"operations", Json::array()}};
        for (std::size_t i = 0; i < files.size(); ++i)
            json["operations"].push_back(failures[i].empty()
                                             ? operation_json(operations[i])
                                             : Json{{"file", files[i].string()}, {"error", failures[i]}});
        json["lower_bound"] = is_bound;
        json["verdict"] =
            a8 ? Json(verdict_name(analysis::judge_exposure(day, signal::hand_arm_limits, is_bound))) : Json();
        json["years_to_white_fingers"] = day > 0.0 ? Json(signal::years_to_white_fingers(day)) : Json(nullptr);
        fmt::print("{}\n", json.dump(2));
        return bad ? bad_input : done;
    }
    if (files.size() > 3) print_table(operations);
    else
        for (const Operation& one : operations)
            if (!one.file.empty()) print_operation(one);
    if (a8) fmt::print("{}\n", verdict_text("A(8)", "m/s^2", day, signal::hand_arm_limits, is_bound));
    else fmt::print("no A(8) of the day: {}\n", no_day(bad));
    return bad ? bad_input : done;
}

int body_exposure(const ExposureChoice& choice, const std::vector<std::filesystem::path>& files) {
    const std::vector<double> durations = durations_of(choice, files.size());
    const analysis::ExposureSettings settings{choice.settings(), choice.uncalibrated, choice.axes};
    const bool is_health = choice.body == "whole";
    const auto judgement = is_health ? signal::BodyJudgement::health : signal::BodyJudgement::rail_comfort;
    std::vector<analysis::BodyOperation> operations(files.size());
    const std::vector<std::string> failures =
        run_batch(files.size(), choice.jobs, "files", [&](std::size_t i, const std::function<void(double)>& progress) {
            operations[i] = analysis::analyse_body_exposure(files[i], settings, judgement, durations[i], progress);
        });
    const bool bad = tell_failures(failures) > 0;
    if (!choice.table.empty()) {
        std::string table = body_table_header();
        for (std::size_t i = 0; i < files.size(); ++i)
            table += failures[i].empty()
                         ? body_table_rows(operations[i])
                         : fmt::format("{},,,,,,,,,,,,,,{}\n", csv_field(files[i].string()), csv_field(failures[i]));
        file::write_whole_file(choice.table, table);
    }
    if (bad && files.size() == 1 && !choice.json) return bad_input;
    std::optional<analysis::BodyDay> day;
    if (!bad && is_health) day = analysis::body_day(operations);
    if (choice.json) {
        Json json{{"body", choice.body}, {"day", body_day_json(day)}, {"operations", Json::array()}};
        for (std::size_t i = 0; i < files.size(); ++i)
            json["operations"].push_back(failures[i].empty()
                                             ? body_json(operations[i])
                                             : Json{{"file", files[i].string()}, {"error", failures[i]}});
        fmt::print("{}\n", json.dump(2));
        return bad ? bad_input : done;
    }
    for (const analysis::BodyOperation& one : operations)
        if (!one.file.empty()) fmt::print("{}", body_text(one));
    if (day) fmt::print("{}", body_day_text(*day));
    else if (is_health) fmt::print("no A(8) of the day: {}\n", no_day(bad));
    return bad ? bad_input : done;
}

int exposure(const ExposureChoice& choice) {
    const std::vector<std::filesystem::path> files = analysis::expand_folders(choice.files);
    return choice.body == "hand" ? hand_exposure(choice, files) : body_exposure(choice, files);
}

Action declare_exposure(VerbOptions& verb) {
    const auto choice = std::make_shared<ExposureChoice>();
    add_record_options(verb, *choice, "one record per tool, with the axes as channels; or folders of records");
    verb.add("--duration", choice->durations,
             "contact time per day, such as \"90 min\" (default 8 h); one for all, or one per file")
        .one_each();
    verb.add("--body", choice->body,
             "hand: ISO 5349-1; whole: ISO 2631-1, health of a seated or standing person; rail: ISO 2631-4, comfort in "
             "trains")
        .shows_default()
        .one_of({"hand", "whole", "rail"});
    verb.add("--axes", choice->axes,
             "whole body: the axis of each channel, such as xyz or z; z is along the spine (default: from the names of "
             "the channels; of three others xyz)")
        .value_name("LETTERS");
    verb.flag("--uncalibrated", choice->uncalibrated, "interpret the values of an uncalibrated record as m/s^2");
    verb.add("--table", choice->table, "a row per file, CSV");
    verb.add("--jobs", choice->jobs, "files at a time, 0: one per core").range(0, 256);
    return [choice] { return exposure(*choice); };
}

}  // namespace

Verb exposure_verb() {
    return {"exposure",
            "vibration exposure of the hand (ISO 5349-1) or the whole body (ISO 2631): A(8), VDV, minutes to action "
            "and limit value",
            declare_exposure};
}

}  // namespace tactus::command

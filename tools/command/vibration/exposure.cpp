// SPDX-License-Identifier: Apache-2.0
// tactus exposure: vibration exposure of the hand (ISO 5349-1) and of the whole body (ISO 2631-1, -4).
#include "tools/analysis/vibration/exposure.hpp"
#include "assets/file/json.hpp"
#include "assets/table/csv_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/result_options.hpp"
#include "tools/command/vibration/record_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/exposure_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <functional>
#include <memory>

namespace tactus::command {

namespace {

using file::Json;
namespace fs = std::filesystem;

struct ExposureChoice : RecordChoice {
    std::vector<std::string> durations;  // quantities of time; a bare number is hours
    std::string body = "hand", axes;     // of the body: hand, whole or rail; "xyz"
    bool uncalibrated = false;           // take values of a record without calibration as m/s²
    int jobs = 0;                        // files at a time, 0: one per core
    fs::path table;
    ResultChoice result;
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

/// The operations of all files and their errors.
template <class Operation>
struct Batch {
    std::vector<Operation> operations;
    std::vector<std::string> errors;
    bool is_bad = false;
};

template <class Analyse>
auto analyse_all(const ExposureChoice& choice, const std::vector<fs::path>& files, Analyse analyse) {
    const std::vector<double> durations = durations_of(choice, files.size());
    const analysis::ExposureSettings settings{choice.settings(), choice.uncalibrated, choice.axes};
    const auto one = [&](std::size_t i, const std::function<void(double)>& progress) {
        return analyse(files[i], settings, durations[i], progress);
    };
    Batch<decltype(one(0, nullptr))> batch;
    batch.operations.resize(files.size());
    batch.errors = run_batch(
        files.size(), choice.jobs, "files",
        [&](std::size_t i, const std::function<void(double)>& progress) { batch.operations[i] = one(i, progress); },
        choice.result.quiet);
    batch.is_bad = tell_failures(batch.errors) > 0;
    return batch;
}

/// `rows_of`: the rows of an operation, without the name of its file.
template <class Operation, class RowsOf>
void write_table(const ExposureChoice& choice, const std::vector<fs::path>& files, const Batch<Operation>& batch,
                 std::vector<std::string> columns, RowsOf rows_of) {
    if (choice.table.empty()) return;
    std::vector<Json> rows;
    for (std::size_t i = 0; i < files.size(); ++i)
        for (Json& row :
             batch.errors[i].empty() ? rows_of(batch.operations[i]) : std::vector{Json{{"error", batch.errors[i]}}}) {
            row["file"] = files[i].string();
            rows.push_back(std::move(row));
        }
    table::save_csv(choice.table, report::csv_table(columns, rows));
}

template <class Value>
int finish(const ExposureChoice& choice, const report::Fields<Value>& fields, const Value& value, bool is_bad) {
    // Of one bad file only its error is printed.
    if (!is_bad || value.operations.size() > 1 || choice.result.json) write_result(fields.of(value), choice.result);
    return is_bad ? bad_input : done;
}

int hand_exposure(const ExposureChoice& choice, const std::vector<fs::path>& files) {
    if (!choice.axes.empty())
        throw Error("--axes is of --body whole and --body rail; the hand has one weighting for all");
    const auto batch = analyse_all(choice, files, analysis::analyse_exposure);
    const std::vector<std::string> columns{"file",
                                           "a_hw_1",
                                           "a_hw_2",
                                           "a_hw_3",
                                           "a_hv",
                                           "a8",
                                           "duration_s",
                                           "minutes_to_action",
                                           "minutes_to_limit",
                                           "calibrated",
                                           "band_low_hz",
                                           "band_high_hz",
                                           "notes",
                                           "error"};
    write_table(choice, files, batch, columns, [](const analysis::ExposureOperation& one) {
        Json row = report::json_of(report::hand_operation_fields().of(one));
        for (std::size_t i = 0; i < one.weighted.size(); ++i) row[fmt::format("a_hw_{}", i + 1)] = one.weighted[i];
        row["band_low_hz"] = row["band_hz"][0];
        row["band_high_hz"] = row["band_hz"][1];
        row["notes"] = fmt::format("{}", fmt::join(one.notes, "; "));
        return std::vector{row};
    });
    report::HandExposure found{report::tried(files, batch.operations, batch.errors), {}, no_day(batch.is_bad)};
    // Without all files there is no A(8) of the day.
    if (!batch.is_bad) found.a8 = analysis::exposure_of_day(batch.operations);
    return finish(choice, report::hand_exposure_fields(), found, batch.is_bad);
}

int body_exposure(const ExposureChoice& choice, const std::vector<fs::path>& files) {
    const bool is_health = choice.body == "whole";
    const auto judgement = is_health ? signal::BodyJudgement::health : signal::BodyJudgement::rail_comfort;
    const auto batch = analyse_all(
        choice, files,
        [&](const auto& file, const auto& settings, double duration, const std::function<void(double)>& progress) {
            return analysis::analyse_body_exposure(file, settings, judgement, duration, progress);
        });
    const std::vector<std::string> columns{"file", "axis",    "weighting",  "factor",      "a_w",
                                           "mtvv", "vdv",     "crest",      "measured_s",  "duration_s",
                                           "a8",   "vdv_day", "calibrated", "lower_bound", "error"};
    write_table(choice, files, batch, columns, [](const analysis::BodyOperation& one) {
        std::vector<Json> rows;
        for (const report::BodyAxisOf& axis : report::axes_of(one)) {
            rows.push_back(report::json_of(report::body_axis_fields().of(axis)));
            rows.back()["duration_s"] = one.duration;
            rows.back()["calibrated"] = one.calibrated;
            rows.back()["lower_bound"] = one.is_lower_bound();
        }
        return rows;
    });
    report::BodyExposure found{
        choice.body, report::tried(files, batch.operations, batch.errors), {}, no_day(batch.is_bad)};
    if (!batch.is_bad && is_health) found.day = analysis::body_day(batch.operations);
    return finish(choice, report::body_exposure_fields(), found, batch.is_bad);
}

int exposure(const ExposureChoice& choice) {
    check_result_files(choice.result, choice.files);
    const std::vector<fs::path> files = analysis::expand_folders(choice.files);
    return choice.body == "hand" ? hand_exposure(choice, files) : body_exposure(choice, files);
}

Json schema() {
    return report::schema_of_output({report::hand_exposure_fields().schema(), report::body_exposure_fields().schema()});
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
    verb.output("--table", choice->table, {{".csv"}}, "a row per file, CSV");
    verb.add("--jobs", choice->jobs, "files at a time, 0: one per core").range(0, 256);
    add_result_options(verb, choice->result, ResultFigure::none);
    return [choice] { return exposure(*choice); };
}

}  // namespace

Verb exposure_verb() {
    return {.name = "exposure",
            .about =
                "vibration exposure of the hand (ISO 5349-1) or the whole body (ISO 2631): A(8), VDV, minutes to "
                "action and limit value",
            .add = declare_exposure,
            .schema = schema};
}

}  // namespace tactus::command

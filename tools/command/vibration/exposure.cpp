// SPDX-License-Identifier: Apache-2.0
// Vibration exposure of the hand.
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "dsp/exposure/hand_arm.hpp"
#include "dsp/spectrum/level.hpp"
#include "dsp/spectrum/vibration_analysis.hpp"
#include "tools/command/batch.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>

namespace tactus {

using Json = nlohmann::ordered_json;

namespace {

struct Operation {
    std::string file;
    std::vector<std::string> axes;
    std::vector<double> weighted, filtered;  // m/s², from the spectrum and from the filter
    double rate = 0.0, duration = 0.0;       // Hz; s per day
    bool calibrated = false, three_axes = false;
    double band_high = hand_arm_highest;
    std::vector<std::string> notes;

    double total() const { return vibration_total(weighted); }
};

double parse_duration(const std::string& text) {
    double hours = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), hours);
    const double seconds =
        failure == std::errc{} && end == text.data() + text.size() ? 3600.0 * hours : parse_as(text, "s");
    if (!(seconds > 0.0) || !(seconds <= 24.0 * 3600.0))
        throw Error(fmt::format("--duration takes a time up to 24 h, such as \"90 min\", not '{}'", text));
    return seconds;
}

Operation analyse(const std::filesystem::path& file, const ExposureChoice& choice, double duration,
                  const std::function<void(double)>& progress) {
    RecordReader reader = open_record(file, choice);
    const Calibration& calibration = reader.calibration();
    if (!calibration.known && !choice.uncalibrated)
        throw Error(fmt::format(
            "{}: the record is not calibrated; say what full scale is worth with --full-scale \"49 m/s^2\", "
            "or take its values as m/s^2 with --uncalibrated",
            file.string()));
    if (calibration.known && !calibration.is_acceleration)
        throw Error(fmt::format("{}: exposure needs an acceleration, not {}", file.string(), calibration.unit));
    const std::vector<std::size_t> chosen = chosen_channels(reader, file, choice);
    if (chosen.size() > 3)
        throw Error(fmt::format("{}: {} channels; choose the axes with --channel", file.string(), chosen.size()));
    Operation out;
    out.file = file.string();
    out.rate = reader.rate();
    out.duration = duration;
    out.calibrated = calibration.known;
    out.three_axes = chosen.size() == 3;
    const double nyquist = reader.log() ? std::min(0.5 * out.rate, reader.log()->usable) : 0.5 * out.rate;
    out.band_high = std::min(hand_arm_highest, nyquist);

    WelchSettings settings;
    settings.rate = out.rate;
    settings.segment = suggested_segment(out.rate, reader.frames());
    settings.overlap = settings.segment / 2;
    std::vector<WelchStream<double>> spectra(chosen.size(), WelchStream<double>(settings));
    std::vector<HandArmFilter> filters(chosen.size(), HandArmFilter(out.rate));
    std::vector<double> squares(chosen.size()), offsets(chosen.size()), scaled;
    std::vector<Level> levels(chosen.size());
    std::size_t count = 0;
    RecordBlock block;
    while (reader.next(block)) {
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            scaled = block.channels[chosen[i]];
            for (double& x : scaled) x *= calibration.si;
            levels[i].push(scaled);
            if (block.after_gap) spectra[i].forget_waiting();
            spectra[i].push(scaled);
            // A constant is no vibration: the filter must not hear it begin.
            if (count == 0) offsets[i] = scaled.front();
            for (const double x : scaled) {
                const double y = filters[i](x - offsets[i]);
                squares[i] += y * y;
            }
        }
        count += block.size();
        progress(static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, reader.frames())));
    }
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        out.axes.push_back(reader.channels()[chosen[i]]);
        out.weighted.push_back(weighted_acceleration(spectra[i].spectrum()));
        out.filtered.push_back(std::sqrt(squares[i] / static_cast<double>(std::max<std::size_t>(1, count))));
        if (levels[i].clipped() > 0)
            out.notes.push_back(fmt::format("axis {} is clipped in {} samples: the value is too low", out.axes.back(),
                                            levels[i].clipped()));
    }
    if (!out.calibrated) out.notes.push_back("uncalibrated: values in the file were taken as m/s^2");
    if (out.band_high < 1250.0)
        out.notes.push_back(
            fmt::format("the record ends at {:.0f} Hz, below 1250 Hz: the values are lower bounds", out.band_high));
    if (!out.three_axes)
        out.notes.push_back(
            fmt::format("{} of three axes: no total value a_hv; A(8) and minutes come from these axes alone "
                        "and are bounds",
                        out.axes.size()));
    if (out.rate < 20000.0)
        out.notes.push_back("below 20 kHz the filter strays from the norm; the spectrum's values count");
    const double minutes = static_cast<double>(count) / out.rate / 60.0;
    if (minutes < 1.0) out.notes.push_back("the norm asks for at least one minute of measurement in all");
    return out;
}

Json minutes_json(double value, double acceleration) {
    const double minutes = time_to_reach(value, acceleration) / 60.0;
    return std::isfinite(minutes) ? Json(minutes) : Json(nullptr);
}

std::string reached(double value, double acceleration) {
    const double minutes = time_to_reach(value, acceleration) / 60.0;
    return minutes <= 1440.0 ? fmt::format("after {:.0f} min", minutes) : "not within a day";
}

Json operation_json(const Operation& one) {
    return {{"a_hw", one.weighted},
            {"a_hv", one.three_axes ? Json(one.total()) : Json(nullptr)},
            {"a8", daily_exposure(std::array{HandArmOperation{one.total(), one.duration}})},
            {"minutes_to_action", minutes_json(action_value, one.total())},
            {"minutes_to_limit", minutes_json(limit_value, one.total())},
            {"calibrated", one.calibrated},
            {"band_hz", {hand_arm_lowest, one.band_high}},
            {"lower_bound", one.band_high < 1250.0 || !one.three_axes},
            {"a_hw_filter", one.filtered},
            {"axes", one.axes},
            {"file", one.file},
            {"duration_s", one.duration},
            {"notes", one.notes}};
}

/// Of the day, when its durations fit into one and no file is missing.
std::optional<double> daily(const std::vector<Operation>& operations, const std::vector<std::string>& failures) {
    std::vector<HandArmOperation> day;
    double seconds = 0.0;
    for (std::size_t i = 0; i < operations.size(); ++i) {
        if (!failures[i].empty()) return std::nullopt;
        day.push_back({operations[i].total(), operations[i].duration});
        seconds += operations[i].duration;
    }
    if (seconds > 24.0 * 3600.0) return std::nullopt;
    return daily_exposure(day);
}

std::string table_row(const Operation& one) {
    std::string axes, notes;
    for (std::size_t i = 0; i < 3; ++i)
        axes += i < one.weighted.size() ? fmt::format("{},", one.weighted[i]) : std::string(",");
    for (const std::string& note : one.notes) notes += (notes.empty() ? "" : "; ") + note;
    const auto minutes = [&](double value) {
        const double found = time_to_reach(value, one.total()) / 60.0;
        return std::isfinite(found) ? fmt::format("{}", found) : std::string();
    };
    return fmt::format("{},{}{},{},{},{},{},{},{},{},{},\n", csv_field(one.file), axes,
                       one.three_axes ? fmt::format("{}", one.total()) : std::string(),
                       daily_exposure(std::array{HandArmOperation{one.total(), one.duration}}), one.duration,
                       minutes(action_value), minutes(limit_value), one.calibrated, hand_arm_lowest, one.band_high,
                       csv_field(notes));
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
    write_whole_file(choice.table, table);
}

void print_operation(const Operation& one) {
    fmt::print("{}: {:.0f} min a day\n", one.file, one.duration / 60.0);
    for (std::size_t i = 0; i < one.axes.size(); ++i)
        fmt::print("  axis {}: a_hw {:.3g} m/s^2 (by filter {:.3g})\n", one.axes[i], one.weighted[i], one.filtered[i]);
    if (one.three_axes) fmt::print("  a_hv {:.3g} m/s^2\n", one.total());
    fmt::print("  action value {}, limit value {}\n", reached(action_value, one.total()),
               reached(limit_value, one.total()));
    for (const std::string& note : one.notes) fmt::print("  {}\n", note);
}

/// A line per file, for more of them than one cares to read about one by one.
void print_table(const std::vector<Operation>& operations) {
    std::size_t width = 4;
    for (const Operation& one : operations) width = std::max(width, one.file.size());
    fmt::print("{:<{}}  {:>9}  {:>9}  {:>8}  {:>18}  {}\n", "file", width, "a, m/s^2", "A(8)", "min/day",
               "action value", "limit value");
    for (const Operation& one : operations)
        if (!one.file.empty())
            fmt::print("{:<{}}  {:>9.3g}  {:>9.3g}  {:>8.0f}  {:>18}  {}{}\n", one.file, width, one.total(),
                       daily_exposure(std::array{HandArmOperation{one.total(), one.duration}}), one.duration / 60.0,
                       reached(action_value, one.total()), reached(limit_value, one.total()),
                       one.band_high < 1250.0 || !one.three_axes || !one.calibrated ? "  (see --table)" : "");
}

}  // namespace

int exposure_verb(const ExposureChoice& choice) {
    const std::vector<std::filesystem::path> files = expand_folders(choice.files);
    if (choice.durations.size() > 1 && choice.durations.size() != files.size())
        throw Error(fmt::format("there are {} durations for {} files; give one, or one per file",
                                choice.durations.size(), files.size()));
    std::vector<double> durations;
    for (const std::string& text : choice.durations) durations.push_back(parse_duration(text));
    if (durations.empty()) durations.push_back(reference_day);
    std::vector<Operation> operations(files.size());
    const std::vector<std::string> failures =
        run_batch(files.size(), choice.jobs, "files", [&](std::size_t i, const std::function<void(double)>& progress) {
            operations[i] = analyse(files[i], choice, durations[std::min(i, durations.size() - 1)], progress);
        });
    const bool bad = tell_failures(failures) > 0;
    if (!choice.table.empty()) write_table(choice, operations, files, failures);
    if (bad && files.size() == 1) return bad_input;
    const std::optional<double> a8 = daily(operations, failures);
    if (choice.json) {
        Json json;
        if (files.size() == 1) {
            json = operation_json(operations.front());
        } else {
            json = {{"a8", a8 ? Json(*a8) : Json()}, {"operations", Json::array()}};
            for (std::size_t i = 0; i < files.size(); ++i)
                json["operations"].push_back(failures[i].empty()
                                                 ? operation_json(operations[i])
                                                 : Json{{"file", files[i].string()}, {"error", failures[i]}});
        }
        json["years_to_white_fingers"] = a8 && *a8 > 0.0 ? Json(years_to_white_fingers(*a8)) : Json(nullptr);
        fmt::print("{}\n", json.dump(2));
        return bad ? bad_input : done;
    }
    if (files.size() > 3) print_table(operations);
    else
        for (const Operation& one : operations)
            if (!one.file.empty()) print_operation(one);
    if (a8)
        fmt::print("A(8) {:.3g} m/s^2: {}\n", *a8,
                   *a8 > limit_value    ? "above the limit value, 5"
                   : *a8 > action_value ? "above the action value, 2.5"
                                        : "below the action value, 2.5");
    else
        fmt::print(
            "no A(8) of the day: {}\n",
            bad ? "a file could not be used" : "the durations add up to more than 24 h; state them with --duration");
    return bad ? bad_input : done;
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/record.hpp"

#include "assets/file/extension.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace tactus::analysis {

sound::RecordReader open_record(const std::filesystem::path& file, const RecordSettings& settings) {
    std::optional<sound::Calibration> calibration;
    if (!settings.calibration.empty()) calibration = sound::parse_calibration(settings.calibration);
    std::optional<sound::Sensitivity> sensitivity;
    if (!settings.sensitivity.empty()) sensitivity = sound::parse_sensitivity(settings.sensitivity);
    return {file, settings.log, calibration, sensitivity, settings.stretch};
}

std::vector<std::string> understood(const sound::Calibration& calibration, const std::optional<sound::LogFacts>& log,
                                    double rate) {
    std::vector<std::string> lines;
    if (!calibration.file_note.empty()) lines.push_back(calibration.file_note);
    if (log) {
        lines.push_back("read as: " + table::describe(log->form));
        const std::string steps =
            log->is_even() ? fmt::format("log, {} rows, even steps of {}{}", log->rows, readable(1.0 / rate, "s", 4),
                                         log->gaps > 0 ? " between gaps" : "")
                           : fmt::format(
                                 "uneven log, {} rows, steps {} to {}, standard deviation {}: "
                                 "resampled",
                                 log->rows, readable(log->shortest_step, "s"), readable(log->longest_step, "s"),
                                 readable(log->step_deviation, "s", 2));
        if (log->clock_step > 0.0)
            lines.push_back(fmt::format("the clock counts in steps of {}: its rounded times were taken as even",
                                        readable(log->clock_step, "s")));
        lines.push_back(fmt::format("{}; limited to {}, reliable to about {}; faster vibration is aliased", steps,
                                    readable(0.5 * rate, "Hz", 4), readable(log->usable, "Hz")));
    }
    if (calibration.known)
        lines.push_back(fmt::format("calibration: {} is {:.6g} {}, from {}", log ? "a value of 1" : "full scale",
                                    calibration.factor, calibration.unit, calibration.source));
    if (!calibration.remark.empty()) lines.push_back("calibration: " + calibration.remark);
    return lines;
}

std::vector<std::size_t> chosen_channels(const sound::RecordReader& reader, const std::filesystem::path& file,
                                         const RecordSettings& settings) {
    std::vector<std::size_t> chosen;
    for (const int channel : settings.channels) {
        if (channel < 1 || static_cast<std::size_t>(channel) > reader.channels().size())
            throw Error(fmt::format("{}: there is no channel {}; there are {}", file.string(), channel,
                                    reader.channels().size()));
        chosen.push_back(static_cast<std::size_t>(channel - 1));
    }
    if (chosen.empty()) {
        chosen.resize(reader.channels().size());
        std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    }
    return chosen;
}

std::vector<std::filesystem::path> expand_folders(const std::vector<std::filesystem::path>& files) {
    // Files of text with other endings may be anything.
    constexpr std::array endings{".wav", ".rf64", ".w64", ".flac", ".aiff", ".aif", ".aifc", ".caf", ".ogg",  ".opus",
                                 ".au",  ".csv",  ".tsv", ".lvm",  ".uff",  ".unv", ".uf",   ".58",  ".bunv", ".mat"};
    std::vector<std::filesystem::path> out;
    for (const std::filesystem::path& file : files) {
        if (!std::filesystem::is_directory(file)) {
            out.push_back(file);
            continue;
        }
        std::vector<std::filesystem::path> inside;
        for (const auto& entry : std::filesystem::directory_iterator(file))
            if (entry.is_regular_file() &&
                std::find(endings.begin(), endings.end(), file::extension_of(entry.path())) != endings.end())
                inside.push_back(entry.path());
        if (inside.empty()) throw Error(fmt::format("{}: the folder holds no record", file.string()));
        std::sort(inside.begin(), inside.end());
        out.insert(out.end(), inside.begin(), inside.end());
    }
    return out;
}

}  // namespace tactus::analysis

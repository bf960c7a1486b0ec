// SPDX-License-Identifier: Apache-2.0
// What vibrates in a record, or in each of many.
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/comparison_figure.hpp"
#include "tools/spectrum_analysis.hpp"
#include "tools/spectrum_figure.hpp"
#include "tools/summary.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <mutex>
#include <thread>

namespace tactus {

namespace {

struct Outcome {
    std::string text, error;
    std::string table;  // rows
};

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

std::string table_rows(const AnalysedFile& file) {
    std::string rows;
    for (const AnalysedChannel& c : file.channels) {
        const VibrationReport& r = c.report;
        std::string hum, warnings;
        for (const HumLine& h : r.hum) hum += fmt::format("{}{:.2f}", hum.empty() ? "" : " ", h.frequency);
        for (const std::string& warning : c.warnings) warnings += (warnings.empty() ? "" : "; ") + warning;
        rows += fmt::format("{},{},{},{},{},{},{},{},{},{},{},\n", csv_field(file.file.string()), csv_field(c.name),
                            file.rate, file.duration, r.level.rms(), csv_field(file.calibration.unit), r.level.crest(),
                            r.fundamental.frequency > 0.0 ? fmt::format("{}", r.fundamental.frequency) : "",
                            r.fundamental.confidence, hum, csv_field(warnings));
    }
    return rows;
}

Outcome analyse(const std::filesystem::path& path, const SpectrumChoice& choice, bool many,
                const std::function<void(double)>& progress) {
    const AnalysedFile file = analyse_file(path, choice, progress);
    const auto output = [&](const std::filesystem::path& wanted, const char* ending) {
        return many ? wanted / (path.filename().string() + ending) : wanted;
    };
    if (!choice.csv.empty()) write_whole_file(output(choice.csv, ".csv"), analysis_csv(file));
    if (!choice.plot.empty()) write_figure(draw_spectrum(file), output(choice.plot, ".svg"));
    return {choice.json ? analysis_json(file, choice) : analysis_text(file), "", table_rows(file)};
}

void print(const std::vector<std::filesystem::path>& files, const std::vector<Outcome>& outcomes,
           const SpectrumChoice& choice) {
    if (!choice.json) {
        for (const Outcome& outcome : outcomes) fmt::print("{}", outcome.text);
        return;
    }
    if (files.size() == 1) {
        fmt::print("{}", outcomes.front().text);
        return;
    }
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (outcomes[i].error.empty()) all.push_back(nlohmann::ordered_json::parse(outcomes[i].text));
        else all.push_back({{"file", files[i].string()}, {"error", outcomes[i].error}});
    }
    fmt::print("{}\n", all.dump(2));
}

}  // namespace

int spectrum_verb(const SpectrumChoice& choice) {
    const std::vector<std::filesystem::path> files = expand_folders(choice.files);
    const bool many = files.size() > 1;
    if (many)
        for (const std::filesystem::path& folder : {choice.csv, choice.plot})
            if (!folder.empty()) std::filesystem::create_directories(folder);
    LiveLine line;
    std::mutex guard;
    std::vector<Outcome> outcomes(files.size());
    std::atomic<std::size_t> next{0};
    std::size_t finished = 0;
    const auto work = [&] {
        for (std::size_t i; (i = next.fetch_add(1)) < files.size();) {
            const auto progress = [&](double share) {
                const std::lock_guard lock(guard);
                if (many) line.show(fmt::format("{} of {} files", finished, files.size()));
                else line.show(fmt::format("{:3.0f} %", 100.0 * share));
            };
            try {
                outcomes[i] = analyse(files[i], choice, many, progress);
            } catch (const std::exception& error) {
                outcomes[i].error = error.what();
            }
            const std::lock_guard lock(guard);
            ++finished;
        }
    };
    {
        std::vector<std::jthread> others;
        for (std::size_t i = 1; i < std::min<std::size_t>(static_cast<std::size_t>(choice.jobs), files.size()); ++i)
            others.emplace_back(work);
        work();
    }
    line.clear();
    bool bad = false;
    for (const Outcome& outcome : outcomes)
        if (!outcome.error.empty()) {
            bad = true;
            fmt::print(stderr, "tactus: {}\n", outcome.error);
        }
    if (many || !bad) print(files, outcomes, choice);
    if (!choice.table.empty()) {
        std::string table =
            "file,channel,sample_rate_hz,duration_s,rms,unit,crest,fundamental_hz,confidence,hum_hz,warnings,error\n";
        for (std::size_t i = 0; i < files.size(); ++i)
            table += outcomes[i].error.empty()
                         ? outcomes[i].table
                         : fmt::format("{},,,,,,,,,,,{}\n", csv_field(files[i].string()), csv_field(outcomes[i].error));
        write_whole_file(choice.table, table);
    }
    return bad ? bad_input : done;
}

}  // namespace tactus

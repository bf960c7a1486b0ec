// SPDX-License-Identifier: Apache-2.0
// What vibrates in a record, or in each of many.
#include "assets/file/whole_file.hpp"
#include "tools/command/batch.hpp"
#include "tools/picture/report/comparison_figure.hpp"
#include "tools/picture/report/html_report.hpp"
#include "tools/study/vibration/spectrum_analysis.hpp"
#include "tools/picture/report/spectrum_figure.hpp"
#include "tools/picture/report/spectrum_page.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <functional>

namespace tactus {

namespace {

struct Outcome {
    std::string text, table;  // what is printed; rows
    std::string section;      // of a page
};

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
    return {choice.json ? analysis_json(file, choice) : analysis_text(file), table_rows(file),
            choice.report.empty() ? std::string() : analysis_section(file, choice)};
}

void print_json(const std::vector<std::filesystem::path>& files, const std::vector<Outcome>& outcomes,
                const std::vector<std::string>& failures) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (failures[i].empty()) all.push_back(nlohmann::ordered_json::parse(outcomes[i].text));
        else all.push_back({{"file", files[i].string()}, {"error", failures[i]}});
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
    std::vector<Outcome> outcomes(files.size());
    const std::vector<std::string> failures =
        run_batch(files.size(), choice.jobs, "files", [&](std::size_t i, const std::function<void(double)>& progress) {
            outcomes[i] = analyse(files[i], choice, many, progress);
        });
    bool bad = false;
    for (const std::string& failure : failures)
        if (!failure.empty()) {
            bad = true;
            fmt::print(stderr, "tactus: {}\n", failure);
        }
    if (many && choice.json) print_json(files, outcomes, failures);
    else
        for (const Outcome& outcome : outcomes) fmt::print("{}", outcome.text);
    if (!choice.table.empty()) {
        std::string table =
            "file,channel,sample_rate_hz,duration_s,rms,unit,crest,fundamental_hz,confidence,hum_hz,warnings,error\n";
        for (std::size_t i = 0; i < files.size(); ++i)
            table += failures[i].empty()
                         ? outcomes[i].table
                         : fmt::format("{},,,,,,,,,,,{}\n", csv_field(files[i].string()), csv_field(failures[i]));
        write_whole_file(choice.table, table);
    }
    if (!choice.report.empty()) {
        std::string body;
        for (std::size_t i = 0; i < files.size(); ++i)
            body += failures[i].empty() ? outcomes[i].section
                                        : fmt::format("<p class=\"fail\">{}</p>\n", html::escaped(failures[i]));
        write_whole_file(choice.report, html::page(many ? "Vibration of " + std::to_string(files.size()) + " records"
                                                        : files.front().filename().string(),
                                                   body + analysis_method(choice)));
    }
    return bad ? bad_input : done;
}

}  // namespace tactus

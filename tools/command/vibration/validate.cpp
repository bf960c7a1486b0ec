// SPDX-License-Identifier: Apache-2.0
// Whether a patch makes of recordings what they are: the handle's vibration beside each of them, in free air and cutting.
#include "assets/file/whole_file.hpp"
#include "tools/command/batch.hpp"
#include "tools/picture/report/comparison_figure.hpp"
#include "tools/picture/report/comparison_page.hpp"
#include "tools/picture/report/html_report.hpp"
#include "tools/study/vibration/validation.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

struct Count {
    std::size_t passed = 0, failed = 0, bad = 0;
};

Json run_json(const ValidationRun& run) {
    Json json{{"file", run.recording->file.string()},
              {"state", run.recording->cutting ? "cutting" : "free_air"},
              {"rate_hz", run.recording->rate},
              {"load_N", run.recording->load},
              {"level_db", run.level_db},
              {"drive_rms_v", run.drive_rms ? Json(*run.drive_rms) : Json()},
              {"drive_peak_v", run.drive_peak ? Json(*run.drive_peak) : Json()}};
    if (!run.failure.empty()) json["error"] = run.failure;
    else json.update(Json::parse(comparison_json(run.pair)));
    return json;
}

std::string json_text(const Validation& validation, const Count& count) {
    Json json{{"patch", validation.patch},
              {"set", validation.set->path.string()},
              {"synthesised", validation.set->synthesised},
              {"calibrated", validation.set->calibrated()},
              {"out", validation.path.out},
              {"verdict", count.failed + count.bad == 0 ? "pass" : "fail"},
              {"passed", count.passed},
              {"failed", count.failed},
              {"bad", count.bad},
              {"runs", Json::array()}};
    for (const ValidationRun& run : validation.runs) json["runs"].push_back(run_json(run));
    return json.dump(2) + "\n";
}

void print(const Validation& validation, const Count& count) {
    fmt::print("{} at {}, beside {}{}\n", validation.patch, validation.path.out, validation.set->path.string(),
               validation.set->synthesised ? " (synthesised, no recordings)" : "");
    fmt::print("{}", validation_rows(validation));
    fmt::print("{}: {} of {} have the vibration of their recording\n", count.failed + count.bad == 0 ? "PASS" : "FAIL",
               count.passed, validation.runs.size());
}

std::string page(const Validation& validation, const Count& count) {
    const bool passed = count.failed + count.bad == 0;
    std::string body = fmt::format(
        "<p>Patch {}, vibration at {}; reference {}{}.</p>\n<p class=\"{}\"><b>{} of {} have the vibration of their "
        "recording.</b></p>\n",
        html::escaped(validation.patch), html::escaped(validation.path.out),
        html::escaped(validation.set->title.empty() ? validation.set->path.string() : validation.set->title),
        validation.set->synthesised ? ", which was computed and not recorded" : "", passed ? "pass" : "fail",
        count.passed, validation.runs.size());
    body += validation_table(validation);
    const ComparedPair* last = nullptr;
    for (std::size_t i = 0; i < validation.runs.size(); ++i) {
        const ValidationRun& run = validation.runs[i];
        if (!run.failure.empty()) continue;
        last = &run.pair;
        body += fmt::format("<h2>{}</h2>\n", html::escaped(run.name())) +
                comparison_section(run.pair, fmt::format("v{}x", i));
    }
    body += "<h2>How it was made</h2><ul>";
    body +=
        "<li>Each run is one offline rendering of the patch in which the saw plays the set at the recording's rate "
        "and load, without the hand, the bone and whatever else does not lead to the handle. The first second is "
        "not compared.</li>";
    body +=
        "<li>The equaliser, if there is one, was made from sweeps. No recording was used to make it, and the drive "
        "of each run is stated in the table, so that it can be held against the level of those sweeps.</li>";
    body +=
        "<li>\"Softer by\" is what the handle lacks in power from 40 to 1000 Hz. An equaliser restores shape, not "
        "level.</li></ul>\n";
    if (last) body += comparison_method(*last);
    return html::page(passed ? "The handle vibrates as the saw did" : "The handle does not vibrate as the saw did",
                      body);
}

}  // namespace

int validate_verb(const ValidateChoice& choice) {
    const Thresholds thresholds = choice.thresholds.empty() ? Thresholds{} : load_thresholds(choice.thresholds);
    Validation validation = plan_validation(choice, thresholds);
    const bool pictures = !choice.report.empty() || !choice.plot.empty();
    if (!choice.plot.empty()) std::filesystem::create_directories(choice.plot);
    const std::vector<std::string> failures = run_batch(
        validation.runs.size(), choice.jobs, "runs",
        [&](std::size_t i, const std::function<void(double)>&) {  // Spectrograms are large; one level shows them.
            validate(validation, i, choice, pictures && validation.runs[i].level_db == choice.levels.front());
        });
    Count count;
    count.bad = tell_failures(failures);
    for (std::size_t i = 0; i < failures.size(); ++i) {
        ValidationRun& run = validation.runs[i];
        run.failure = failures[i];
        if (!run.failure.empty()) continue;
        ++(run.pair.verdict.passed() ? count.passed : count.failed);
        if (!choice.plot.empty())
            write_figure(draw_comparison(run.pair), (choice.plot / (run.file_name() + ".svg")).string());
    }
    if (!choice.table.empty()) write_whole_file(choice.table, validation_csv(validation));
    if (!choice.report.empty()) write_whole_file(choice.report, page(validation, count));
    if (choice.json) fmt::print("{}", json_text(validation, count));
    else print(validation, count);
    return count.bad > 0 ? bad_input : count.failed > 0 ? answer_is_no : done;
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/validation_page.hpp"

#include "tools/report/figures/comparison_page.hpp"
#include "tools/report/figures/comparison_table.hpp"
#include "tools/report/figures/html_report.hpp"

#include <fmt/format.h>

namespace tactus::report {

namespace {

std::string shown(const std::optional<double>& value, const char* format) {
    return value ? fmt::format(fmt::runtime(format), *value) : std::string();
}

std::string validation_table(const analysis::Validation& validation) {
    std::string out =
        "<table><tr><th>saw</th><th class=\"n\">Hz</th><th class=\"n\">N</th><th class=\"n\">level, dB</th>"
        "<th class=\"n\">drive, V rms</th><th class=\"n\">peak, V</th>" +
        score_heading + "</tr>\n";
    for (const analysis::ValidationRun& run : validation.runs) {
        const sound::Recording& r = *run.recording;
        out += fmt::format(
            "<tr><td>{}</td><td class=\"n\">{:.4g}</td><td class=\"n\">{}</td><td class=\"n\">{:+g}</td>"
            "<td class=\"n\">{}</td><td class=\"n\">{}</td>",
            r.cutting ? "cutting" : "free air", r.rate, r.cutting ? fmt::format("{:g}", r.load) : "", run.level_db,
            shown(run.drive_rms, "{:.3f}"), shown(run.drive_peak, "{:.3f}"));
        out += score_cells(run.pair, run.failure) + "</tr>\n";
    }
    return out + "</table>\n";
}

}  // namespace

std::string validation_page(const analysis::Validation& validation) {
    std::size_t good = 0;
    for (const analysis::ValidationRun& run : validation.runs) good += run.failure.empty() && run.pair.verdict.passed();
    const bool passed = good == validation.runs.size();
    std::string body = fmt::format(
        "<p>Patch {}, vibration at {}; reference {}{}.</p>\n<p class=\"{}\"><b>{} of {} have the vibration of their "
        "recording.</b></p>\n",
        html::escaped(validation.patch), html::escaped(validation.path.out),
        html::escaped(validation.set->title.empty() ? validation.set->path.string() : validation.set->title),
        validation.set->synthesised ? ", which was computed and not recorded" : "", passed ? "pass" : "fail", good,
        validation.runs.size());
    body += validation_table(validation);
    const analysis::ComparedPair* last = nullptr;
    for (std::size_t i = 0; i < validation.runs.size(); ++i) {
        const analysis::ValidationRun& run = validation.runs[i];
        if (!run.failure.empty()) continue;
        last = &run.pair;
        body += fmt::format("<h2>{}</h2>\n", html::escaped(run.name())) +
                comparison_section(run.pair, fmt::format("v{}x", i));
    }
    body += "<h2>How the runs were made</h2><ul>";
    body +=
        "<li>Each run is one offline rendering of the patch in which the saw plays the set at the recording's rate "
        "and load, without the hand, the bone and other nodes that do not lead to the handle. The first second is not "
        "compared.</li>";
    body +=
        "<li>The equaliser, if any, was designed from sweeps and not from recordings. The table states the drive of "
        "each run, for comparison with the level of those sweeps.</li>";
    body +=
        "<li>\"Softer by\" is the missing power of the handle from 40 to 1000 Hz. An equaliser corrects the shape, not "
        "the level.</li></ul>\n";
    if (last) body += comparison_method(*last);
    return html::page(passed ? "The handle vibrates as the saw did" : "The handle does not vibrate as the saw did",
                      body);
}

}  // namespace tactus::report

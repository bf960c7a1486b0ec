// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/comparison_table.hpp"

#include "tools/report/figures/html_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tactus::report {

namespace {

const std::string& failure_of(const std::vector<std::string>& failures, std::size_t i) {
    static const std::string none;
    return i < failures.size() ? failures[i] : none;
}

}  // namespace

std::string comparison_summary(std::span<const analysis::ComparedPair> pairs,
                               const std::vector<std::string>& failures) {
    std::string out = "<table><tr><th>output</th>" + score_heading + "</tr>\n";
    for (std::size_t i = 0; i < pairs.size(); ++i)
        out += "<tr><td>" + html::escaped(analysis::pair_name(pairs[i], pairs)) + "</td>" +
               score_cells(pairs[i], failure_of(failures, i)) + "</tr>\n";
    return out + "</table>\n";
}

const std::string score_heading =
    "<th>verdict</th><th class=\"n\">LSD, dB</th><th class=\"n\">cosine</th><th class=\"n\">worst order, dB</th>"
    "<th class=\"n\">worst band, dB</th><th class=\"n\">softer by, dB</th><th>fails by</th>";

std::string score_cells(const analysis::ComparedPair& pair, const std::string& failure) {
    if (!failure.empty()) return fmt::format("<td class=\"fail\" colspan=\"7\">{}</td>", html::escaped(failure));
    const signal::Comparison& c = pair.comparison;
    return fmt::format(
        "<td class=\"{0}\">{0}</td><td class=\"n\">{1:.2f}</td><td class=\"n\">{2:.4f}</td><td class=\"n\">{3}</td>"
        "<td class=\"n\">{4:.2f}</td><td class=\"n\">{5:.1f}</td><td>{6}</td>",
        pair.verdict.passed() ? "pass" : "fail", c.lsd_db, c.cosine_500,
        c.harmonic_error_db ? fmt::format("{:.2f}", *c.harmonic_error_db) : "–", c.third_octave_max_db, c.gain_db,
        fmt::join(pair.verdict.failed(), ", "));
}

}  // namespace tactus::report

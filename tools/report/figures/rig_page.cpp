// SPDX-License-Identifier: Apache-2.0
// The gripper report as a self-contained HTML page.
#include "tools/report/figures/rig_page.hpp"

#include "tools/report/figures/html_report.hpp"
#include "tools/report/figures/rig_figures.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::report {

namespace {

std::string number(const std::optional<double>& value, double scale, const char* format) {
    return value && std::isfinite(*value) ? fmt::format(fmt::runtime(format), *value * scale) : "–";
}

struct Fact {
    const char *what, *value, *source;
};

constexpr Fact facts[] = {
    {"rate of the control loop", "150 Hz", "thesis 6.3.3"},
    {"object", "spring and damper in parallel, F = k x + b ẋ", "thesis 6.3.3"},
    {"rig", "cord swung by 50 mm from end to end, two springs of 0.19 N/mm: 0.38 N/mm at the finger", "thesis 6.3.4.1"},
    {"walking motor: fastest finger", "70 mm/s, with a leverage of 4.5", "thesis 6.3.1"},
    {"walking motor: drive", "at most 3 kHz; so 5.19 µm of the rod per cycle", "thesis 2.5.2.2; the step follows"},
    {"walking motor: encoder", "16 000 pulses per mm of the rod: 0.28 µm at the finger", "thesis 6.3.1"},
    {"traveling-wave motor: encoder", "4000 pulses per turn, direct drive", "thesis 6.3.2"},
    {"traveling-wave motor: speed", "decreases off resonance and off 90°; the sign of the phase is the direction",
     "thesis 2.5.2.1"},
};

constexpr Fact models[] = {
    {"walking motor: holding force", "4.4 N at the finger: 20 N of the motor through the leverage", "assumed"},
    {"walking motor: lag", "2 ms", "assumed"},
    {"traveling-wave motor: fastest, slowest, dead zone", "600, 30 and 15 mm/s of the finger", "assumed"},
    {"traveling-wave motor: lag, holding force", "4 ms, 3 N", "assumed"},
    {"traveling-wave motor: lever", "70 mm from axis to finger: 0.11 mm per pulse", "assumed, as the other gripper's"},
    {"slip", "beyond the holding force the finger yields with 20 N s/m", "assumed"},
    {"strain gauge", "5 mN per count, 10 mN of noise", "assumed"},
    {"delay", "one tick from sample to motion", "assumed"},
    {"gain of the loop", "half of the stability limit, from the eigenvalues of loop, motor and rig",
     "thesis: as high as is stable"},
};

std::string table(std::span<const Fact> rows) {
    std::string out = "<table>";
    for (const Fact& row : rows)
        out += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>", row.what, row.value, row.source);
    return out + "</table>\n";
}

std::string rows_table(const analysis::RigReport& report) {
    std::string out =
        "<table><tr><th>motor</th><th>object</th><th class=\"n\">Hz</th><th class=\"n\">mm</th><th class=\"n\">gain, "
        "dB</th><th "
        "class=\"n\">phase, °</th><th class=\"n\">NRMSE, %</th><th class=\"n\">k, N/mm</th><th class=\"n\">b, N "
        "s/mm</th><th "
        "class=\"n\">slips, "
        "%</th><th class=\"n\">saturated, %</th><th class=\"n\">hunting, µm</th></tr>\n";
    for (const analysis::RigRow& row : report.rows) {
        const control::Fidelity& f = row.fidelity;
        out += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{:g}</td><td class=\"n\">{:g}</td>",
                           html::escaped(row.cell.motor), html::escaped(row.cell.object.name), row.cell.rate,
                           row.cell.amplitude * 1e3);
        if (!row.failure.empty()) {
            out += fmt::format("<td colspan=\"8\">{}</td></tr>\n", html::escaped(row.failure));
            continue;
        }
        for (const std::string& cell :
             {number(f.gain_error_db, 1.0, "{:.2f}"), number(f.phase_error_deg, 1.0, "{:.1f}"),
              number(f.nrmse, 100.0, "{:.1f}"), number(f.rendered_stiffness, 1e-3, "{:.4g}"),
              number(f.rendered_damping, 1e-3, "{:.3g}"), number(f.slip_share, 100.0, "{:.0f}"),
              number(f.saturated_share, 100.0, "{:.0f}"), number(f.limit_cycle_rms, 1e6, "{:.1f}")})
            out += "<td class=\"n\">" + cell + "</td>";
        out += "</tr>\n";
    }
    return out + "</table>\n";
}

}  // namespace

std::string rig_html(const analysis::RigReport& report) {
    std::string out = fmt::format("<p>{}</p>\n", html::escaped(report.source));
    out += "<h2>Summary</h2><ul>";
    out += fmt::format("<li>Peak speed of the cord at 1 Hz: {:.2f} mm/s.</li>", report.peak_cord_speed * 1e3);
    if (report.saturation_rate)
        out += fmt::format(
            "<li>In free motion the slower motor saturates from {:.3f} Hz on; {:.3f} Hz in closed form.</li>",
            *report.saturation_rate, report.saturation_closed_form.value_or(NAN));
    for (const analysis::RigFinding& f : report.findings)
        out += fmt::format("<li>{}: in {} of {} combinations of the assumptions.</li>", html::escaped(f.claim), f.holds,
                           f.of);
    for (const analysis::RigCrossover& c : report.crossover)
        out +=
            c.low ? fmt::format(
                        "<li>With {:g} N/mm and ±{:.3g} mm the second motor becomes the better one between {:.2f} and "
                        "{:.2f} Hz, "
                        "depending on the assumptions ({} of {} combinations cross).</li>",
                        c.stiffness * 1e-3, c.amplitude * 1e3, *c.low, c.high.value_or(*c.low), c.crossed, c.of)
                  : fmt::format("<li>With {:g} N/mm and ±{:.3g} mm the second motor never becomes the better one.</li>",
                                c.stiffness * 1e-3, c.amplitude * 1e3);
    for (const std::string& note : report.notes) out += "<li>" + html::escaped(note) + "</li>";
    out += "</ul>\n";
    if (!report.rows.empty()) {
        out +=
            "<h2>Error over rate</h2><p>Error of the position against the ideal object under the measured force, "
            "relative to its motion, over the samples without slip. For a wall: the penetration.</p>\n";
        out += html::drawing(draw_rig_errors(report), "a");
        out +=
            "<h2>Gain and phase</h2><p>Measured admittance over the object's, 1/(k + jωb), at the rate of the "
            "rig.</p>\n";
        out += html::drawing(draw_rig_response(report), "b");
    }
    if (!report.examples.empty()) {
        out += "<h2>Position over force</h2><p>Last cycle; dashed: the object.</p>\n";
        out += html::drawing(draw_rig_examples(report), "c");
    }
    if (!report.crossover.empty()) {
        out +=
            "<h2>Which motor is better</h2><p>Bands: all combinations of the limits of the assumptions about a "
            "motor.</p>\n";
        out += html::drawing(draw_rig_crossover(report), "d");
    }
    if (!report.leads.empty()) {
        out +=
            "<h2>Feed-forward</h2><p>Error of the loop of the thesis, which had none, over the error with the object's "
            "velocity fed "
            "forward; above 1 feed-forward is better.</p>\n";
        out += html::drawing(draw_rig_leads(report), "e");
    }
    if (!report.assumptions.empty()) {
        out += "<h2>Facts and assumptions</h2><p>Facts from the thesis (Olsson 2015):</p>" + table(facts);
        out += "<p>Assumptions of the simulated grippers, unless the patch says otherwise:</p>" + table(models);
        out += "<p>Ranges of the assumptions in the findings above:</p><table>";
        for (const analysis::RigAssumption& a : report.assumptions)
            out += fmt::format("<tr><td>{}</td><td>{}</td><td>{} to {}</td></tr>", html::escaped(a.motor),
                               html::escaped(a.option), html::escaped(a.low), html::escaped(a.high));
        out += "</table>\n";
    }
    out += "<h2>All cells</h2>\n" + rows_table(report);
    return html::page(report.title, out);
}

}  // namespace tactus::report

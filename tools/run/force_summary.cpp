// SPDX-License-Identifier: Apache-2.0
#include "tools/run/force_summary.hpp"

#include <fmt/format.h>

namespace tactus::run {

double number_in(const Report& report, const char* section, const char* key, double otherwise) {
    const auto s = report.sections.find(section);
    if (s == report.sections.end()) return otherwise;
    const auto k = s->second.find(key);
    if (k == s->second.end()) return otherwise;
    const double* v = std::get_if<double>(&k->second);
    return v ? *v : otherwise;
}

namespace {

/// Why forces went off, in brackets; empty: no fault did it.
std::string fault_of(const Report& report) {
    const auto force = report.sections.find("force");
    if (force == report.sections.end() || !(number_in(report, "force", "faults") > 0.0)) return "";
    const auto fault = force->second.find("fault");
    const auto* words = fault == force->second.end() ? nullptr : std::get_if<std::string>(&fault->second);
    return words ? fmt::format(" ({})", *words) : "";
}

}  // namespace

std::string force_text(const Report& report) {
    std::string text;
    if (const auto never = report.sections.find("forces_never_engaged"); never != report.sections.end())
        for (const auto& [node, newton] : never->second)
            text += fmt::format(
                "  {}: the hand never felt a force. It began in contact, where the patch asked for up to {:.2g} N; "
                "begin with the hand away from what it touches\n",
                node, std::get<double>(newton));
    const double off = number_in(report, "force", "off_s"), fraction = number_in(report, "contact", "fraction", -1.0);
    const bool has_thrust = number_in(report, "force", "thrust_mean_N", -1.0) >= 0.0;
    if (fraction >= 0.0)
        text += fmt::format("  contact {:.0f} % of the time, at most {:.2f} mm deep", 100.0 * fraction,
                            number_in(report, "contact", "max_penetration_mm"));
    if (fraction >= 0.0 && has_thrust && !(off > 0.0))
        text += fmt::format("; thrust {:.2f} N mean", number_in(report, "force", "thrust_mean_N"));
    if (fraction >= 0.0) text += "\n";
    if (const double limited = number_in(report, "contact", "limited_fraction"); limited >= 0.005)
        text += fmt::format(
            "  the force was limited {:.0f} % of the time in contact: the tool wanted more than the device gives, and "
            "cut "
            "with what it gave\n",
            100.0 * limited);
    if (const double scale = number_in(report, "force", "device_scale", 1.0); scale != 1.0)
        text += fmt::format("  forces on the device are {:g} times those of the tool\n", scale);
    if (const double waited = number_in(report, "contact", "waited_s"); waited >= 0.0005)
        text += fmt::format("  for {:.3g} s the tool lay in bone without force, until it was drawn out\n", waited);
    if (const double released = number_in(report, "contact", "releases"); released > 0.0)
        text +=
            fmt::format("  the tool was released from the bone {:.0f} time{}\n", released, released == 1.0 ? "" : "s");
    if (off > 0.0)
        text += fmt::format(
            "  forces were off for {:.3g} s in contact, from {:.3f} s to {:.3f} s{}: the hand did not feel what it "
            "touched then; over the whole contact it felt {:.2f} N mean\n",
            off, number_in(report, "force", "off_from_s"), number_in(report, "force", "off_until_s"), fault_of(report),
            number_in(report, "force", "felt_mean_N"));
    return text;
}

}  // namespace tactus::run

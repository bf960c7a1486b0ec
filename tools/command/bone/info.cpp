// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/bone/inspection.hpp"
#include "tools/analysis/bone/saw_spacing.hpp"
#include "tools/command/bone/scan_options.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/inspection_picture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>

namespace tactus::command {

namespace {

using analysis::InspectedPart;
using analysis::Inspection;

struct InfoChoice {
    std::filesystem::path input;
    std::filesystem::path out;  // picture: a file, or a folder for INPUT.png; empty: none
    analysis::InspectionOptions how;
    bool json = false;
};

file::Json json_of(const Inspection& found) {
    file::Json parts = file::Json::array();
    for (const InspectedPart& part : found.parts)
        parts.push_back({{"name", part.name}, {"volume_mm3", part.volume_mm3}, {"bounds_mm", part.bounds_mm}});
    file::Json json{{"kind", found.kind},
                    {"frame", found.frame},
                    {"size", found.size},
                    {"spacing_mm", found.spacing_mm},
                    {"uniform", found.uniform},
                    {"tilt_deg", found.tilt_deg},
                    {"hu", found.hu},
                    {"range", found.range},
                    {"suggested_threshold", nullptr},
                    {"unit", nullptr},
                    {"unit_question", nullptr},
                    {"components", parts},
                    {"notes", found.notes}};
    if (found.threshold) json["suggested_threshold"] = *found.threshold;
    if (!found.unit.empty()) json["unit"] = found.unit;
    if (!found.unit_question.empty()) json["unit_question"] = found.unit_question;
    return json;
}

// Logarithmic bars, because a CT is mostly air.
std::string bars(const volume::Histogram& histogram) {
    std::uint64_t most = 1;
    for (const std::uint64_t count : histogram.counts) most = std::max(most, count);
    std::string text;
    for (std::size_t n = 0; n < histogram.counts.size(); ++n) {
        const double share = std::log1p(double(histogram.counts[n])) / std::log1p(double(most));
        text += fmt::format("  {:>9.0f} {:<40} {}\n", histogram.middle(n),
                            std::string(static_cast<std::size_t>(share * 40.0), '#'), histogram.counts[n]);
    }
    return text;
}

/// In the unit in which the number is neither long nor zero.
std::string volume_text(double mm3) {
    if (mm3 >= 1e5) return fmt::format("{:.1f} cm³", mm3 * 1e-3);
    if (mm3 >= 100.0) return fmt::format("{:.0f} mm³", mm3);
    if (mm3 >= 1e-3) return fmt::format("{:.3g} mm³", mm3);
    return fmt::format("{:.0f} µm³", mm3 * 1e9);
}

std::string text_of(const Inspection& found) {
    const auto& [x, y, z] = found.spacing_mm;
    std::string text = fmt::format("kind: {}, frame {}\n", found.kind, found.frame);
    // Lengths below are right only if mm was meant.
    if (!found.unit_question.empty()) text += found.unit_question + "; until then, lengths are printed as if in mm\n";
    if (found.size[0] > 0)
        text += fmt::format("{} x {} x {} voxels of {:.4g} x {:.4g} x {:.4g} mm{}{}\n", found.size[0], found.size[1],
                            found.size[2], x, y, z, found.uniform ? "" : ", slices unevenly spaced",
                            found.tilt_deg > 0.05 ? fmt::format(", tilted by {:.1f} degrees", found.tilt_deg) : "");
    if (found.kind != "mesh") {
        text += fmt::format("values {:g} to {:g}, hu: {}\n", found.range[0], found.range[1], found.hu);
        text += bars(found.histogram);
    }
    if (found.threshold)
        text +=
            fmt::format("suggested threshold: {:g}{} ({}); import uses it unless --threshold is given\n",
                        *found.threshold, found.hu == "scanner" ? ", a scanner number" : " HU", found.threshold_from);
    text += fmt::format("{} component{}:\n", found.parts_in_all, found.parts_in_all == 1 ? "" : "s");
    for (const InspectedPart& part : found.parts) {
        const auto& b = part.bounds_mm;
        text += fmt::format("  {}: {}, x {:.1f}:{:.1f}, y {:.1f}:{:.1f}, z {:.1f}:{:.1f} mm\n", part.name,
                            volume_text(part.volume_mm3), b[0][0], b[0][1], b[1][0], b[1][1], b[2][0], b[2][1]);
    }
    if (found.parts_in_all > found.parts.size())
        text += fmt::format("  and {} smaller\n", found.parts_in_all - found.parts.size());
    if (found.kind == "ct" || found.kind == "bone") text += fmt::format("  {}\n", analysis::saw_line(found.spacing_mm));
    for (const std::string& note : found.notes) text += "  " + note + "\n";
    return text;
}

int info(const InfoChoice& choice) {
    const Inspection found = analysis::inspect(choice.input, choice.how);
    std::filesystem::path picture = choice.out;
    if (!picture.empty()) {
        if (std::filesystem::is_directory(picture))
            picture /= choice.input.lexically_normal().filename().string() + ".png";
        report::write_picture(found, picture);
    }
    if (choice.json) {
        fmt::print("{}\n", json_of(found).dump(2));
        return done;
    }
    fmt::print("{}: {}", choice.input.string(), text_of(found));
    if (picture.empty()) fmt::print("  a picture of it: -o PICTURE.png\n");
    else fmt::print("  picture: {}\n", picture.string());
    return done;
}

Action declare_info(VerbOptions& verb) {
    const auto choice = std::make_shared<InfoChoice>();
    verb.add("file", choice->input, "the file").required();
    verb.add("--series", choice->how.series,
             "DICOM: the series to look at, by its UID or the end of it; several between commas are joined");
    verb.flag("--fill-gaps", choice->how.fill_gaps, "DICOM: interpolate where slices are missing (default: refuse)");
    add_unit(verb, choice->how.unit);
    add_rescale(verb, [choice](const Rescale& rescale) { choice->how.rescale = rescale; });
    verb.add("-o,--out", choice->out,
             "a PNG of three slices and the surface, painted fractures red: a file, or a folder to put it in");
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return info(*choice); };
}

}  // namespace

Verb info_verb() { return {"info", "summarise a CT, label map, mesh or bone file", declare_info}; }

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/inspection.hpp"
#include "tools/command/bone/scan_options.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/bone/scan_result.hpp"
#include "tools/report/figures/inspection_picture.hpp"
#include "tools/report/result/printers.hpp"

#include <memory>
#include <vector>

namespace tactus::command {

namespace {

struct InfoChoice {
    std::filesystem::path input;
    analysis::InspectionOptions how;
    ResultChoice result;
};

/// A folder among the outputs is for INPUT.png.
std::filesystem::path picture_in(const std::filesystem::path& out, const std::filesystem::path& input) {
    return std::filesystem::is_directory(out) ? out / (input.lexically_normal().filename().string() + ".png") : out;
}

int info(const InfoChoice& given) {
    ResultChoice choice = given.result;
    for (std::filesystem::path& out : choice.out) out = picture_in(out, given.input);
    check_result_files(choice, {given.input});
    const analysis::Inspection found = analysis::inspect(given.input, given.how);
    const std::vector<std::filesystem::path> pictures = choice.products();
    for (const std::filesystem::path& picture : pictures) report::write_picture(found, picture);
    write_result(report::inspection_fields().of(
                     {given.input.string(), pictures.empty() ? "" : pictures.front().string(), &found}),
                 choice);
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
    add_result_options(
        verb, choice->result, ResultFigure::none,
        {{".png"}, "three slices and the surface, painted fractures red, also into a folder that is given instead"});
    return [choice] { return info(*choice); };
}

}  // namespace

Verb info_verb() {
    return {.name = "info", .about = "summarise a CT, label map, mesh or bone file", .add = declare_info, .schema = [] {
                return report::schema_of_output({report::inspection_fields().schema()});
            }};
}

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
// Whether what the actuator plays is what the saw did.
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/comparison_figure.hpp"
#include "tools/comparison_page.hpp"

#include <fmt/format.h>

namespace tactus {

int compare_verb(const CompareChoice& choice) {
    const Thresholds thresholds = choice.thresholds.empty() ? Thresholds{} : load_thresholds(choice.thresholds);
    if (!choice.plot.empty() && !choice.plot.ends_with(".svg") && !choice.plot.ends_with(".png"))
        throw Error(choice.plot + ": a figure is written as .svg or .png");
    const ComparedPair pair = compare_files(choice, thresholds, !choice.plot.empty() || !choice.report.empty());
    if (!choice.plot.empty()) write_figure(draw_comparison(pair), choice.plot);
    if (!choice.report.empty()) write_whole_file(choice.report, comparison_page(pair));
    if (choice.json) fmt::print("{}", comparison_json(pair));
    else print(pair);
    return pair.verdict.passed() ? done : answer_is_no;
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
// tactus sweep report: an HTML page of the results.
#include "assets/file/whole_file.hpp"
#include "tools/command/options.hpp"
#include "tools/command/sweep/sweep_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/sweep/sweep_page.hpp"
#include "tools/report/sweep/sweep_result.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

struct SweepReportChoice {
    std::filesystem::path folder, out;
};

Action declare_sweep_report(VerbOptions& verb) {
    const auto choice = std::make_shared<SweepReportChoice>();
    verb.add("folder", choice->folder, "folder of a sweep").required();
    verb.output("-o,--out", choice->out, {{".html"}}, "page; default: report.html in the folder");
    return [choice] {
        const analysis::SweepFolder folder(choice->folder, run::library_folder());
        const analysis::Results results(folder);
        const std::filesystem::path out = choice->out.empty() ? folder.path() / "report.html" : choice->out;
        file::write_whole_file(out, report::sweep_page(results));
        say(stdout,
            fmt::format("{}report: {}\n", report::text_of(report::sweep_state_fields().of(report::SweepState(results))),
                        out.string()));
        return done;
    };
}

}  // namespace

Verb sweep_report_verb() {
    return {"report", "results of a sweep as HTML: failures first, figures, and what ran it", declare_sweep_report};
}

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
#include "tools/command/figure_options.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/patch/patch_figure.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

namespace tactus::command {

namespace {

struct DrawChoice {
    run::PatchChoice patch;
    std::filesystem::path out;
    FigureChoice figure;
};

int draw(const DrawChoice& choice) {
    patch::Problems problems;
    const std::optional<compile::Schedule> plan = run::read_plan(choice.patch, problems);
    run::throw_problems(problems);
    const display::Figure figure = report::draw_patch(*plan);
    if (choice.out.empty()) fmt::print("{}", figure.svg());
    else save_figure(figure, choice.out, choice.figure);
    return done;
}

Action declare_draw(VerbOptions& verb) {
    const auto choice = std::make_shared<DrawChoice>();
    add_patch_options(verb, choice->patch);
    verb.output("-o,--out", choice->out, {{".svg", ".png", ".pdf"}},
                "file, .svg, .png or .pdf (default: SVG on standard output)");
    add_figure_options(verb, choice->figure);
    return [choice] { return draw(*choice); };
}

}  // namespace

Verb draw_verb() { return {"draw", "draw the graph", declare_draw}; }

}  // namespace tactus::command

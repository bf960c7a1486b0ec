// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/draw.hpp"
#include "assets/file/whole_file.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

namespace tactus::command {

namespace {

struct DrawChoice {
    run::PatchChoice patch;
    std::filesystem::path out;
};

int draw(const run::PatchChoice& choice, const std::filesystem::path& out) {
    patch::Problems problems;
    const std::optional<compile::Schedule> plan = run::read_plan(choice, problems);
    run::throw_problems(problems);
    const std::string svg = analyse::draw_svg(*plan);
    if (out.empty()) fmt::print("{}", svg);
    else file::write_whole_file(out, svg);
    return done;
}

Action declare_draw(VerbOptions& verb) {
    const auto choice = std::make_shared<DrawChoice>();
    add_patch_options(verb, choice->patch);
    verb.add("-o,--out", choice->out, "file (default: standard output)");
    return [choice] { return draw(choice->patch, choice->out); };
}

}  // namespace

Verb draw_verb() { return {"draw", "draw the graph as SVG", declare_draw}; }

}  // namespace tactus::command

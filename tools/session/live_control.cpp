// SPDX-License-Identifier: Apache-2.0
#include "tools/session/live_control.hpp"

#include "dsp/core/error.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::session {

LiveControl::LiveControl(run::Engine& engine, PatchChoice choice, compile::AssetCache& assets,
                         std::function<void(const std::string&)> say)
    : engine_(engine),
      choice_(std::move(choice)),
      assets_(assets),
      say_(std::move(say)),
      file_(find_patch(choice_.patch)),
      watch_(file_) {
    watch_.follow(patch::part_files(engine.plan().patch));
    if (!watch_.is_working())
        say_(fmt::format("{} cannot be watched; edits take effect at the next start", file_.string()));
    try {
        socket_ = std::make_unique<ControlSocket>();
    } catch (const Error& error) {
        say_(fmt::format("'tactus set' cannot reach this run: {}", error.what()));
    }
}

void LiveControl::tend() {
    if (watch_.was_saved()) take_over_file();
    if (socket_) socket_->serve([this](const std::string& line) { return answer(line); });
}

void LiveControl::take_over_file() {
    // Read here: what the take keeps is what is compiled, even if the file changes again.
    patch::Patch patch;
    try {
        patch::Problems unread;
        patch = patch::load_patch(file_, unread);
    } catch (const Error& error) {
        return say_(error.what());
    }
    watch_.follow(patch::part_files(patch));
    if (saved) return saved();
    const patch::Patch& runs = engine_.plan().patch;
    if (patch.text != runs.text || patch.parts != runs.parts) edit(std::move(patch.text));
}

void LiveControl::edit(std::string text) {
    const auto make = [this, text] {
        patch::Problems problems;
        std::optional<compile::Plan> plan =
            plan_of(patch::read_patch(text, file_, problems), choice_.overrides, choice_.seed, &assets_, problems);
        if (problems.empty()) return std::move(*plan);
        std::string all;
        for (const std::string& line : problem_lines(problems)) all += (all.empty() ? "" : "\n") + line;
        throw Error(all);
    };
    engine_.edit(make, [this](const run::EditOutcome& outcome) {
        if (outcome.error) say_(fmt::format("{}\nthe edit was not made; the patch runs on as it was", *outcome.error));
        else {
            watch_.follow(patch::part_files(engine_.plan().patch));
            say_(fmt::format("edit {} takes over at {:.3f} s; {} of {} nodes go on", outcome.generation,
                             seconds(outcome.when), outcome.kept, outcome.nodes));
        }
    });
}

std::string LiveControl::answer(const std::string& line) {
    const std::size_t dot = line.find('.'), equals = line.find('=');
    if (!line.starts_with("set ") || dot == std::string::npos || equals == std::string::npos || dot > equals)
        return "error write NODE.PARAM=VALUE, as in blade.stiffness=\"0.8 N/mm\"";
    try {
        const Flicks when =
            engine_.set(line.substr(4, dot - 4), line.substr(dot + 1, equals - dot - 1), line.substr(equals + 1));
        return fmt::format("{} from {:.3f} s", line.substr(4), seconds(when));
    } catch (const Error& error) {
        return fmt::format("error {}", error.what());
    }
}

}  // namespace tactus::session

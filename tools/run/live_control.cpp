// SPDX-License-Identifier: Apache-2.0
#include "tools/run/live_control.hpp"

#include "dsp/core/error.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

namespace tactus::run {

namespace {

/// The parameter of a button: every change of its value is a press.
constexpr const char* press = "press";

}  // namespace

LiveControl::LiveControl(run::Engine& engine, PatchChoice choice, compile::AssetCache& assets,
                         std::function<void(const std::string&)> say)
    : engine_(engine),
      choice_(std::move(choice)),
      assets_(assets),
      say_(std::move(say)),
      file_(file_of(choice_)),
      watch_(file_) {
    watch_.follow(patch::part_files(engine.plan().patch));
    // A patch that is not saved yet has nothing to watch.
    if (!watch_.is_working() && std::filesystem::exists(file_))
        say_(fmt::format("{} cannot be watched for changes; edits take effect at the next start", file_.string()));
    try {
        socket_ = std::make_unique<ControlSocket>();
    } catch (const Error& error) {
        say_(fmt::format("'tactus set' and 'tactus trigger' cannot reach this run: {}", error.what()));
    }
}

void LiveControl::tend() {
    if (watch_.was_saved()) take_over_file();
    if (socket_) socket_->serve([this](const std::string& line) { return answer(line); });
}

void LiveControl::take_over_file() {
    // The file is read once, so that the take stores exactly the compiled text.
    patch::Patch patch;
    patch::Problems found;
    try {
        patch = patch::load_patch(file_, found);
    } catch (const Error& error) {
        return say_(error.what());
    }
    watch_.follow(patch::part_files(patch));
    if (saved) return saved();
    const patch::Patch& runs = engine_.plan().patch;
    if (patch.text != runs.text || patch.parts != runs.parts)
        edit_to([patch = std::move(patch), found = std::move(found)](patch::Problems& problems) mutable {
            problems = std::move(found);
            return std::move(patch);
        });
}

void LiveControl::move_to(const std::filesystem::path& file) {
    file_ = file;
    watch_.move_to(file);
    watch_.follow(patch::part_files(engine_.plan().patch));
}

void LiveControl::edit(std::string text) {
    edit_to(
        [this, text = std::move(text)](patch::Problems& problems) { return patch::read_patch(text, file_, problems); });
}

void LiveControl::edit_to(std::function<patch::Patch(patch::Problems&)> read) {
    auto make = [this, read = std::move(read)] {
        patch::Problems problems;
        patch::Patch patch = read(problems);
        std::optional<compile::Schedule> plan =
            plan_of(std::move(patch), choice_.overrides, choice_.seed, &assets_, problems);
        if (problems.empty()) return std::move(*plan);
        std::string all;
        for (const std::string& line : problem_lines(problems)) all += (all.empty() ? "" : "\n") + line;
        throw Error(all);
    };
    engine_.edit(std::move(make), [this](const run::EditOutcome& outcome) {
        if (outcome.error) say_(fmt::format("{}\nthe edit was not made; the patch runs on as it was", *outcome.error));
        else {
            watch_.follow(patch::part_files(engine_.plan().patch));
            say_(fmt::format("edit {} takes effect at {:.3f} s; {} of {} nodes continue", outcome.generation,
                             seconds(outcome.when), outcome.kept, outcome.nodes));
        }
    });
}

std::string LiveControl::set(const std::string& setting) {
    const std::size_t dot = setting.find('.'), equals = setting.find('=');
    if (dot == std::string::npos || equals == std::string::npos || dot > equals)
        throw Error("write NODE.PARAM=VALUE, as in blade.stiffness=\"0.8 N/mm\"");
    const std::string node = setting.substr(0, dot), param = setting.substr(dot + 1, equals - dot - 1),
                      text = setting.substr(equals + 1);
    const Flicks when = engine_.set(node, param, text);
    for (const auto& end : patch::ends_within(engine_.plan().patch, node, param))
        if (end.name == press) presses_[end.node] = std::strtod(text.c_str(), nullptr);
    return fmt::format("{} from {:.3f} s", setting, seconds(when));
}

std::string LiveControl::trigger(const std::string& given) {
    return fmt::format("{} is pressed at {:.3f} s", given, seconds(press_button(given)));
}

Flicks LiveControl::press_button(const std::string& given) {
    const auto ends = patch::ends_within(engine_.plan().patch, given, press);
    std::vector<std::string> buttons;
    std::size_t found_buttons = 0;
    double newest = 0.0;  // of several buttons that are pressed as one
    for (const auto& live : engine_.nodes()) {
        const auto found = live->params.find(press);
        if (found == live->params.end()) continue;
        buttons.push_back(live->name);
        if (std::ranges::find(ends, live->name, &patch::NamedEnd::node) == ends.end()) continue;
        ++found_buttons;
        // Once set, the ticking thread writes the parameter, so it is read before the first press only.
        const auto told = presses_.find(live->name);
        newest = std::max(newest, told == presses_.end() ? found->second->value : told->second);
    }
    if (found_buttons < ends.size())
        throw Error(buttons.empty() ? fmt::format("'{}' is not a button; this patch has none", given)
                                    : fmt::format("'{}' is not a button; this patch has {}{}", given,
                                                  fmt::join(buttons, ", "), did_you_mean(given, buttons)));
    const double next = std::floor(newest) + 1.0;
    const Flicks when = engine_.set(given, press, fmt::format("{:.0f}", next));
    for (const auto& end : ends) presses_[end.node] = next;
    return when;
}

std::string LiveControl::answer(const std::string& line) {
    try {
        if (line.starts_with("set ")) return set(line.substr(4));
        if (line.starts_with("trigger ")) return trigger(line.substr(8));
        return "error write 'set NODE.PARAM=VALUE' or 'trigger NODE'";
    } catch (const Error& error) {
        return fmt::format("error {}", error.what());
    }
}

}  // namespace tactus::run

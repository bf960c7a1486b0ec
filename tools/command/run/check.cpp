// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "engine/run/engine.hpp"
#include "graph/analyse/stiffness.hpp"
#include "tools/analysis/patch/patch_check.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/command/progress.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/patch/check_result.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::command {

namespace {

struct CheckChoice {
    run::PatchChoice patch;
    bool z_width = false;
    ResultChoice result;
};

/// The figures of a device by its name in the patch; "" is the only one.
std::function<DeviceInfo(const std::string&)> devices_of(const io::EngineHost& host) {
    return [&host](const std::string& name) {
        for (const auto& slot : host.devices)
            if (name.empty() || slot->name == name) return slot->port.info;
        return DeviceInfo{};
    };
}

/// Of each device that a node drives, as an ideal one, and of the simulated devices.
std::vector<analysis::ZWidthCurve> z_width_of(const io::EngineHost& host, bool is_quiet) {
    analysis::ZWidthGrid grid;
    std::vector<analysis::ZWidthDevice> devices;
    for (const auto& slot : host.devices) {
        if (slot->port.info.fingers > 0) continue;
        devices.push_back(analysis::ideal_device(slot->name + ", ideal", slot->port.info));
        const double rate = rate_of(slot->period);
        if (std::ranges::find(grid.rates, rate) == grid.rates.end()) grid.rates.push_back(rate);
    }
    std::ranges::sort(grid.rates);
    for (analysis::ZWidthDevice& device : analysis::modelled_devices()) devices.push_back(std::move(device));
    Progress shown(is_quiet);
    return analysis::z_width(devices, grid, [&shown](std::size_t done, std::size_t all) {
        shown.show(static_cast<double>(done) / static_cast<double>(all), fmt::format("{} of {} walls", done, all));
    });
}

/// Of a patch that has no problems.
compile::Schedule plan_again(const run::PatchChoice& patch, compile::AssetCache& assets) {
    patch::Problems problems;
    std::optional<compile::Schedule> plan = run::read_plan(patch, problems);
    if (plan) assets.load(*plan, problems);
    if (!plan || !problems.empty()) throw Error("the patch has changed");
    return std::move(*plan);
}

/// Adds what only `prepare` can find: devices, file names, sizes, loops.
void check_prepared(const CheckChoice& choice, compile::Schedule plan, compile::AssetCache& assets,
                    analysis::PatchCheck& found) {
    run::EngineOptions options;
    options.only_checked = true;
    const run::Engine engine(std::move(plan), options);
    const std::vector<analyse::ForceLoop> loops = analyse::force_loops(engine.plan(), devices_of(engine.host()));
    found.paths = analysis::checked_paths(engine.plan(), loops);
    found.contact = analysis::contact_laws(engine);
    found.classes = analysis::class_verdicts(loops);
    found.loops = analysis::checked_loops(engine.nodes());
    found.warnings = engine.host().notices;
    const std::vector<double> costs = analysis::measured_costs([&] { return plan_again(choice.patch, assets); });
    found.schedule = analysis::checked_schedule(engine.plan(), costs);
    for (std::string& warning : analysis::schedule_warnings(engine.plan(), costs))
        found.warnings.push_back(std::move(warning));
    for (const std::string& node : analyse::unstated_laws(engine.plan()))
        found.warnings.push_back(fmt::format(
            "'{}' shapes a force by a law that check cannot judge; keep its slope below what the path may feel", node));
    found.sound = analysis::checked_sound(engine.plan());
    found.outputs = analysis::checked_outputs(engine.nodes(), loops, found.warnings);
    if (choice.z_width) found.z_width = z_width_of(engine.host(), choice.result.quiet);
    found.is_prepared = true;
}

int check(const CheckChoice& choice) {
    ResultChoice result = choice.result;
    if (!choice.z_width) result.has_figure = ResultFigure::none;
    check_result_files(result, {choice.patch.patch});
    patch::Problems problems;
    compile::AssetCache assets;
    analysis::PatchCheck found;
    try {
        std::optional<compile::Schedule> plan = run::read_plan(choice.patch, problems);
        if (plan) assets.load(*plan, problems);
        if (plan) {
            found.groups = analysis::checked_groups(*plan);
            found.paths = analysis::checked_paths(*plan, {});
            found.processes = analysis::device_processes(*plan);
        }
        if (problems.empty()) check_prepared(choice, std::move(*plan), assets, found);
    } catch (const Error& error) {
        problems.list.push_back(error);
        // Groups and processes are those of the plan; the rest is not known to the end.
        analysis::PatchCheck known;
        known.groups = std::move(found.groups);
        known.processes = std::move(found.processes);
        found = std::move(known);
    }
    found.patch = choice.patch.patch;
    found.errors = problems.list;
    if (!result.json)
        for (const std::string& line : run::problem_lines(problems)) fmt::print(stderr, "{}\n", line);
    write_result(report::check_fields().of(found), result);
    if (!problems.empty()) return bad_input;
    return found.is_stable() ? done : answer_is_no;
}

/// Old spelling: --z-width-figure FILE.
void figure_was_option(std::vector<std::string>& words) {
    constexpr std::string_view before = "--z-width-figure";
    for (std::size_t n = 0; n < words.size(); ++n) {
        if (!words[n].starts_with(before)) continue;
        words[n].replace(0, before.size(), "--out");
        if (std::ranges::find(words, "--z-width") == words.end())
            words.insert(words.begin() + static_cast<std::ptrdiff_t>(n), "--z-width");
        return;
    }
}

Action declare_check(VerbOptions& verb) {
    const auto choice = std::make_shared<CheckChoice>();
    add_patch_options(verb, choice->patch);
    verb.flag(
        "--z-width", choice->z_width,
        "also which walls, by stiffness and damping, the devices of the patch and simulated ones bear, per rate and "
        "delay");
    add_result_options(verb, choice->result, ResultFigure::styled);
    verb.old(figure_was_option);
    return [choice] { return check(*choice); };
}

}  // namespace

Verb check_verb() {
    return {.name = "check",
            .about = "find errors; list groups, latencies and stiffness limits; exit code 1: too stiff or unstable",
            .add = declare_check,
            .schema = [] { return report::schema_of_output({report::check_fields().schema()}); }};
}

}  // namespace tactus::command

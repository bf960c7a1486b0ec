// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "engine/run/engine.hpp"
#include "graph/analyse/stiffness.hpp"
#include "tools/analysis/passivity/z_width.hpp"
#include "tools/analysis/patch_stiffness.hpp"
#include "tools/command/figure_options.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/command/run/check_rows.hpp"
#include "tools/command/run/check_schedule.hpp"
#include "tools/command/run/check_text.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/z_width_figure.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tactus::command {

using file::Json;

namespace {

struct CheckChoice {
    run::PatchChoice patch;
    bool json = false, z_width = false;
    std::filesystem::path z_width_figure;
    FigureChoice figure;
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
std::vector<analysis::ZWidthCurve> z_width_of(const io::EngineHost& host) {
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
    LiveLine line;
    return analysis::z_width(devices, grid, [&line](std::size_t done, std::size_t all) {
        line.show(fmt::format("walls: {} of {}", done, all));
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

int check(const CheckChoice& choice) {
    patch::Problems problems;
    compile::AssetCache assets;
    std::optional<compile::Schedule> plan;
    Json json;
    try {
        plan = run::read_plan(choice.patch, problems);
        if (plan) assets.load(*plan, problems);
        json = check_json(plan, problems);
        // Finds errors that only `prepare` can find: devices, file names, sizes.
        if (problems.empty()) {
            run::EngineOptions options;
            options.only_checked = true;
            const run::Engine engine(std::move(*plan), options);
            const auto loops = analyse::force_loops(engine.plan(), devices_of(engine.host()));
            json["paths"] = paths_json(engine.plan(), loops);
            json["contact"] = contact_json(analysis::contact_laws(engine));
            json["device_classes"] = classes_json(analysis::class_verdicts(loops));
            json["admittance_loops"] = loops_json(engine.nodes());
            json["warnings"] = engine.host().notices;
            const std::vector<double> costs = measured_costs([&] { return plan_again(choice.patch, assets); });
            json["schedule"] = schedule_json(engine.plan(), costs);
            for (std::string& warning : schedule_warnings(engine.plan(), costs))
                json["warnings"].push_back(std::move(warning));
            for (const std::string& node : analyse::unstated_laws(engine.plan()))
                json["warnings"].push_back(fmt::format(
                    "'{}' shapes a force by a law that check cannot judge; keep its slope below what the path may feel",
                    node));
            if (const Json sound = sound_json(engine.plan()); !sound.is_null()) json["sound"] = sound;
            json["outputs"] = outputs_json(engine.nodes(), loops, json["warnings"]);
            if (choice.z_width || !choice.z_width_figure.empty()) {
                const std::vector<analysis::ZWidthCurve> curves = z_width_of(engine.host());
                json["z_width"] = z_width_json(curves);
                if (!choice.z_width_figure.empty())
                    save_figure(report::draw_z_width(curves), choice.z_width_figure, choice.figure);
            }
        }
    } catch (const Error& error) {
        problems.list.push_back(error);
        const Json before = std::exchange(json, check_json(std::nullopt, problems));
        for (const char* key : {"groups", "processes"})
            if (before.contains(key)) json[key] = before[key];
    }
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else {
        for (const std::string& line : run::problem_lines(problems)) fmt::print(stderr, "{}\n", line);
        print_check(json);
    }
    if (!problems.empty()) return bad_input;
    return is_stable(json) ? done : answer_is_no;
}

Action declare_check(VerbOptions& verb) {
    const auto choice = std::make_shared<CheckChoice>();
    add_patch_options(verb, choice->patch);
    verb.flag("--json", choice->json, "as JSON");
    verb.flag(
        "--z-width", choice->z_width,
        "also which walls, by stiffness and damping, the devices of the patch and simulated ones bear, per rate and "
        "delay");
    verb.add("--z-width-figure", choice->z_width_figure, "draw that to this .svg, .png or .pdf");
    add_figure_options(verb, choice->figure);
    return [choice] { return check(*choice); };
}

}  // namespace

Verb check_verb() {
    return {"check", "find errors; list groups, latencies and stiffness limits; exit code 1: too stiff or unstable",
            declare_check};
}

}  // namespace tactus::command

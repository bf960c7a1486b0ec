// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/gripper/rig_run.hpp"

#include "engine/run/engine.hpp"
#include "graph/patch/sub_patch.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>

#include <cstring>
#include <map>
#include <memory>

namespace tactus::analysis {

namespace {

/// Records the values of some outputs as numbers.
class KeptValues : public io::Sink {
public:
    explicit KeptValues(std::size_t frame_bytes) : frame_bytes_(frame_bytes) {}
    void keep(const io::FrameColumn& column, std::vector<double>& into) { kept_.emplace_back(column, &into); }
    void take(std::int64_t, const std::byte* frames, std::size_t count) override {
        for (const auto& [column, into] : kept_)
            for (std::size_t i = 0; i < count; ++i) {
                double number = 0.0;
                column.type->to_columns(frames + i * frame_bytes_ + column.offset, &number);
                into->push_back(number);
            }
    }
    void finish() override {}

private:
    std::size_t frame_bytes_;
    std::vector<std::pair<io::FrameColumn, std::vector<double>*>> kept_;
};

std::vector<std::uint8_t> flags(const std::vector<double>& numbers) {
    std::vector<std::uint8_t> all;
    for (const double n : numbers) all.push_back(n != 0.0);
    return all;
}

/// True for a controller of the thumb, which the rig does not load.
bool moves_another_part(const patch::Patch& patch, const patch::PatchNode& node) {
    for (const patch::PatchWire& wire : patch.wires)
        if (wire.from_node == node.name && wire.to_port == "thumb_speed") return true;
    return false;
}

std::string only_node(const patch::Patch& patch, const std::string& type) {
    std::string found;
    for (const patch::PatchNode& node : patch.nodes) {
        if (node.type != type || moves_another_part(patch, node)) continue;
        if (!found.empty())
            throw Error(node.where, fmt::format("a rig judges one finger: '{}' and '{}' are both of type {}", found,
                                                node.name, type));
        found = node.name;
    }
    if (found.empty())
        throw Error(
            {patch.file.string(), 0, 0},
            fmt::format("no node of type {}; a rig needs gripper_input, admittance_controller, gripper_output and "
                        "test_rig, as gripper-wqsm has them",
                        type));
    return found;
}

}  // namespace

RigNodes find_rig_nodes(const run::PatchChoice& choice) {
    patch::Problems problems;
    patch::Patch patch = patch::load_patch(run::find_patch(choice.patch), problems);
    patch::flatten(patch, problems);
    run::throw_problems(problems);
    return {only_node(patch, "gripper_input"), only_node(patch, "admittance_controller"),
            only_node(patch, "gripper_output"), only_node(patch, "test_rig")};
}

control::ObjectSettings object_of(const RigObject& object) {
    control::ObjectSettings settings;
    settings.kind = object.kind;
    settings.stiffness = object.stiffness;
    settings.damping = object.damping;
    return settings;
}

RigRun run_rig_cell(const run::PatchChoice& given, const RigNodes& nodes, const RigCell& cell, int cycles,
                    compile::AssetCache& assets) {
    run::PatchChoice choice = given;
    auto& set = choice.overrides.settings;
    const auto put = [&set](const std::string& node, const char* param, const std::string& value) {
        set.push_back(fmt::format("{}.{}={}", node, param, value));
    };
    put(nodes.input, "device", cell.motor);
    put(nodes.output, "device", cell.motor);
    put(nodes.controller, "object", cell.object.kind == control::ObjectKind::wall ? "wall" : "elastic");
    put(nodes.controller, "sides", "both");
    put(nodes.controller, "rest", "0 mm");
    put(nodes.controller, "mass", "0 kg");
    put(nodes.controller, "stiffness", fmt::format("{:.17g} N/m", cell.object.stiffness));
    put(nodes.controller, "damping", fmt::format("{:.17g} N s/m", cell.object.damping));
    if (cell.feed_forward) put(nodes.controller, "feed_forward", fmt::format("{:.17g}", *cell.feed_forward));
    put(nodes.rig, "swings", fmt::format("{:.17g} Hz", cell.rate));
    put(nodes.rig, "sweep_to", "0 Hz");
    put(nodes.rig, "peak_to_peak", fmt::format("{:.17g} m", 2.0 * cell.amplitude));
    set.insert(set.end(), cell.settings.begin(), cell.settings.end());

    std::map<std::string, std::vector<double>> kept;
    for (const std::string& port : {nodes.input + ".finger_force", nodes.input + ".finger_position",
                                    nodes.input + ".slips", nodes.controller + ".saturated", nodes.input + ".max_speed",
                                    nodes.output + ".holds", nodes.controller + ".holds"})
        kept[port];
    run::EngineOptions options;
    options.seconds = rig_settle_s + (cycles + 0.05) / cell.rate;
    options.hash = false;
    options.time_nodes = false;
    double period = 0.0;
    options.tap = [&](const io::FrameLayout& layout, const run::GroupRuntime& group) -> std::unique_ptr<io::Sink> {
        auto sink = std::make_unique<KeptValues>(layout.bytes);
        for (const io::FrameColumn& column : layout.columns) {
            const auto wanted = kept.find(column.port);
            if (wanted == kept.end()) continue;
            period = seconds(group.plan->period);
            sink->keep(column, wanted->second);
        }
        return sink;
    };
    run::Engine engine(run::load_plan(choice, assets), options);
    engine.render(1);
    engine.finish();
    for (const std::string& port : {nodes.output + ".holds", nodes.controller + ".holds"})
        for (const double held : kept[port])
            if (held != 0.0)
                throw Error(fmt::format("{}, {}, {:g} Hz, ±{:g} mm: the motor was held by a fault ({})", cell.motor,
                                        cell.object.name, cell.rate, cell.amplitude * 1e3, port));
    const std::vector<double>& speeds = kept[nodes.input + ".max_speed"];
    return {{period, kept[nodes.input + ".finger_force"], kept[nodes.input + ".finger_position"],
             flags(kept[nodes.input + ".slips"]), flags(kept[nodes.controller + ".saturated"])},
            speeds.empty() ? 0.0 : speeds.back()};
}

RigRow judge_rig_cell(const RigCell& cell, const control::RigSeries& series) {
    RigRow row{cell, {}, {}};
    try {
        row.fidelity = control::judge_fidelity(series, object_of(cell.object), cell.rate, rig_settle_s);
    } catch (const Error& error) {
        row.failure = error.message();
    }
    return row;
}

}  // namespace tactus::analysis

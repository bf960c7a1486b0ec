// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/passivity/bounces.hpp"

#include "devices/haptic/catalogue.hpp"
#include "dsp/core/error.hpp"
#include "engine/run/engine.hpp"
#include "graph/compile/compile.hpp"
#include "graph/compile/load_assets.hpp"
#include "graph/patch/patch.hpp"
#include "nodes/catalogue.hpp"
#include "tools/analysis/passivity/thrown_device.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

namespace tactus::analysis {
namespace {

/// How a contact is put between the hand and the device's output.
struct Setting {
    std::string_view name;  ///< type of the node `contact`
    double height;          ///< m, from which the hand is thrown at the surface
    std::string_view wires;
    /// Of `contact`, then other nodes. Where `%` stands is the stiffness; without it `contact` has it.
    std::string_view options;
    double kerf = 0.0;  ///< mm, of a tool on the library's jaw that is not powered; it starts as far from the bone
};

constexpr std::string_view bone_wires =
    R"("hand.pose -> place.device", "place.pose -> contact.pose", "carve.bone -> contact.bone",
"contact.wrench -> felt.wrench", "place.pose -> felt.tool", "place.frame -> felt.frame", "felt.on_hand -> out.wrench", )";

constexpr std::string_view guide_wires =
    R"("hand.pose -> contact.pose", "hand.twist -> contact.twist", "contact.wrench -> out.wrench")";

/// `@` is the kerf.
constexpr std::string_view bone_nodes = R"(
[assets]
bone = "bones/mandible.vdb"
[nodes.place]
type = "workspace"
rate = "1 kHz"
bone = "bone"
clearance = "@ mm"
[nodes.still]
type = "button"
rate = "1 kHz"
[nodes.felt]
type = "device_wrench"
rate = "1 kHz"
[nodes.carve]
type = "carve"
rate = "60 Hz"
source = "bone"
kerf = "@ mm"
)";

constexpr std::string_view plate_and_tip = R"(
[nodes.plate]
type = "shape"
rate = "1 kHz"
kind = "box"
size = "20 mm, 20 mm, 20 mm"
voxel = "0.35 mm"
[nodes.tip]
type = "shape"
rate = "1 kHz"
kind = "ball"
diameter = "4 mm"
voxel = "0.35 mm"
[nodes.scene]
type = "scene"
rate = "1 kHz"
a_at = "0 mm, 0 mm, -10 mm"
)";

constexpr Setting settings[] = {
    {"sphere_contact", 1e-3, R"("hand.pose -> contact.pose", "contact.wrench -> out.wrench")", R"(
centre = "0 m, 0 m, -1 m"
radius = "1 m"
tool_radius = "0 mm"
)"},
    {"plane_guide", 1e-3, guide_wires, R"(
max_force = "10 N"
)"},
    {"box_guide", 1e-3, guide_wires, R"(
centre = "0 mm, 0 mm, -50 mm"
keep = "outside"
max_force = "10 N"
)"},
    // What pulls must let go: less than 1.5 mJ, so that every throw gets through once. The bound is that of one contact; a
    // hand that is caught swings through many.
    {"point_guide", 6e-3, guide_wires, R"(
reach = "5 mm"
max_force = "0.3 N"
)"},
    {"line_guide", 6e-3, guide_wires, R"(
reach = "5 mm"
max_force = "0.3 N"
)"},
    {"path_guide", 6e-3, guide_wires, R"(
points = "-20 0 0, 0 3 0, 20 0 0 mm"
reach = "5 mm"
max_force = "0.3 N"
)"},
    {"voxmap_contact", 3e-3,
     R"("plate.body -> scene.a", "tip.body -> scene.b", "scene.scene -> contact.scene", "hand.pose -> contact.pose",
"contact.wrench -> coupling.contact", "contact.stiffness -> coupling.contact_stiffness", "coupling.wrench -> out.wrench")",
     R"(
held = "1"
[nodes.coupling]
type = "direct_coupling"
rate = "1 kHz"
stiffness = "% N/mm"
)"},
    {"point_proxy", 1e-3,
     R"("plate.body -> scene.a", "scene.scene -> contact.scene", "hand.pose -> contact.device", "contact.wrench -> out.wrench")",
     ""},
    {"sphere_proxy", 3e-3,
     R"("plate.body -> scene.a", "scene.scene -> contact.scene", "hand.pose -> contact.device", "contact.wrench -> out.wrench")",
     R"(
radius = "2 mm"
)"},
    {"quasi_static_coupling", 3e-3,
     R"("plate.body -> scene.a", "tip.body -> scene.b", "scene.scene -> contact.scene", "hand.pose -> contact.device",
"contact.wrench -> out.wrench")",
     R"(
held = "1"
)"},
    {"dynamic_coupling", 3e-3,
     R"("plate.body -> scene.a", "tip.body -> scene.b", "scene.scene -> contact.scene", "hand.pose -> contact.device",
"hand.twist -> contact.device_twist", "contact.wrench -> out.wrench")",
     R"(
held = "1"
)"},
    {"blade_contact", 3e-3,
     R"("place.pose -> carve.path as batch", "contact.load -> carve.load as batch", "still.pressed -> carve.running")",
     "", 1.0},
    {"saw_blade", 3e-3, R"("contact.front -> carve.front as batch", "still.pressed -> contact.running")", "", 1.0},
    {"burr", 3e-3, R"("contact.front -> carve.front as batch", "still.pressed -> contact.running")", "", 4.0},
};

std::string patch_of(const Setting& setting, double stiffness, bool capped) {
    const std::string per_mm = fmt::format("{}", stiffness * 1e-3);
    std::string nodes = fmt::format("[nodes.contact]\ntype = \"{}\"\nrate = \"1 kHz\"\n", setting.name);
    if (setting.options.find('%') == std::string_view::npos) nodes += fmt::format("stiffness = \"{} N/mm\"\n", per_mm);
    nodes += setting.options;
    if (const std::size_t at = nodes.find('%'); at != std::string::npos) nodes.replace(at, 1, per_mm);
    const bool has_scene = setting.wires.find("scene.") != std::string_view::npos;
    const bool has_tip = setting.wires.find("tip.body") != std::string_view::npos;
    std::string scene(has_scene ? plate_and_tip : "");
    if (has_scene && !has_tip) {
        const std::size_t tip = scene.find("[nodes.tip]"), end = scene.find("[nodes.scene]");
        scene.erase(tip, end - tip);
    }
    std::string wires(setting.wires);
    if (setting.kerf > 0.0) {
        wires.insert(0, bone_wires);
        std::string bone(bone_nodes);
        for (std::size_t n; (n = bone.find('@')) != std::string::npos;)
            bone.replace(n, 1, fmt::format("{}", setting.kerf));
        nodes.insert(0, bone);
    }
    return fmt::format(R"(wires = [{}]
[devices.thrown]
driver = "thrown"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
[nodes.out]
type = "device_output"
rate = "1 kHz"
max_force = "10 N"
slew = "1 N/ms"
energy_cap = {}
{}{})",
                       wires, capped ? "true" : "false", scene, nodes);
}

/// Kept by the driver, which the catalogue of devices owns.
Throw thrown;
Flight flight;

double ratio_of(const Setting& setting, double stiffness, bool capped, compile::AssetCache& assets) {
    patch::Problems problems;
    const std::string file = (run::library_folder() / "thrown.toml").string();  // assets are beside it
    std::optional<compile::Schedule> plan = run::plan_of(
        patch::read_patch(patch_of(setting, stiffness, capped), file, problems), {}, std::nullopt, &assets, problems);
    run::throw_problems(problems);
    run::EngineOptions options;
    options.seconds = 1.2;
    run::Engine engine(std::move(*plan), options);
    engine.render(1);
    if (!flight.touched) throw Error(fmt::format("{}: the hand did not touch anything", setting.name));
    return flight.ratio();
}

simulate::DeviceModel model_of(const std::string& device) {
    if (const simulate::DeviceModel* const model = simulate::find_device_model(device)) return *model;
    simulate::DeviceModel ideal;
    ideal.max_force = 20.0;
    return ideal;
}

void check_names(const std::vector<std::string>& given, const std::vector<std::string>& known, const char* what) {
    for (const std::string& name : given)
        if (std::ranges::find(known, name) == known.end())
            throw Error(fmt::format("there is no {} '{}'{}; there are: {}", what, name, did_you_mean(name, known),
                                    fmt::join(known, ", ")));
}

}  // namespace

const std::vector<std::string>& bounce_nodes() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const Setting& setting : settings) all.emplace_back(setting.name);
        return all;
    }();
    return names;
}

const std::vector<std::string>& bounce_devices() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all{"ideal"};
        for (const simulate::DeviceModel& model : simulate::device_models()) all.emplace_back(model.name);
        return all;
    }();
    return names;
}

double bounce_bound(const std::string& device) {
    const simulate::DeviceModel* const model = simulate::find_device_model(device);
    return model && model->resolution > 20e-6 ? 1.10 : 1.05;
}

std::vector<BounceRow> throw_at_contacts(const BounceMatrix& matrix,
                                         const std::function<void(const BounceRow&)>& tell) {
    check_names(matrix.nodes, bounce_nodes(), "contact");
    check_names(matrix.devices, bounce_devices(), "device");
    haptic::add_haptic_driver(
        {"thrown", "a device that flies on alone", [](Options& options, const haptic::PathResolver&) {
             options.finish();
             return open_thrown(thrown, flight);
         }});
    compile::AssetCache assets;
    std::vector<BounceRow> rows;
    for (const Setting& setting : settings) {
        if (!matrix.nodes.empty() && std::ranges::find(matrix.nodes, setting.name) == matrix.nodes.end()) continue;
        for (const std::string& device : matrix.devices.empty() ? bounce_devices() : matrix.devices)
            for (const double stiffness : matrix.stiffnesses)
                for (const double speed : matrix.speeds)
                    for (const double mass : matrix.masses) {
                        thrown = {model_of(device), mass, speed, setting.height};
                        BounceRow row{std::string(setting.name), device, stiffness, speed, mass};
                        row.energy_ratio = ratio_of(setting, stiffness, true, assets);
                        row.energy_ratio_without = ratio_of(setting, stiffness, false, assets);
                        row.bound = bounce_bound(device);
                        if (tell) tell(row);
                        rows.push_back(std::move(row));
                    }
    }
    return rows;
}

}  // namespace tactus::analysis

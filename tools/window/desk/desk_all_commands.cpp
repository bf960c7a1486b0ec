// SPDX-License-Identifier: Apache-2.0
// What commands can be applied to, by name: nodes, types, files, parameters.
#include "tools/window/desk/desk.hpp"

#include "nodes/catalogue.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/window/hand/hand_offer.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

std::vector<Command> Desk::all_commands() {
    std::vector<Command> all = commands_;
    const PatchPicture& picture = bench_.picture();
    for (const PictureNode& node : picture.nodes)
        all.push_back({"go to", node.name, "", node.type, [this, name = node.name] {
                           patch_.selected = name;
                           patch_.look_at(name);
                       }});
    const std::string folder = (run::library_folder() / "patches").string();
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".toml")
            all.push_back({"open", "Open " + entry.path().stem().string(), "", "example",
                           [this, path = entry.path()] { wishes.open = path; }});
    const StartList nearby = start_list({}, fs::current_path(ignored), memory_.recent());
    for (const auto* list : {&nearby.recent, &nearby.takes, &nearby.plans})
        for (const StartItem& item : *list)
            all.push_back({"open", "Open " + item.title, "", "file recent take plan",
                           [this, path = item.path] { wishes.open = path; }});
    scene_.add_commands(all);
    if (shows(columns_, Panel::scopes)) scopes_.add_commands(all);
    if (take_) return all;
    add_hand_commands(bench_, all);
    plan_.add_commands(all);
    if (!take_) slices_.add_commands(all);
    for (const run::HandForces& forces : bench_.status()->forces)
        if (forces.state == control::ForceState::by_hand && !forces.node.empty())
            all.push_back(
                {"run", "Let forces return", "", "recover fault " + forces.device, [this, node = forces.node] {
                     if (bench_.running()) bench_.running()->recover(node);
                 }});
    for (const NodeType* type : nodes::catalogue())
        all.push_back({"add", "Add " + type->name, "", std::string(type->about), [this, name = type->name] {
                           if (const std::string made = bench_.add_node(name, bench_.lane_for(name)); !made.empty())
                               patch_.selected = made;
                       }});
    patch_.add_commands(all, sees_patch());
    if (!bench_.written().devices.empty())
        all.push_back({"set", "Set a device setting...", "", "DEVICE.SETTING VALUE, as simulated.start_z 60 mm",
                       [this] { ask_device_setting(); }});
    for (const patch::PatchDevice& device : bench_.written().devices)
        for (const OptionText& setting : device.settings)
            all.push_back(
                {"set", fmt::format("Set devices.{}.{}...", device.name, setting.name), "", "device",
                 [this, name = device.name, setting] { ask_value("devices." + name, setting.name, setting.text); }});
    if (const int index = picture.find(patch_.selected);
        index >= 0 && picture.nodes[static_cast<std::size_t>(index)].plan >= 0)
        for (const ParameterField& field :
             parameters_of(*bench_.plan(), picture.nodes[static_cast<std::size_t>(index)].plan))
            all.push_back({"set", fmt::format("Set {}.{}...", patch_.selected, field.name), "", field.about,
                           [this, node = patch_.selected, field] { ask_value(node, field.name, field.text); }});
    return all;
}

}  // namespace tactus::window

// SPDX-License-Identifier: Apache-2.0
#include "graph/patch/patch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::patch {

namespace {

template <class Item>
Item* find_named(std::vector<Item>& items, std::string_view name) {
    const auto found = std::ranges::find(items, name, &Item::name);
    return found == items.end() ? nullptr : &*found;
}

void put(std::vector<OptionText>& settings, std::string_view key, std::string_view text, const SourceLocation& where) {
    if (OptionText* given = find_named(settings, key)) *given = {std::string(key), std::string(text), where};
    else settings.push_back({std::string(key), std::string(text), where});
}

void set(Patch& patch, const std::string& assignment) {
    const SourceLocation where{"--set " + assignment, 0, 0};
    const std::size_t equals = assignment.find('=');
    std::string_view target = std::string_view(assignment).substr(0, equals);
    const bool is_device = target.starts_with("devices."), is_sensor = target.starts_with("sensors.");
    const bool is_actuator = target.starts_with("actuators.");
    if (is_device) target.remove_prefix(8);
    else if (is_actuator) target.remove_prefix(10);
    else if (target.starts_with("nodes.")) target.remove_prefix(6);
    // A sensor has its table in its name.
    const std::size_t dot = target.find('.', is_sensor ? 8 : 0);
    if (equals == std::string::npos || dot == std::string_view::npos || dot + 1 == target.size())
        throw Error(where, "write NODE.PARAM=VALUE");
    const std::string_view owner = target.substr(0, dot), key = target.substr(dot + 1);
    std::string_view text = std::string_view(assignment).substr(equals + 1);
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    if (is_actuator || is_sensor) {
        std::vector<std::string> names;
        for (const PatchActuator& a : patch.actuators)
            if (a.name.starts_with("sensors.") == is_sensor) names.push_back(a.name);
        PatchActuator* actuator = find_named(patch.actuators, owner);
        if (!actuator)
            throw Error(where, fmt::format("no {} '{}'{}", is_sensor ? "sensor" : "actuator", owner,
                                           did_you_mean(owner, names)));
        put(actuator->settings, key, text, where);
    } else if (PatchNode* node = is_device ? nullptr : find_named(patch.nodes, owner)) {
        if (key == "type") {
            node->type = text;
            node->type_where = where;
        } else if (key == "rate" || key == "group") {
            node->rate = key == "rate" ? text : "";
            node->group = key == "group" ? text : "";
            node->rate_where = where;
        } else put(node->settings, key, text, where);
    } else if (PatchDevice* device = find_named(patch.devices, owner)) {
        if (key == "driver") device->driver = text;
        else put(device->settings, key, text, where);
    } else {
        std::vector<std::string> names;
        if (!is_device)
            for (const PatchNode& n : patch.nodes) names.push_back(n.name);
        for (const PatchDevice& d : patch.devices) names.push_back(d.name);
        throw Error(where,
                    fmt::format("no {} '{}'{}", is_device ? "device" : "node", owner, did_you_mean(owner, names)));
    }
}

void use_asset(Patch& patch, const std::string& assignment) {
    const SourceLocation where{"--asset " + assignment, 0, 0};
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == assignment.size())
        throw Error(where, "write NAME=PATH");
    const std::string name = assignment.substr(0, equals);
    if (PatchAsset* asset = find_named(patch.assets, name)) {
        asset->path = assignment.substr(equals + 1);
        asset->where = where;
        return;
    }
    std::vector<std::string> names;
    for (const PatchAsset& asset : patch.assets) names.push_back(asset.name);
    throw Error(where, fmt::format("no asset '{}' in the patch{}", name, did_you_mean(name, names)));
}

}  // namespace

void apply_overrides(Patch& patch, const PatchOverrides& overrides, Problems& problems) {
    const auto each = [&](const std::vector<std::string>& list, void (*apply)(Patch&, const std::string&)) {
        for (const std::string& assignment : list) {
            try {
                apply(patch, assignment);
            } catch (const Error& error) {
                problems.list.push_back(error);
            }
        }
    };
    each(overrides.settings, set);
    each(overrides.assets, use_asset);
}

}  // namespace tactus::patch

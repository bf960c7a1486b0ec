// SPDX-License-Identifier: Apache-2.0
#include "tools/window/patch/wire_choices.hpp"

#include "tools/window/document/type_ports.hpp"

#include <algorithm>
#include <map>

namespace tactus::window {

WireChoices wire_choices(const PatchPicture& picture, std::size_t most) {
    struct Source {
        std::size_t node;
        std::string name;
    };
    // By type, so that no pair is looked at that cannot be a wire.
    std::map<const ValueType*, std::vector<Source>> sources;
    std::vector<Source> all;
    for (std::size_t n = 0; n < picture.nodes.size(); ++n)
        for (const PicturePort& output : picture.nodes[n].outputs) {
            const Source source{n, picture.nodes[n].name + "." + output.name};
            sources[output.type].push_back(source);
            all.push_back(source);
        }
    WireChoices choices;
    // False: the list is full.
    const auto add = [&](const std::vector<Source>& from, std::size_t to, const std::string& port, bool drives) {
        for (const Source& source : from) {
            if (source.node == to) continue;
            if (choices.list.size() >= most) {
                choices.has_more = true;
                return false;
            }
            choices.list.push_back({source.name, picture.nodes[to].name + "." + port, drives});
        }
        return true;
    };
    for (std::size_t n = 0; n < picture.nodes.size(); ++n)
        for (const PicturePort& input : picture.nodes[n].inputs) {
            if (input.is_connected && !input.takes_many) continue;
            if (!input.type && !add(all, n, input.name, false)) return choices;
            if (input.type)
                for (const ValueType* type : {input.type, static_cast<const ValueType*>(nullptr)})
                    if (!add(sources[type], n, input.name, false)) return choices;
        }
    const std::vector<Source> numbers = sources[&value::number];
    for (std::size_t n = 0; n < picture.nodes.size(); ++n)
        if (const TypePorts* ports = ports_of_type(picture.nodes[n].type))
            for (const auto& [param, unit] : ports->params)
                if (!add(numbers, n, param, true)) return choices;
    return choices;
}

}  // namespace tactus::window

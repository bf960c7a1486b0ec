// SPDX-License-Identifier: Apache-2.0
#include "tools/window/patch/type_search.hpp"

#include "dsp/core/error.hpp"
#include "graph/compile/schedule.hpp"
#include "graph/patch/patch.hpp"
#include "nodes/catalogue.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/window/document/type_ports.hpp"
#include "tools/window/frame/search.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace tactus::window {

const PicturePort* input_for(const NodeType& type, const ValueType* value) {
    const TypePorts* ports = ports_of_type(type.name);
    if (!ports) return nullptr;
    const PicturePort* any = nullptr;
    for (const PicturePort& input : ports->inputs) {
        if (input.type == value) return &input;
        if (!input.type && !any) any = &input;
    }
    return any;
}

namespace {

/// Names, purposes and units of the members of a type.
struct WordLister : MemberVisitor {
    std::string words;

    void note(std::string_view name, std::string_view about, std::string_view unit = {}) {
        for (const std::string_view part : {name, unit, about}) words.append(part).append(" ");
    }
    void input(std::string_view name, Input& port) override { note(name, port.about, port.unit); }
    void output(std::string_view name, Output& port) override { note(name, port.about, port.unit); }
    void param(std::string_view name, Param& param) override { note(name, param.about, param.unit); }
    void choice(std::string_view name, Choice& choice) override { note(name, choice.about); }
    void text(std::string_view name, Text& text) override { note(name, text.about); }
    void flag(std::string_view name, Flag& flag) override { note(name, flag.about); }
    void vector(std::string_view name, Vector& vector) override { note(name, vector.about); }
    void asset(std::string_view name, AssetParam& asset) override { note(name, asset.about); }
};

const std::string& words_of(const NodeType& type) {
    static std::map<std::string, std::string> known;
    const auto [at, is_new] = known.emplace(type.name, "");
    if (is_new) {
        const compile::NodeInstance fresh(type.create(), type.destroy);
        WordLister lister;
        type.visit(fresh.get(), lister);
        at->second = std::move(lister.words);
    }
    return at->second;
}

/// How often the patches of the library use a type: read once.
double uses_of(const std::string& type) {
    static const auto counted = [] {
        std::map<std::string, int> counts;
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(run::library_folder() / "patches", ignored)) {
            if (entry.path().extension() != ".toml") continue;
            patch::Problems problems;
            try {
                for (const patch::PatchNode& node : patch::load_patch(entry.path(), problems).nodes)
                    ++counts[node.type];
            } catch (const Error&) {
                // A patch that cannot be read uses nothing.
            }
        }
        return counts;
    }();
    const auto found = counted.find(type);
    // One or two nodes are no habit.
    return found == counted.end() ? 0.0 : std::max(0, found->second - 2);
}

}  // namespace

std::vector<const NodeType*> types_for(std::string_view words, const ValueType* feeds) {
    std::vector<std::pair<double, const NodeType*>> all;
    for (const NodeType* type : nodes::catalogue()) {
        if (feeds && !input_for(*type, feeds)) continue;
        const double suit = suits(words, type->name, type->about, words_of(*type));
        // Use ranks what suits about as well; it does not lift what suits less above what was named.
        if (suit > 0.0) all.emplace_back(suit * (1.0 + 0.1 * std::log1p(uses_of(type->name))), type);
    }
    std::ranges::stable_sort(all, std::greater{}, &std::pair<double, const NodeType*>::first);
    std::vector<const NodeType*> types;
    for (const auto& [suit, type] : all) types.push_back(type);
    return types;
}

}  // namespace tactus::window

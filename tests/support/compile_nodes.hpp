// SPDX-License-Identifier: Apache-2.0
// Small node types, and compiling a patch of them.
#pragma once

#include "graph/compile/schedule.hpp"
#include "tests/graph/patch_reading.hpp"

namespace tactus {

/// The types below: source, relay, sum, wave, gain, path, truth, pair, device_input, device_output.
compile::Catalogue test_catalogue();

struct Compiled {
    std::optional<compile::Schedule> plan;
    std::string said;
};

inline Compiled compiled(std::string_view text) {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(text, "p.toml", problems);
    if (!problems.empty()) return {std::nullopt, said(problems)};
    std::optional<compile::Schedule> plan = compile::compile(patch, test_catalogue(), problems);
    return {std::move(plan), said(problems)};
}

/// [nodes.NAME] of a type at a rate.
inline std::string a_node(std::string_view name, std::string_view type, std::string_view rate = "1 kHz",
                          std::string_view more = "") {
    return "[nodes." + std::string(name) + "]\ntype = \"" + std::string(type) + "\"\nrate = \"" + std::string(rate) +
           "\"\n" + std::string(more);
}

/// Names of a group's nodes in the order they run, with blanks between.
inline std::string order_of(const compile::Schedule& plan, std::size_t group) {
    std::string names;
    for (const int node : plan.groups[group].order)
        names += (names.empty() ? "" : " ") + plan.nodes[static_cast<std::size_t>(node)].name;
    return names;
}

}  // namespace tactus

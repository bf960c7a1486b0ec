// SPDX-License-Identifier: Apache-2.0
// Node types whose state is chaotic: one wrong, late or doubled value anywhere changes every later output.
#pragma once

#include "engine/run/engine.hpp"
#include "graph/compile/load_assets.hpp"
#include "tests/support/virtual_clock.hpp"

#include <atomic>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::test {

/// The types below plus the whole catalogue.
compile::Catalogue chaos_catalogue();

/// In whose time the node type "busy" computes while it is set: null is that of the machine.
extern std::atomic<VirtualClock*> busy_clock;

/// What the node type "keeper" has seen since it was prepared: at each tick its number, or the size of its force in N.
/// For runs on one thread.
const std::vector<double>& kept_values();

/// A patch from lines: nodes as {name, type, rate} and wires as in a patch file's `wires`.
struct PatchText {
    struct Node {
        std::string name, type, rate;
        std::vector<std::pair<std::string, std::string>> settings;
    };
    std::vector<Node> nodes;
    std::vector<std::string> wires;
    std::string extra;  ///< further TOML

    std::string toml() const;
};

/// Compiles and loads assets, into `assets` if it is given, with REQUIRE that there are no problems.
compile::Schedule compile_text(const std::string& toml, compile::AssetCache* assets = nullptr);

/// 48 kHz, 1 kHz, 150 Hz and 60 Hz groups, wired in cycles across rates, with every mode of delivery.
std::string four_rates();

}  // namespace tactus::test

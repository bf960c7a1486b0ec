// SPDX-License-Identifier: Apache-2.0
// Nodes in a shared object of their own, which Tactus loads. The last line of such a file lists them:
//
//     #include <tactus/graph/node/plugin.hpp>
//
//     struct Gain { … };                       // as every node, see graph/node/node.hpp
//     TACTUS_NODE(Gain, in, out, factor)
//
//     TACTUS_PLUGIN("my-lab", "1.2", Gain)     // name and version of the whole
//
// CMake builds one by find_package(Tactus), add_library(my-lab MODULE …) and target_link_libraries(my-lab PRIVATE
// Tactus::node). Functions of Tactus come from the program that loads it, so it links no library of Tactus.
#pragma once

#include "graph/node/abi.hpp"
#include "graph/node/node.hpp"

#include <array>
#include <cstdint>

namespace tactus {

/// What a plug-in exports as `tactus_plugin`. Its own layout never changes: only what `abi` allows may be called.
struct PluginEntry {
    static constexpr std::array<char, 8> mark{'T', 'A', 'C', 'T', 'U', 'S', 'N', '1'};
    std::array<char, 8> magic;
    Abi abi;
    const char* name;
    const char* version;
    /// Calls `take` with each node type, which lives as long as the program.
    void (*each)(void (*take)(void* to, const NodeType& type), void* to);
};

}  // namespace tactus

#define TACTUS_GIVE_TYPE(Type) take(to, node_type_##Type());

/// Exports the listed nodes, which TACTUS_NODE lines above declare, in the same namespace. Once in a shared object.
#define TACTUS_PLUGIN(name, version, ...)                                                                           \
    extern "C" {                                                                                                    \
    [[gnu::visibility("default")]] extern const ::tactus::PluginEntry tactus_plugin;                                \
    constexpr ::tactus::PluginEntry tactus_plugin{::tactus::PluginEntry::mark, ::tactus::this_abi(), name, version, \
                                                  [](void (*take)(void* to, const ::tactus::NodeType& type),        \
                                                     void* to) { TACTUS_EACH(TACTUS_GIVE_TYPE, __VA_ARGS__) }};     \
    }

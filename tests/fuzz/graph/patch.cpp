// SPDX-License-Identifier: Apache-2.0
// read_patch and flatten: any text is a patch or a list of problems, and each problem has a place in it.
#include "graph/patch/sub_patch.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tactus::patch::Problems problems;
    tactus::patch::Patch patch =
        tactus::patch::read_patch({reinterpret_cast<const char*>(data), size}, "p.toml", problems);
    for (const tactus::Error& error : problems.list)
        if (error.where().line < 1 || error.where().column < 1 || error.message().empty()) std::abort();
    if (problems.empty() && patch.nodes.empty()) std::abort();
    // What its [[parts]] hold takes the places of nodes, or is a problem.
    tactus::patch::flatten(patch, problems);
    if (problems.empty() && std::ranges::any_of(patch.nodes, tactus::patch::is_sub_patch)) std::abort();
    for (const tactus::patch::PatchNode& node : patch.nodes) {
        try {
            tactus::patch::parse_rate(node.rate);
        } catch (const tactus::Error&) {
            // Refusing is right for most texts.
        }
    }
    return 0;
}

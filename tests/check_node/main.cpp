// SPDX-License-Identifier: Apache-2.0
// tactus-check-node FILE.so [TYPE ...]: what the tests of the tree check of each of its nodes, for the nodes of a plug-in. The
// functions of Tactus are those of libtactus; malloc, locks and system calls of the nodes are watched by this program.
#include "dsp/core/error.hpp"
#include "graph/plugin/plugins.hpp"
#include "nodes/catalogue.hpp"
#include "tests/check_node/node_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <vector>

namespace {

constexpr int done = 0, found_faults = 1, bad_input = 2;

int usage(std::FILE* to, int code) {
    fmt::print(
        to,
        "usage: tactus-check-node FILE.so [TYPE ...]\n"
        "Runs each node of a plug-in outside of a patch: real time, blocks of any length, bad and extreme values,\n"
        "two at once, and what a call costs. Exit code 1 when one of them fails.\n");
    return code;
}

int check(const std::string& file, std::span<char* const> wanted) {
    using namespace tactus;
    plugin::use(file);
    const std::vector<const NodeType*> known(nodes::catalogue().begin(), nodes::catalogue().end());  // names that clash
    const std::filesystem::path path = std::filesystem::weakly_canonical(file);
    const auto loaded = std::ranges::find(plugin::all(), path, &plugin::Plugin::file);
    if (loaded == plugin::all().end()) throw Error(fmt::format("{}: give one shared object, not a folder", file));
    std::vector<const NodeType*> types = loaded->types;
    for (const char* const name : wanted)
        if (std::ranges::find(types, name, &NodeType::name) == types.end()) {
            std::vector<std::string> names;
            for (const NodeType* type : types) names.push_back(type->name);
            throw Error(fmt::format("{}: has no node type '{}'{}", file, name, did_you_mean(name, names)));
        }
    if (!wanted.empty())
        std::erase_if(types,
                      [&](const NodeType* type) { return std::ranges::find(wanted, type->name) == wanted.end(); });
    fmt::print("{} {}\n", loaded->name, loaded->version);
    int faults = 0;
    for (const NodeType* type : types) faults += check_node::check(*type);
    if (faults > 0) fmt::print("{} check{} failed\n", faults, faults == 1 ? "" : "s");
    return faults > 0 ? found_faults : done;
}

}  // namespace

int main(int argc, char** argv) {
    const std::span<char* const> words(argv + 1, static_cast<std::size_t>(std::max(argc - 1, 0)));
    if (words.empty()) return usage(stderr, bad_input);
    if (std::string(words[0]) == "--help" || std::string(words[0]) == "-h") return usage(stdout, done);
    try {
        return check(words[0], words.subspan(1));
    } catch (const std::exception& error) {
        fmt::print(stderr, "tactus-check-node: {}\n", error.what());
        return bad_input;
    }
}

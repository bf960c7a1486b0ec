// SPDX-License-Identifier: Apache-2.0
// Repeats a take of a patch that may use the chaotic types.
#pragma once

#include "engine/run/engine.hpp"
#include "engine/take/take_compare.hpp"

#include <filesystem>
#include <functional>
#include <string>

namespace tactus::test {

struct Repetition {
    run::Engine::PortHashes hashes;
    std::uint64_t compared = 0;
    std::optional<take::TakeDifference> difference;
    bool matches_result = false;  ///< all hashes are those in the take
};

Repetition repeat(const std::filesystem::path& take, int threads);

/// Replays a log of a live run of `seconds` with threads and blocks of several numbers; checks every output.
void check_replays(const std::function<compile::Schedule()>& plan, double seconds, const std::filesystem::path& log,
                   const run::Engine::PortHashes& live);

/// A name in the temporary folder that nobody has used.
std::filesystem::path scratch(const std::string& name);

/// Patches made by random edits of `four_rates`: nodes and wires come, go and change, groups with them.
std::string edited(std::uint64_t seed);

}  // namespace tactus::test

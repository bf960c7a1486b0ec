// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/chaos.hpp"
#include "tests/support/catch.hpp"

#include <optional>
#include <utility>

namespace tactus::test {

compile::Schedule compile_text(const std::string& toml, compile::AssetCache* assets) {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(toml, "test.toml", problems);
    std::optional<compile::Schedule> plan;
    if (problems.empty()) plan = compile::compile(patch, chaos_catalogue(), problems);
    compile::AssetCache own;
    if (plan) (assets ? *assets : own).load(*plan, problems);
    for (const Error& problem : problems.list) UNSCOPED_INFO(problem.what());
    REQUIRE(problems.empty());
    return std::move(*plan);
}

}  // namespace tactus::test

// SPDX-License-Identifier: Apache-2.0
// Nodes read their assets without a check. So the engine refuses a plan whose assets nobody has loaded.
#include "tests/engine/chaos.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/times.hpp"

#include <optional>
#include <string>

using namespace tactus;
using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::StartsWith;

namespace {

compile::Schedule unloaded(const std::string& toml) {
    patch::Problems problems;
    std::optional<compile::Schedule> plan =
        compile::compile(patch::read_patch(toml, "test.toml", problems), chaos_catalogue(), problems);
    REQUIRE(problems.empty());
    return std::move(*plan);
}

}  // namespace

TEST_CASE("a plan with an asset that is not loaded is refused where the patch names it, also in an edit") {
    const std::string clock = "[nodes.go]\ntype = \"clock\"\nrate = \"48 kHz\"\n";
    for (const std::string node : {"[nodes.cut]\ntype = \"carve\"\nrate = \"60 Hz\"\nsource = \"file\"\n",
                                   "[nodes.drum]\ntype = \"player\"\nrate = \"48 kHz\"\nsound = \"file\"\n"}) {
        CAPTURE(node);
        const std::string wires =
            node.find("player") == std::string::npos ? "" : "wires = [\"go.out -> drum.trigger\"]\n";
        const std::string text = wires + "[assets]\nfile = \"none.vdb\"\n" + clock + node;
        run::EngineOptions options;
        options.seconds = 0.1;
        CHECK_THROWS_WITH(run::Engine(unloaded(text), options),
                          StartsWith("test.toml:") && ContainsSubstring("'file'"));
        run::Engine engine(compile_text(clock), options);
        CHECK_THROWS_WITH(engine.schedule(unloaded(text), 50 * ms), ContainsSubstring("was not loaded"));
        engine.render(1);
    }
}

// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "tests/support/catch.hpp"

#include <string>
#include <vector>

namespace tactus {

namespace {

struct WaveParameters {
    Param height{"1 mm", "0 mm", "2 mm", "of the waves"};
    Choice form{{"sine", "square"}, "of one wave"};
    TACTUS_GROUP(height, form)
};

struct Waves {
    static constexpr auto about = "A group among other parameters.";
    Out<double> out{"level"};
    Param first{"1", "0", "2", "before the group"};
    WaveParameters waves;
    Flag last{false, "after it"};
    void process(const Tick&) noexcept { out = waves.height; }
};
TACTUS_NODE(Waves, out, first, waves, last)

struct Names final : MemberVisitor {
    std::vector<std::string> all;
    void output(std::string_view name, Output&) override { all.emplace_back(name); }
    void param(std::string_view name, Param& p) override {
        all.emplace_back(name);
        if (name == "height") p.set("2 mm");
    }
    void choice(std::string_view name, Choice&) override { all.emplace_back(name); }
    void flag(std::string_view name, Flag&) override { all.emplace_back(name); }
};

}  // namespace

TEST_CASE("members of a group are declared one by one, in their place among the node's own, and can be set") {
    Waves node;
    Names names;
    node_type_Waves().visit(&node, names);
    CHECK(names.all == std::vector<std::string>{"out", "first", "height", "form", "last"});
    CHECK(node.waves.height == 2e-3);
}

}  // namespace tactus

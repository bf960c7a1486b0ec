// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/patch_measure.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/compile_nodes.hpp"

#include <algorithm>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

//  wave ──> a ──> b ──> c        other ──> d
//             └──> e
patch::Patch chain() {
    return patch_of(
        "title = \"t\"\nwires = [\"wave.out -> a.in\", \"a.out -> b.in\", \"b.out -> c.in\", "
        "\"a.out -> e.in\", \"other.out -> d.in\"]\n" +
        a_node("wave", "wave", "8 kHz") + a_node("a", "gain", "8 kHz") + a_node("b", "gain", "8 kHz") +
        a_node("c", "gain", "8 kHz") + a_node("e", "gain", "8 kHz") + a_node("other", "wave", "4 kHz") +
        a_node("d", "gain", "4 kHz") + a_node("number", "source", "8 kHz"));
}

analysis::MeasuredPatch measured(const std::string& in, const std::string& out) {
    return analysis::measured_patch(chain(), {in, out, {{"first", "20 Hz", {}}}}, test_catalogue());
}

std::string names(const patch::Patch& patch) {
    std::string text;
    for (const patch::PatchNode& node : patch.nodes) text += (text.empty() ? "" : " ") + node.name;
    return text;
}

std::string wires(const patch::Patch& patch) {
    std::string text;
    for (const patch::PatchWire& w : patch.wires)
        text += (text.empty() ? "" : ", ") + w.from_node + "." + w.from_port + " " + w.to_node + "." + w.to_port;
    return text;
}

}  // namespace

TEST_CASE("a sweep feeds an input in the place of its wire, and only what leads to the recorder remains") {
    const analysis::MeasuredPatch made = measured("b.in", "c.out");
    CHECK(names(made.patch) == "b c measure_sweep measure_record");
    CHECK(wires(made.patch) == "b.out c.in, measure_sweep.signal b.in, c.out measure_record.in");
    CHECK(made.rate == "8 kHz");
    CHECK(made.file == "measure_record.wav");
    const auto sweep = std::ranges::find(made.patch.nodes, "measure_sweep", &patch::PatchNode::name);
    CHECK(sweep->type == "sweep");
    CHECK(sweep->rate == "8 kHz");
    REQUIRE(sweep->settings.size() == 1);
    CHECK(sweep->settings[0].text == "20 Hz");
}

TEST_CASE("a sweep replaces an output for all that it feeds") {
    const analysis::MeasuredPatch made = measured("a.out", "c.out");
    CHECK(names(made.patch) == "b c measure_sweep measure_record");
    CHECK(wires(made.patch) == "measure_sweep.signal b.in, b.out c.in, c.out measure_record.in");
}

TEST_CASE("ends that cannot be measured are refused by name") {
    CHECK_THROWS_WITH(measured("b", "c.out"), ContainsSubstring("NODE.PORT"));
    CHECK_THROWS_WITH(measured("bb.in", "c.out"), ContainsSubstring("no node 'bb'; did you mean 'b'?"));
    CHECK_THROWS_WITH(measured("b.inn", "c.out"), ContainsSubstring("did you mean 'in'?"));
    CHECK_THROWS_WITH(measured("number.value", "c.out"),
                      ContainsSubstring("no signal 'value'") && ContainsSubstring("none"));
    CHECK_THROWS_WITH(measured("b.in", "c.in"), ContainsSubstring("is an input"));
    CHECK_THROWS_WITH(measured("other.out", "c.out"), ContainsSubstring("one rate"));
    CHECK_THROWS_WITH(measured("e.in", "c.out"), ContainsSubstring("no wires lead from 'e.in' to 'c.out'"));
}

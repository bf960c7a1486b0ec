// SPDX-License-Identifier: Apache-2.0
#include "tests/graph/patch_reading.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

patch::Patch patch_text() {
    return patch_of(R"([assets]
bone = "mandible.vdb"
[groups.slow]
rate = "4 Hz"
[devices.pen]
driver = "simulated"
[devices.blade]
driver = "simulated"
[nodes.blade]
type = "blade_contact"
rate = "1 kHz"
stiffness = "1 N/mm"
)");
}

struct Changed {
    patch::Patch patch;
    std::string said;
};

Changed set(const std::string& assignment) {
    Changed result{patch_text(), {}};
    patch::Problems problems;
    patch::apply_overrides(result.patch, {{assignment}, {}}, problems);
    result.said = said(problems);
    return result;
}

Changed use(const std::string& assignment) {
    Changed result{patch_text(), {}};
    patch::Problems problems;
    patch::apply_overrides(result.patch, {{}, {assignment}}, problems);
    result.said = said(problems);
    return result;
}

}  // namespace

TEST_CASE("a setting given on the command line replaces or adds") {
    const Changed replaced = set("blade.stiffness=0.5 N/mm");
    REQUIRE(replaced.patch.nodes[0].settings.size() == 1);
    CHECK(replaced.patch.nodes[0].settings[0].text == "0.5 N/mm");
    CHECK(replaced.patch.nodes[0].settings[0].where.file == "--set blade.stiffness=0.5 N/mm");
    CHECK(replaced.patch.nodes[0].settings[0].where.line == 0);
    const Changed added = set("nodes.blade.damping=1 N s/m");
    REQUIRE(added.patch.nodes[0].settings.size() == 2);
    CHECK(added.patch.nodes[0].settings[1].name == "damping");
    CHECK(set("blade.file=a=b").patch.nodes[0].settings[1].text == "a=b");
    CHECK(set("blade.stiffness=\"2 N/mm\"").patch.nodes[0].settings[0].text == "2 N/mm");
}

TEST_CASE("the command line moves a node to another rate or group") {
    CHECK(set("blade.rate=500 Hz").patch.nodes[0].rate == "500 Hz");
    const patch::PatchNode grouped = set("blade.group=slow").patch.nodes[0];
    CHECK(grouped.group == "slow");
    CHECK(grouped.rate.empty());
    CHECK(set("blade.type=spring").patch.nodes[0].type == "spring");
}

TEST_CASE("devices are set by their name, a node of that name comes first") {
    CHECK(set("devices.pen.mass=1 kg").patch.devices[0].settings.at(0).name == "mass");
    CHECK(set("pen.driver=replay").patch.devices[0].driver == "replay");
    CHECK(set("blade.mass=1 kg").patch.nodes[0].settings.size() == 2);
    CHECK(set("devices.blade.mass=1 kg").patch.devices[1].settings.size() == 1);
}

TEST_CASE("names that the patch does not have are refused with the nearest") {
    CHECK(set("blad.x=1").said == "--set blad.x=1: no node 'blad'; did you mean 'blade'?\n");
    CHECK_THAT(set("devices.pan.x=1").said, ContainsSubstring("no device 'pan'; did you mean 'pen'?"));
    CHECK_THAT(use("bine=x.vdb").said,
               ContainsSubstring("--asset bine=x.vdb: no asset 'bine' in the patch; did you mean 'bone'?"));
}

TEST_CASE("what is no assignment is refused") {
    for (const char* text : {"", "blade", "blade=1", "blade.=1", "=", ".=", "blade.stiffness", "devices.pen=1"})
        CHECK_THAT(set(text).said, ContainsSubstring("NODE.PARAM=VALUE"));
    for (const char* text : {"", "bone", "bone=", "=x"}) CHECK_THAT(use(text).said, ContainsSubstring("NAME=PATH"));
}

TEST_CASE("an asset given on the command line is relative to the current folder") {
    CHECK(use("bone=mine.vdb").patch.assets[0].path == std::filesystem::path("mine.vdb"));
    CHECK(patch_text().assets[0].path == std::filesystem::path("folder/mandible.vdb"));
}

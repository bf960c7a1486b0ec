// SPDX-License-Identifier: Apache-2.0
#include "tests/graph/patch_reading.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr std::string_view hand = "[nodes.hand]\ntype = \"device_input\"\nrate = \"1 kHz\"\n";

std::string with_hand(std::string_view top, std::string_view more = "") {
    return std::string(top) + std::string(hand) + std::string(more);
}

}  // namespace

TEST_CASE("a patch is read with every name, text and place") {
    const patch::Patch patch = patch_of(R"(title = "Saw training"
about = "Cut a jaw."
wires = [
  "hand.pose -> blade.pose",
  "bone -> blade.bone",
]
quantum = "2 ms"
seed = 7

[assets]
bone = "bones/mandible.vdb"

[groups.slow]
rate = "4 Hz"
latency = "250 ms"
backlog = 2

[devices.pen]
driver = "simulated"
mass = "200 g"

[nodes.hand]
type = "device_input"
rate = "1 kHz"
device = "pen"

[nodes.blade]
type = "blade_contact"
group = "slow"
stiffness = "0.8 N/mm"
offset = ["1 mm", 0, 2.5]
samples = 12
gain = 0.1
on = true
)");
    CHECK(patch.title == "Saw training");
    CHECK(patch.quantum == flicks_per_second / 500);
    CHECK(patch.seed == 7);
    REQUIRE(patch.wires.size() == 2);
    CHECK(patch.wires[0].from_node == "hand");
    CHECK(patch.wires[0].to_port == "pose");
    CHECK(patch.wires[0].where.line == 4);
    CHECK(patch.wires[0].where.column == 4);
    CHECK(patch.wires[1].from_node == "bone");
    CHECK(patch.wires[1].from_port.empty());
    REQUIRE(patch.assets.size() == 1);
    CHECK(patch.assets[0].path == std::filesystem::path("folder/bones/mandible.vdb"));
    REQUIRE(patch.groups.size() == 1);
    CHECK(patch.groups[0].latency == "250 ms");
    CHECK(patch.groups[0].backlog == 2);
    REQUIRE(patch.devices.size() == 1);
    CHECK(patch.devices[0].driver == "simulated");
    CHECK(patch.devices[0].settings.at(0).text == "200 g");
    REQUIRE(patch.nodes.size() == 2);
    CHECK(patch.nodes[0].name == "hand");  // the order of the file, not of the alphabet
    CHECK(patch.nodes[0].rate == "1 kHz");
    CHECK(patch.nodes[1].group == "slow");
    CHECK(patch.nodes[1].type_where.line == 28);
    CHECK(patch.nodes[1].type_where.column == 8);
    std::string settings;
    for (const OptionText& s : patch.nodes[1].settings) settings += s.name + "=" + s.text + ";";
    CHECK(settings == "stiffness=0.8 N/mm;offset=1 mm, 0, 2.5;samples=12;gain=0.1;on=true;");
    CHECK(patch.nodes[1].settings[0].where.line == 30);
    CHECK(patch.nodes[1].settings[0].where.column == 13);
}

TEST_CASE("what stands at the top by mistake is named, with the nearest key") {
    CHECK_THAT(problems_of(with_hand("titel = \"x\"\n")),
               ContainsSubstring("p.toml:1:1: unknown key 'titel'") && ContainsSubstring("did you mean 'title'"));
    CHECK_THAT(problems_of(with_hand("", "[node.blade]\ntype = \"x\"\n")), ContainsSubstring("did you mean 'nodes'"));
    CHECK_THAT(problems_of(with_hand("nodes = 3\n").substr(0, 10)),
               ContainsSubstring("p.toml:1:9: 'nodes' is a table"));
}

TEST_CASE("wires inside a table are told to move up") {
    CHECK(problems_of(with_hand("", "wires = [\"a.b -> c.d\"]\n")) ==
          "p.toml:4:1: 'wires' is inside [nodes.hand]; move it above the first table\n");
    CHECK_THAT(problems_of(with_hand("[assets]\nwires = []\n")), ContainsSubstring("is inside [assets]"));
    CHECK_THAT(problems_of(with_hand("[groups.g]\nrate = \"1 Hz\"\nwires = []\n")),
               ContainsSubstring("inside [groups.g]"));
    CHECK_THAT(problems_of(with_hand("[devices.d]\ndriver = \"x\"\nwires = []\n")),
               ContainsSubstring("inside [devices.d]"));
    CHECK_THAT(problems_of(with_hand("wires = \"a.b -> c.d\"\n")),
               ContainsSubstring("p.toml:1:9") && ContainsSubstring("is a list"));
}

TEST_CASE("a node has a type and either a rate or a group") {
    CHECK(problems_of("[nodes.a]\nrate = \"1 Hz\"\n") == "p.toml:1:8: node 'a' has no type\n");
    CHECK(problems_of("[nodes.a]\ntype = \"t\"\n") == "p.toml:1:8: node 'a' needs a 'rate' or a 'group'\n");
    CHECK(problems_of("[nodes.a]\ntype = \"t\"\nrate = \"1 Hz\"\ngroup = \"g\"\n") ==
          "p.toml:1:8: node 'a' needs either 'rate' or 'group', not both\n");
}

TEST_CASE("a value of the wrong kind is one problem, at the value") {
    CHECK(problems_of("[nodes.a]\ntype = 3\nrate = \"1 Hz\"\n") == "p.toml:2:8: 'type' is a text; put it in quotes\n");
    CHECK(problems_of("[nodes.a]\ntype = \"t\"\nrate = 1000\n") == "p.toml:3:8: 'rate' is a text; put it in quotes\n");
    CHECK(problems_of(with_hand("[assets]\nb = 3\n")) == "p.toml:2:5: 'b' is a text; put it in quotes\n");
    CHECK_THAT(problems_of(with_hand("", "date = 2020-01-01\n")),
               ContainsSubstring("p.toml:4:8") && ContainsSubstring("'date'"));
    CHECK_THAT(problems_of(with_hand("", "table = {a = 1}\n")),
               ContainsSubstring("p.toml:4:9") && ContainsSubstring("'table'"));
    CHECK_THAT(problems_of(with_hand("", "v = [1, 2]\n")),
               ContainsSubstring("p.toml:4:5") && ContainsSubstring("list of three"));
    CHECK_THAT(problems_of(with_hand("", "v = [1, 2, [3]]\n")),
               ContainsSubstring("p.toml:4:12") && ContainsSubstring("three quantities"));
    CHECK_THAT(problems_of(with_hand("", "v = [1, true, 3]\n")), ContainsSubstring("p.toml:4:9"));
}

TEST_CASE("names are letters, digits, '_' and '-'") {
    CHECK_THAT(problems_of("[nodes.\"a b\"]\ntype = \"t\"\nrate = \"1 Hz\"\n"),
               ContainsSubstring("p.toml:1:8: 'a b' is no name"));
    CHECK_THAT(problems_of("[nodes.\"\"]\ntype = \"t\"\nrate = \"1 Hz\"\n"), ContainsSubstring("is no name"));
    CHECK_THAT(problems_of(with_hand("", std::string(hand))), ContainsSubstring("p.toml:4:"));
    CHECK_THAT(problems_of(with_hand("", "rate = \"2 Hz\"\n")), ContainsSubstring("p.toml:4:"));
}

TEST_CASE("quantum and seed are checked") {
    CHECK_THAT(problems_of(with_hand("quantum = \"0 ms\"\n")),
               ContainsSubstring("p.toml:1:11") && ContainsSubstring("above zero"));
    CHECK_THAT(problems_of(with_hand("quantum = \"-1 ms\"\n")), ContainsSubstring("above zero"));
    CHECK_THAT(problems_of(with_hand("quantum = \"1 kHz\"\n")), ContainsSubstring("p.toml:1:11"));
    CHECK_THAT(problems_of(with_hand("quantum = \"0.3333333 ms\"\n")), ContainsSubstring("not exact"));
    CHECK_THAT(problems_of(with_hand("seed = -1\n")), ContainsSubstring("p.toml:1:8"));
    CHECK_THAT(problems_of(with_hand("seed = 1.5\n")), ContainsSubstring("p.toml:1:8"));
}

TEST_CASE("several problems are told together, in the order of the file") {
    const std::string text = problems_of("wires = [\"a.b > c.d\", 7]\nseed = -1\n[zoo]\n[nodes.z]\n[assets]\nq = 1\n");
    std::size_t last = 0;
    for (const char* part : {"p.toml:1:1", "p.toml:1:2", "p.toml:2:8", "p.toml:3:", "p.toml:4:", "p.toml:6:"}) {
        const std::size_t at = text.find(part, last);
        INFO(text);
        REQUIRE(at != std::string::npos);
        last = at;
    }
}

TEST_CASE("a patch written on another system reads the same") {
    const patch::Patch patch =
        patch_of("\xEF\xBB\xBFtitle = \"x\"\r\n[nodes.a]\r\ntype = \"t\"\r\nrate = \"1 Hz\"\r\n");
    CHECK(patch.title == "x");
    CHECK(patch.nodes.at(0).rate == "1 Hz");
    CHECK(patch.nodes.at(0).type_where.line == 3);
}

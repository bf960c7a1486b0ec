// SPDX-License-Identifier: Apache-2.0
// What reaches the hand while the graph that makes the force is edited.
#include "tests/engine/chaos.hpp"
#include "tests/engine/column_tap.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/times.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

/// The hand rests at the middle of a soft spring that pulls it to a place 4 mm away.
std::string held(const std::string& stiffness, const std::string& more_wires, const std::string& more) {
    return "wires = [\n\"hand.pose -> spring.device\",\n\"place.pose -> spring.object\",\n\"" + stiffness +
           ".wrench -> out.wrench\",\n" + more_wires + "]\n" +
           "[nodes.hand]\ntype = \"device_input\"\nrate = \"1 kHz\"\ndevice = \"simulated\"\n"
           "[nodes.place]\ntype = \"chaos\"\nrate = \"60 Hz\"\n"
           "[nodes.spring]\ntype = \"spring\"\nrate = \"1 kHz\"\nstiffness = \"0.001 N/mm\"\n"
           "[nodes.out]\ntype = \"device_output\"\nrate = \"1 kHz\"\ndevice = \"simulated\"\n" +
           more;
}

const std::string base = held("spring", "", "");
const std::string watched =
    held("spring", "\"out.applied -> ear.in\",", "[nodes.ear]\ntype = \"probe\"\nrate = \"1 kHz\"\n");
const std::string replaced = held("other", "\"hand.pose -> other.device\",\n\"place.pose -> other.object\",\n",
                                  "[nodes.other]\ntype = \"spring\"\nrate = \"1 kHz\"\nstiffness = \"0.002 N/mm\"\n");

/// Force on the hand at every tick of 600, with an edit at 300 ms.
std::vector<double> forces(const std::string& edited) {
    std::vector<double> seen;
    run::EngineOptions options;
    options.seconds = 0.6;
    options.tap =
        column_tap<Wrench>("out.applied", [&](const Wrench& given) { seen.push_back(glm::length(given.force)); });
    run::Engine engine(compile_text(base), options);
    engine.schedule(compile_text(edited), 300 * ms);
    engine.render(1);
    return seen;
}

}  // namespace

TEST_CASE("an edit of the force path fades the force, switches at zero, and ramps the new force in") {
    const auto plain = forces(base), edited = forces(replaced);
    REQUIRE(plain.size() == 600);
    REQUIRE(edited.size() == 600);
    REQUIRE(plain[279] > 0.1);
    // The same to the bit until the fade begins, 20 ms before the switch; zero 10 ms later, up to the switch.
    CHECK(std::equal(plain.begin(), plain.begin() + 280, edited.begin()));
    CHECK(edited[281] < edited[279]);
    for (int tick = 290; tick <= 300; ++tick) CHECK(edited[static_cast<std::size_t>(tick)] == 0.0);
    CHECK(*std::max_element(edited.begin() + 300, edited.end()) > 0.1);
    // The spring's other end moves in steps, and the new spring is twice as stiff; a fade takes a tenth per tick.
    double step = 0.0;
    for (std::size_t tick = 1; tick < plain.size(); ++tick)
        step = std::max(step, std::abs(plain[tick] - plain[tick - 1]));
    for (std::size_t tick = 1; tick < edited.size(); ++tick)
        REQUIRE(std::abs(edited[tick] - edited[tick - 1]) <= 2.0 * step + 0.101 * plain[279]);
}

TEST_CASE("an edit that no force depends on leaves the force alone") { CHECK(forces(watched) == forces(base)); }

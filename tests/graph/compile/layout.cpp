// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/layout.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/compile_nodes.hpp"

#include <array>
#include <map>
#include <set>

using namespace tactus;

namespace {

constexpr int block = 64;

struct MemoryPlaces {
    std::map<std::string, std::size_t> at;  // "node.port" → offset
    std::size_t bytes = 0;
};

MemoryPlaces places_of(const std::string& text) {
    const Compiled c = compiled(text);
    INFO(c.said);
    REQUIRE(c.plan);
    const std::vector<int> frames(c.plan->groups.size(), block);
    const compile::ValueLayout layout = compile::lay_out_values(*c.plan, frames);
    MemoryPlaces places{{}, layout.bytes};
    for (std::size_t n = 0; n < c.plan->nodes.size(); ++n)
        for (std::size_t k = 0; k < layout.offsets[n].size(); ++k)
            places.at[c.plan->nodes[n].name + "." + c.plan->nodes[n].outputs[k].name] = layout.offsets[n][k];
    return places;
}

std::string wires_text(const std::string& list) { return "wires = [" + list + "]\n"; }
std::string audio_of(const std::string& name, const std::string& type) { return a_node(name, type, "48 kHz"); }

}  // namespace

//  ┌──────┐   ┌───┐   ┌───┐   ┌───┐   ┌───┐
//  │ wave ├──►│ a ├──►│ b ├──►│ c ├──►│ d │
//  └──────┘   └───┘   └───┘   └───┘   └───┘
TEST_CASE("a chain of signals of any length lives in two places") {
    const MemoryPlaces p =
        places_of(wires_text("\"w.out -> a.in\", \"a.out -> b.in\", \"b.out -> c.in\", \"c.out -> d.in\"") +
                  audio_of("w", "wave") + audio_of("a", "gain") + audio_of("b", "gain") + audio_of("c", "gain") +
                  audio_of("d", "gain"));
    std::set<std::size_t> different;
    for (const auto& [port, offset] : p.at) different.insert(offset);
    CHECK(different.size() == 2);
    CHECK(p.at.at("w.out") == p.at.at("b.out"));
    CHECK(p.at.at("a.out") == p.at.at("c.out"));
    CHECK(p.at.at("a.out") != p.at.at("b.out"));
    CHECK(p.bytes == 2 * block * sizeof(float));
}

//  ┌──────┐     ┌───┐   ┌───┐
//  │ wave ├┬───►│ a ├──►│ b │
//  └──────┘│    └───┘   └───┘
//          │    ┌───┐
//          └───►│ z │           reads the wave last
//               └───┘
TEST_CASE("a signal keeps its place until its last reader has run") {
    const MemoryPlaces p =
        places_of(wires_text("\"w.out -> a.in\", \"a.out -> b.in\", \"w.out -> z.in\"") + audio_of("w", "wave") +
                  audio_of("a", "gain") + audio_of("b", "gain") + audio_of("z", "gain"));
    CHECK(p.at.at("w.out") != p.at.at("a.out"));
    CHECK(p.at.at("w.out") != p.at.at("b.out"));
    CHECK(p.at.at("a.out") != p.at.at("b.out"));
    // Nobody reads b: z, the last to run, may have its place.
    CHECK(p.at.at("z.out") != p.at.at("w.out"));
}

//  ┌──────┐   ┌───┐   ┌───┐           48 kHz
//  │ wave ├──►│ a ├──►│ b ├─┐ delay 1
//  └──────┘   └───┘   └───┘ └─► c
TEST_CASE("a signal that waits for a later tick keeps its place, and so does every other type") {
    const MemoryPlaces p = places_of(
        wires_text("\"w.out -> a.in\", \"a.out -> b.in\", \"b.out -> c.in as delay 1\", \"s.value -> r.in\"") +
        audio_of("w", "wave") + audio_of("a", "gain") + audio_of("b", "gain") + audio_of("c", "gain") +
        a_node("s", "source") + a_node("r", "relay"));
    for (const auto& [port, offset] : p.at)
        if (port != "b.out") CHECK(offset != p.at.at("b.out"));
    CHECK(p.at.at("s.value") != p.at.at("r.out"));
    // Groups share no cache line.
    CHECK(p.at.at("s.value") / 64 > p.at.at("b.out") / 64);
}

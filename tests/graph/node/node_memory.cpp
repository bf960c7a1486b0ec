// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node_memory.hpp"
#include "graph/node/port.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <thread>
#include <vector>

using namespace tactus;

namespace {

struct Place {
    unsigned char* at = nullptr;
    std::size_t bytes = 0;
    unsigned char mark = 0;

    bool is_whole() const {
        return std::all_of(at, at + bytes, [this](unsigned char b) { return b == mark; });
    }
};

Place take_in(std::size_t bytes, unsigned char mark) {
    Place place{static_cast<unsigned char*>(take_node_memory(bytes)), bytes, mark};
    std::memset(place.at, mark, bytes);
    return place;
}

}  // namespace

TEST_CASE("nodes made one after another lie one after another, each on its own cache lines") {
    std::vector<void*> places;
    for (int i = 0; i < 1000; ++i) places.push_back(take_node_memory(200));
    int neighbours = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        CHECK(reinterpret_cast<std::uintptr_t>(places[i]) % cache_line == node_offset);
        if (i > 0) neighbours += static_cast<std::byte*>(places[i]) - static_cast<std::byte*>(places[i - 1]) == 320;
    }
    CHECK(neighbours > 990);
    for (void* place : places) give_back_node_memory(place, 200);
}

TEST_CASE("what a call touches of a node with one input, one output and one parameter lies on one cache line") {
    struct Plain {
        In<Signal> in;
        Out<Signal> out;
        Param factor{"1", "-1000", "1000"};
    };
    void* const place = take_node_memory(sizeof(Plain));
    auto* const node = new (place) Plain;
    const auto line_of = [](const void* p) { return reinterpret_cast<std::uintptr_t>(p) / cache_line; };
    CHECK(line_of(&node->in.data) == line_of(&node->factor.value));
    CHECK(line_of(&node->out.data) == line_of(&node->factor.value));
    std::destroy_at(node);
    give_back_node_memory(place, sizeof(Plain));
}

TEST_CASE("memory of nodes of any size is theirs alone until they give it back, from any thread") {
    const auto work = [](unsigned seed) {
        std::mt19937 random(seed);
        std::vector<Place> places;
        bool whole = true;
        for (int i = 0; i < 4000; ++i) {
            if (places.size() < 50 || random() % 2 == 0) {
                const std::size_t bytes = random() % 20 == 0 ? 10'000 + random() % 20'000 : 1 + random() % 900;
                places.push_back(take_in(bytes, static_cast<unsigned char>(random())));
                continue;
            }
            std::swap(places[random() % places.size()], places.back());
            whole = whole && places.back().is_whole();
            give_back_node_memory(places.back().at, places.back().bytes);
            places.pop_back();
        }
        for (const Place& place : places) whole = whole && place.is_whole();
        return std::pair(whole, places);
    };
    std::pair<bool, std::vector<Place>> results[3];
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < 3; ++t) threads.emplace_back([&, t] { results[t] = work(t + 1); });
    for (std::thread& thread : threads) thread.join();
    for (const auto& [whole, places] : results) {
        CHECK(whole);
        for (const Place& place : places) {
            CHECK(place.is_whole());
            give_back_node_memory(place.at, place.bytes);
        }
    }
}

// SPDX-License-Identifier: Apache-2.0
// Names in a picture of the scene do not cover each other.
#include "tools/window/scene/label_places.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

using namespace tactus::window;

namespace {

constexpr Box picture{0.0, 0.0, 800.0, 600.0};

/// How much of two boxes is the same, in pixels across and down, whichever is less.
double overlap(const Box& a, const Box& b) {
    return std::min(std::min(a.right, b.right) - std::max(a.left, b.left),
                    std::min(a.bottom, b.bottom) - std::max(a.top, b.top));
}

double max_overlap(const std::vector<Box>& boxes) {
    double most = 0.0;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) most = std::max(most, overlap(boxes[i], boxes[j]));
    return most;
}

}  // namespace

TEST_CASE("names that are free stay where they are wanted") {
    const std::vector<Box> wanted{{10, 300, 90, 314}, {10, 315, 90, 329}, {95, 305, 150, 319}};
    const std::vector<Box> places = label_places(wanted, picture);
    REQUIRE(places.size() == wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) CHECK(places[i].top == wanted[i].top);
}

TEST_CASE("a name on another one goes beside it and as little as frees it") {
    const std::vector<Box> places = label_places(std::vector<Box>{{10, 105, 90, 119}, {20, 100, 120, 114}}, picture);
    CHECK(places[1].top == 100.0);
    CHECK(places[0].top == 114.0);
    CHECK(places[0].left == 10.0);
}

TEST_CASE("names at random cover nothing and keep sizes and columns and the picture") {
    std::mt19937 random(7);
    for (int round = 0; round < 300; ++round) {
        const auto any = [&](double least, double most) { return std::uniform_real_distribution(least, most)(random); };
        std::vector<Box> wanted;
        // Close together, as sites of one neck; some below the picture.
        const Point middle{any(0, 800), any(0, 640)};
        for (int i = 0; i < 20; ++i) {
            const Point at{middle.x + any(-60, 60), middle.y + any(-30, 30)};
            wanted.push_back({at.x, at.y, at.x + any(20, 160), at.y + 14});
        }
        const std::vector<Box> places = label_places(wanted, picture);
        INFO("round " << round);
        CHECK(max_overlap(places) < 1e-6);
        double moved = 0.0;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            CHECK(places[i].left == wanted[i].left);
            CHECK(places[i].width() == wanted[i].width());
            CHECK(std::abs(places[i].height() - wanted[i].height()) < 1e-9);
            CHECK(places[i].top >= picture.top);
            CHECK(places[i].bottom <= picture.bottom + 1e-9);
            moved = std::max(moved, std::abs(places[i].top - std::clamp(wanted[i].top, 0.0, 586.0)));
        }
        // All twenty in one column are 280 pixels high.
        CHECK(moved <= 280.0);
    }
}

TEST_CASE("more names than a picture has room for all get a place") {
    const std::vector<Box> wanted(10, Box{0, 10, 50, 24});
    const std::vector<Box> places = label_places(wanted, {0, 0, 100, 40});
    CHECK(places.size() == 10);
    for (const Box& box : places) CHECK(box.height() == 14.0);
    CHECK(label_places({}, picture).empty());
}

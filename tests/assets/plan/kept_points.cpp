// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/kept_points.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/kept_cache.hpp"

#include <algorithm>
#include <fstream>

using namespace tactus;
using plan::ResultKey;

namespace {

const std::vector<contact::SurfacePoint> surface{{Vec3(0.1, 1.0 / 3.0, -0.0), Vec3(0.0, 0.6, 0.8), 1e-7, 1},
                                                 {Vec3(1e-300, 2.0, 3.0), Vec3(1.0, 0.0, 0.0), 2e-7, 0}};

bool same(const std::vector<contact::SurfacePoint>& a, const std::vector<contact::SurfacePoint>& b) {
    return std::ranges::equal(a, b, [](const contact::SurfacePoint& p, const contact::SurfacePoint& q) {
        return p.position == q.position && p.normal == q.normal && p.area == q.area && p.label == q.label;
    });
}

}  // namespace

TEST_CASE("kept points come back to the bit, and damaged ones are made again with a note") {
    const test::KeptCache cache;
    const ResultKey key = ResultKey("points", 1).add("spacing", 0.5);
    std::string note;
    int made = 0;
    const auto make = [&] { return ++made, surface; };
    CHECK(same(plan::points_of_key(key, note, make), surface));
    CHECK(same(plan::points_of_key(key, note, make), surface));
    CHECK(made == 1);
    CHECK(note.empty());
    const auto file = plan::file_of_points(key);
    const std::string good = test::KeptCache::read(file);
    std::string other = good;
    other[other.size() - 3] ^= 1;
    for (const std::string& text : {other, good.substr(0, good.size() - 10), std::string("[]"), std::string()}) {
        std::ofstream(file, std::ios::binary) << text;
        made = 0;
        note.clear();
        CHECK(same(plan::points_of_key(key, note, make), surface));
        CHECK(made == 1);
        CHECK(note.find(file.string()) != std::string::npos);
        CHECK(same(plan::points_of_key(key, note, make), surface));
        CHECK(made == 1);
    }
}

// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/point_bytes.hpp"

#include "assets/bone/bone.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::vector<contact::SurfacePoint> some_points(int count) {
    std::vector<contact::SurfacePoint> points;
    for (int i = 0; i < count; ++i)
        points.push_back({Vec3(i / 3.0, -1e-3 * i, 0.1), Vec3(0.6, std::sqrt(0.64), 0.0), 1e-7 / (i + 1),
                          static_cast<std::uint8_t>(i % 3)});
    return points;
}

bool same(const std::vector<contact::SurfacePoint>& a, const std::vector<contact::SurfacePoint>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].position != b[i].position || a[i].normal != b[i].normal || a[i].area != b[i].area ||
            a[i].label != b[i].label)
            return false;
    return true;
}

}  // namespace

TEST_CASE("surface points are saved with their bone, and come back bit for bit") {
    const TemporaryFolder folder;
    bone::Bone bone;
    bone.name = "block";
    bone.distance = {{2, 3, 2}, Vec3(0.0), Vec3(1e-3), std::vector<float>(12, 1e-3f)};
    bone.density = bone.distance;
    bone.points = some_points(1000);
    bone::Bone other = bone;
    other.name = "bare";
    other.points.clear();
    bone::save_bones(std::vector{bone, other}, folder / "two.vdb");
    const auto back = bone::load_bones(folder / "two.vdb");
    REQUIRE(back.size() == 2);
    CHECK(same(back[0].points, bone.points));
    CHECK(back[1].points.empty());
}

TEST_CASE("surface points that are damaged, too few, too many or of another format are refused") {
    const std::string whole = bone::to_bytes(some_points(5));
    CHECK(same(bone::points_from(whole, "f"), some_points(5)));
    CHECK(bone::points_from(bone::to_bytes({}), "f").empty());
    for (std::size_t length = 0; length < whole.size(); ++length)
        CHECK_THROWS_AS(bone::points_from(std::string_view(whole).substr(0, length), "f"), Error);
    CHECK_THROWS_AS(bone::points_from(whole + "x", "f"), Error);
    std::string later = whole;
    later[15] = '9';
    CHECK_THROWS_WITH(bone::points_from(later, "f.vdb"), ContainsSubstring("f.vdb") && ContainsSubstring("format"));
    // A count of 2⁶³ takes no memory.
    std::string many = whole;
    many[23] = static_cast<char>(0x80);
    CHECK_THROWS_AS(bone::points_from(many, "f"), Error);
    auto broken = some_points(3);
    broken[1].area = std::nan("");
    CHECK_THROWS_AS(bone::points_from(bone::to_bytes(broken), "f"), Error);
}

TEST_CASE("a scanned border is saved with its bone, and a damaged one is refused") {
    const TemporaryFolder folder;
    bone::Bone bone;
    bone.distance = {{2, 3, 2}, Vec3(0.0), Vec3(1e-3), std::vector<float>(12, 1e-3f)};
    bone.density = bone.distance;
    bone.border = {{Vec3(1e-3, 1.0 / 3.0, -2e-3), Vec3(0.0, 4e-3, 5e-3)}, Vec3(0.9e-3, 0.9e-3, 2e-3)};
    bone::save_bone(bone, folder / "one.vdb");
    const contact::ScannedBorder back = bone::load_bone(folder / "one.vdb").border;
    CHECK(back.faces == bone.border.faces);
    CHECK(back.voxel == bone.border.voxel);

    const std::string whole = bone::border_bytes(bone.border);
    CHECK(bone::border_from(whole, "f").faces == bone.border.faces);
    for (std::size_t length = 0; length < whole.size(); ++length)
        CHECK_THROWS_AS(bone::border_from(std::string_view(whole).substr(0, length), "f"), Error);
    CHECK_THROWS_AS(bone::border_from(whole + "x", "f"), Error);
    bone.border.voxel.y = 0.0;
    CHECK_THROWS_AS(bone::border_from(bone::border_bytes(bone.border), "f"), Error);
    bone.border.voxel.y = 1e-3;
    bone.border.faces[1].z = std::nan("");
    CHECK_THROWS_AS(bone::border_from(bone::border_bytes(bone.border), "f"), Error);
}

// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/kept_bone.hpp"

#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/case_bones.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/kept_cache.hpp"

#include <fstream>

using namespace tactus;
namespace fs = std::filesystem;

namespace {

/// A closed box of 9 mm.
geometry::TriangleSurface small_box() {
    geometry::TriangleSurface made;
    for (int n = 0; n < 8; ++n) made.vertices.push_back(Vec3(n & 1, n >> 1 & 1, n >> 2) * 9e-3);
    made.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return made;
}

fs::path small_box_file(const test::KeptCache& cache, const std::string& name = "box.stl") {
    const mesh::ColouredSurface surface{small_box(), {}};
    mesh::write_mesh({&surface, 1}, cache.path / name);
    return cache.path / name;
}

bool same(const volume::Grid& a, const volume::Grid& b) {
    return a.size == b.size && a.origin == b.origin && a.spacing == b.spacing && a.values == b.values;
}

bool same(const bone::Bone& a, const bone::Bone& b) {
    return same(a.distance, b.distance) && same(a.density, b.density) && a.name == b.name && a.colour == b.colour &&
           a.provenance == b.provenance && a.points.size() == b.points.size();
}

bone::Bone load(const fs::path& file) { return plan::bone_of_mesh(file, "mm", plan::Contents::all); }

/// Distances that only the kept file has.
void mark(const fs::path& kept) {
    std::fstream file(kept, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(-4, std::ios::end);
    file.write("\0\0\0\0", 4);
}

}  // namespace

TEST_CASE("a kept bone is the imported one to the bit") {
    const test::KeptCache cache;
    const fs::path file = small_box_file(cache), kept = plan::file_of_kept_bone(file, "mm");
    const bone::Bone made = load(file);
    REQUIRE(fs::exists(kept));
    const auto first_time = fs::last_write_time(kept) - std::chrono::hours(1);
    fs::last_write_time(kept, first_time);
    const bone::Bone again = load(file);
    CHECK(fs::last_write_time(kept) > first_time);  // it was read: reading marks it as used
    CHECK(same(made, again));
    const test::KeptCache none("0");
    CHECK(same(made, load(small_box_file(none))));
}

TEST_CASE("a kept bone that is damaged, cut off or of another key is imported again") {
    const test::KeptCache cache;
    const fs::path file = small_box_file(cache), kept = plan::file_of_kept_bone(file, "mm");
    const bone::Bone made = load(file);
    const std::string good = test::KeptCache::read(kept);
    const bone::Bone in_cm = plan::bone_of_mesh(file, "cm", plan::Contents::all);
    CHECK_FALSE(same(made.distance, in_cm.distance));
    mark(kept);
    CHECK(same(made, load(file)));
    CHECK(test::KeptCache::read(kept) == good);
    for (const std::size_t length : {std::size_t{0}, std::size_t{10}, good.size() / 2, good.size() - 1}) {
        std::ofstream(kept, std::ios::binary) << good.substr(0, length);
        CHECK(same(made, load(file)));
        CHECK(test::KeptCache::read(kept) == good);
    }
    std::ofstream(kept, std::ios::binary) << test::KeptCache::read(plan::file_of_kept_bone(file, "cm"));
    CHECK(same(made, load(file)));
}

TEST_CASE("a kept bone follows the content of its mesh, not its time") {
    const test::KeptCache cache;
    const fs::path file = small_box_file(cache);
    const fs::path kept = plan::file_of_kept_bone(file, "mm");
    mesh::ColouredSurface longer{small_box(), {}};
    for (Vec3& v : longer.surface.vertices) v.z *= 1.5;
    const bone::Bone made = load(file);
    const auto time = fs::last_write_time(file);
    mesh::write_mesh({&longer, 1}, file);
    fs::last_write_time(file, time);
    CHECK(plan::file_of_kept_bone(file, "mm") != kept);
    CHECK(load(file).distance.size[2] > made.distance.size[2]);
}

TEST_CASE("a fragment without density has the distances and points of one with it") {
    const test::KeptCache cache;
    plan::PlanFragment fragment;
    fragment.name = "box";
    fragment.file = small_box_file(cache).string();
    const auto loaded = [&](plan::Contents contents) {
        return plan::fragment_bone(fragment, {}, plan::Paint::or_proposed, run_in_turn, contents).bone;
    };
    const bone::Bone all = loaded(plan::Contents::all), surface = loaded(plan::Contents::surface);
    CHECK(same(all.distance, surface.distance));
    CHECK(all.density.values.size() == all.distance.values.size());
    CHECK(surface.density.values.empty());
    REQUIRE(all.points.size() == surface.points.size());
    REQUIRE_FALSE(all.points.empty());
    for (std::size_t n = 0; n < all.points.size(); ++n) {
        CHECK(all.points[n].position == surface.points[n].position);
        CHECK(all.points[n].label == surface.points[n].label);
    }
}

// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

bone::Bone noisy_bone() {
    bone::Bone bone;
    bone.name = "block";
    bone.provenance = {{"frame", "LPS"}, {"source", "none, made here: 3 mm"}};
    bone.distance.size = {19, 8, 11};
    bone.distance.origin = {0.1, -1.0 / 3.0, 7e-4};
    bone.distance.spacing = {3e-4, 1e-4, 1.0 / 3000.0};
    bone.density = bone.distance;
    const Random random{7};
    for (std::size_t i = 0; i < bone.distance.count(); ++i) {
        bone.distance.values.push_back(static_cast<float>(random.normal(i)));
        bone.density.values.push_back(static_cast<float>(1800.0 * random.uniform(i)));
    }
    bone.distance.values[3] = -0.0f;
    bone.distance.values[4] = 0.0f;
    bone.distance.values[5] = 1e-42f;
    return bone;
}

bool same_bits(const volume::Grid& a, const volume::Grid& b) {
    return a.size == b.size && a.origin == b.origin && a.spacing == b.spacing && a.values.size() == b.values.size() &&
           std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

}  // namespace

TEST_CASE("a bone loads back bit for bit, with its grid, name and provenance") {
    const TemporaryFolder folder;
    const bone::Bone bone = noisy_bone();
    bone::save_bone(bone, folder / "a.vdb");
    const bone::Bone back = bone::load_bone(folder / "a.vdb");
    CHECK(same_bits(bone.distance, back.distance));
    CHECK(same_bits(bone.density, back.density));
    CHECK(back.name == bone.name);
    CHECK(back.provenance == bone.provenance);
    CHECK_FALSE(std::filesystem::exists(folder / "a.vdb.part"));
}

TEST_CASE("the same bone gives the same file") {
    const TemporaryFolder folder;
    bone::save_bone(noisy_bone(), folder / "a.vdb");
    bone::save_bone(noisy_bone(), folder / "b.vdb");
    CHECK(file::read_whole_file(folder / "a.vdb") == file::read_whole_file(folder / "b.vdb"));
}

TEST_CASE("a bone file cut short anywhere or with one byte changed is refused by name") {
    const TemporaryFolder folder;
    bone::save_bone(noisy_bone(), folder / "a.vdb");
    const std::string whole = file::read_whole_file(folder / "a.vdb");
    for (std::size_t length = 0; length < whole.size(); length += whole.size() / 37 + 1) {
        file::write_whole_file(folder / "cut.vdb", std::string_view(whole).substr(0, length));
        CHECK_THROWS_WITH(bone::load_bone(folder / "cut.vdb"),
                          ContainsSubstring("cut.vdb") && ContainsSubstring("tactus import"));
    }
    for (std::size_t at = 0; at < whole.size(); at += whole.size() / 37 + 1) {
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 0x40);
        file::write_whole_file(folder / "changed.vdb", changed);
        CHECK_THROWS_AS(bone::load_bone(folder / "changed.vdb"), Error);
    }
}

TEST_CASE("what is no bone file is refused") {
    const TemporaryFolder folder;
    file::write_whole_file(folder / "text.vdb", "a text, not a volume");
    CHECK_THROWS_WITH(bone::load_bone(folder / "text.vdb"), ContainsSubstring("the bone file is incomplete"));
    CHECK_THROWS_WITH(bone::load_bone(folder / "absent.vdb"), ContainsSubstring("no such file"));
    CHECK_THROWS_AS(bone::load_bone(folder.path), Error);
}

TEST_CASE("a bone that cannot be written leaves nothing behind") {
    const TemporaryFolder folder;
    CHECK_THROWS_WITH(bone::save_bone(noisy_bone(), folder / "absent" / "a.vdb"),
                      ContainsSubstring("cannot be written"));
    std::filesystem::create_directory(folder / "taken.vdb");
    CHECK_THROWS_AS(bone::save_bone(noisy_bone(), folder / "taken.vdb"), Error);
    CHECK_FALSE(std::filesystem::exists(folder / "taken.vdb.part"));
    if (std::filesystem::exists("/dev/full")) {
        std::filesystem::create_symlink("/dev/full", folder / "full.vdb.part");
        CHECK_THROWS_WITH(bone::save_bone(noisy_bone(), folder / "full.vdb"), ContainsSubstring("No space left"));
        CHECK_FALSE(std::filesystem::exists(folder / "full.vdb"));
        CHECK_FALSE(std::filesystem::is_symlink(folder / "full.vdb.part"));
    }
}

TEST_CASE("grids that do not match are refused") {
    const TemporaryFolder folder;
    bone::Bone bone = noisy_bone();
    bone.density.origin.x += 1e-9;
    CHECK_THROWS_WITH(bone::save_bone(bone, folder / "a.vdb"), ContainsSubstring("same grid"));
    bone = noisy_bone();
    bone.distance.values.pop_back();
    CHECK_THROWS_WITH(bone::save_bone(bone, folder / "a.vdb"), ContainsSubstring("as many values"));
}

TEST_CASE("several bones of one file come back in order, each with its own grid, colour and provenance") {
    const TemporaryFolder folder;
    std::vector<bone::Bone> bones(2, noisy_bone());
    bones[0].name = "main part";
    bones[1].name = "fragment.distance";
    bones[1].colour = {0.1, 0.5, 0.9};
    bones[1].provenance["label"] = "2";
    bones[1].distance.size = bones[1].density.size = {19, 11, 8};
    bones[1].distance.origin.x = bones[1].density.origin.x = 1.0;
    bone::save_bones(bones, folder / "two.vdb");
    const std::vector<bone::Bone> back = bone::load_bones(folder / "two.vdb");
    REQUIRE(back.size() == 2);
    for (std::size_t n = 0; n < 2; ++n) {
        CHECK(same_bits(back[n].distance, bones[n].distance));
        CHECK(same_bits(back[n].density, bones[n].density));
        CHECK(back[n].name == bones[n].name);
        CHECK(back[n].colour == bones[n].colour);
        CHECK(back[n].provenance == bones[n].provenance);
    }
}

TEST_CASE("a bone of several is loaded by name, and a name is asked for when it is missing or wrong") {
    const TemporaryFolder folder;
    std::vector<bone::Bone> bones(2, noisy_bone());
    bones[0].name = "main";
    bones[1].name = "fragment";
    bones[1].distance.values[0] = 42.0f;
    bone::save_bones(bones, folder / "two.vdb");
    CHECK(bone::load_bone(folder / "two.vdb#fragment").distance.values[0] == 42.0f);
    CHECK_THROWS_WITH(bone::load_bone(folder / "two.vdb"),
                      ContainsSubstring("2 bones (main, fragment)") && ContainsSubstring("two.vdb#main"));
    CHECK_THROWS_WITH(bone::load_bone(folder / "two.vdb#fragmnt"), ContainsSubstring("did you mean 'fragment'?"));
    CHECK_THROWS_WITH(bone::load_bone(folder / "two.vdb#"), ContainsSubstring("no bone ''"));
    CHECK_THROWS_WITH(bone::load_bone(folder / "absent.vdb#main"), ContainsSubstring("no such file"));
    bone::save_bone(bones[0], folder / "odd#name.vdb");
    CHECK(bone::load_bone(folder / "odd#name.vdb").name == "main");
    CHECK(bone::load_bone(folder / "odd#name.vdb#main").name == "main");
    CHECK(bone::file_of_bone(folder / "two.vdb#main") == folder / "two.vdb");
}

TEST_CASE("bones that cannot be told apart, and files without bones, are refused") {
    const TemporaryFolder folder;
    const std::vector<bone::Bone> same(2, noisy_bone());
    CHECK_THROWS_WITH(bone::save_bones(same, folder / "a.vdb"), ContainsSubstring("both called 'block'"));
    CHECK_THROWS_WITH(bone::save_bones({}, folder / "a.vdb"), ContainsSubstring("at least one"));
    std::vector<bone::Bone> nameless(2, noisy_bone());
    nameless[1].name = "";
    CHECK_THROWS_WITH(bone::save_bones(nameless, folder / "a.vdb"), ContainsSubstring("cannot name"));
    CHECK_FALSE(std::filesystem::exists(folder / "a.vdb"));
}

TEST_CASE("a file of the first format, one bone without colour, is still read") {
    // Made by the first release's `tactus import` of a CT of 6 x 4 x 5 voxels.
    const bone::Bone bone = bone::load_bone(tactus::test::source_folder() / "tests/assets/bone/data/format1.vdb");
    CHECK(bone.name == "small");
    CHECK(bone.provenance.at("source") == "small.nrrd");
    CHECK(bone.distance.size == std::array<int, 3>{14, 12, 13});
    CHECK(bone.distance.origin.x == Approx(1.0 - 4 * 0.7e-3));
    CHECK(*std::max_element(bone.density.values.begin(), bone.density.values.end()) == Approx(1731.5f));
    CHECK(*std::min_element(bone.distance.values.begin(), bone.distance.values.end()) < 0.0f);
}

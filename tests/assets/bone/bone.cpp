// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"

#include "assets/bone/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/assets/bone/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cstring>
#include <fstream>

using namespace tactus;
using Catch::Matchers::Contains;

namespace {

Bone noisy_bone() {
    Bone bone;
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

bool same_bits(const Grid& a, const Grid& b) {
    return a.size == b.size && a.origin == b.origin && a.spacing == b.spacing && a.values.size() == b.values.size() &&
           std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

}  // namespace

TEST_CASE("a bone loads back bit for bit, with its grid, name and provenance") {
    const TemporaryFolder folder;
    const Bone bone = noisy_bone();
    save_bone(bone, folder / "a.vdb");
    const Bone back = load_bone(folder / "a.vdb");
    CHECK(same_bits(bone.distance, back.distance));
    CHECK(same_bits(bone.density, back.density));
    CHECK(back.name == bone.name);
    CHECK(back.provenance == bone.provenance);
    CHECK_FALSE(std::filesystem::exists(folder / "a.vdb.part"));
}

TEST_CASE("the same bone gives the same file") {
    const TemporaryFolder folder;
    save_bone(noisy_bone(), folder / "a.vdb");
    save_bone(noisy_bone(), folder / "b.vdb");
    CHECK(read_whole_file(folder / "a.vdb") == read_whole_file(folder / "b.vdb"));
}

TEST_CASE("a bone file cut short anywhere or with one byte changed is refused by name") {
    const TemporaryFolder folder;
    save_bone(noisy_bone(), folder / "a.vdb");
    const std::string whole = read_whole_file(folder / "a.vdb");
    for (std::size_t length = 0; length < whole.size(); length += whole.size() / 37 + 1) {
        write_whole_file(folder / "cut.vdb", std::string_view(whole).substr(0, length));
        CHECK_THROWS_WITH(load_bone(folder / "cut.vdb"), Contains("cut.vdb") && Contains("tactus import"));
    }
    for (std::size_t at = 0; at < whole.size(); at += whole.size() / 37 + 1) {
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 0x40);
        write_whole_file(folder / "changed.vdb", changed);
        CHECK_THROWS_AS(load_bone(folder / "changed.vdb"), Error);
    }
}

TEST_CASE("what is no bone file is refused") {
    const TemporaryFolder folder;
    write_whole_file(folder / "text.vdb", "a text, not a volume");
    CHECK_THROWS_WITH(load_bone(folder / "text.vdb"), Contains("not a whole bone file"));
    CHECK_THROWS_WITH(load_bone(folder / "absent.vdb"), Contains("no such file"));
    CHECK_THROWS_AS(load_bone(folder.path), Error);
}

TEST_CASE("a bone that cannot be written leaves nothing behind") {
    const TemporaryFolder folder;
    CHECK_THROWS_WITH(save_bone(noisy_bone(), folder / "absent" / "a.vdb"), Contains("cannot be written"));
    std::filesystem::create_directory(folder / "taken.vdb");
    CHECK_THROWS_AS(save_bone(noisy_bone(), folder / "taken.vdb"), Error);
    CHECK_FALSE(std::filesystem::exists(folder / "taken.vdb.part"));
    if (std::filesystem::exists("/dev/full")) {
        std::filesystem::create_symlink("/dev/full", folder / "full.vdb.part");
        CHECK_THROWS_WITH(save_bone(noisy_bone(), folder / "full.vdb"), Contains("No space left"));
        CHECK_FALSE(std::filesystem::exists(folder / "full.vdb"));
        CHECK_FALSE(std::filesystem::is_symlink(folder / "full.vdb.part"));
    }
}

TEST_CASE("grids that do not match are refused") {
    const TemporaryFolder folder;
    Bone bone = noisy_bone();
    bone.density.origin.x += 1e-9;
    CHECK_THROWS_WITH(save_bone(bone, folder / "a.vdb"), Contains("same grid"));
    bone = noisy_bone();
    bone.distance.values.pop_back();
    CHECK_THROWS_WITH(save_bone(bone, folder / "a.vdb"), Contains("as many values"));
}

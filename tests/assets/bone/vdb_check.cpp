// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/vdb_check.hpp"

#include "assets/bone/bone.hpp"
#include "assets/bone/sealed_file.hpp"
#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/bone_files.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using test::repacked;
using test::sealed;

namespace {

constexpr std::uint32_t packings[] = {0, 1, 2, 3, 4, 6};

// Blocks that are full, cut, smooth (they pack well) and noisy (they do not).
bone::Bone small_bone() {
    bone::Bone bone;
    bone.name = "block";
    bone.distance.size = {17, 8, 8};
    bone.distance.spacing = Vec3(1e-3);
    bone.density = bone.distance;
    const Random random{3};
    for (std::size_t i = 0; i < bone.distance.count(); ++i) {
        bone.distance.values.push_back(i % 17 < 8 ? 1e-3f : static_cast<float>(random.normal(i)));
        bone.density.values.push_back(1000.0f);
    }
    return bone;
}

std::string bone_bytes(const TemporaryFolder& folder, std::uint32_t packing) {
    bone::save_bone(small_bone(), folder / "whole.vdb");
    return repacked(bone::read_sealed(folder / "whole.vdb"), packing);
}

/// The message of load_bones, or nothing. Writes a file only if OpenVDB would read it.
std::string refusal(const TemporaryFolder& folder, const std::string& bytes) {
    try {
        std::string checked = bytes;
        bone::check_vdb(checked, "mutant.vdb");
        file::write_whole_file(folder / "mutant.vdb", sealed(bytes));
        bone::load_bones(folder / "mutant.vdb");
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

template <typename T>
T number_at(const std::string& bytes, std::size_t at) {
    T number;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

template <typename T>
std::string with_number(std::string bytes, std::size_t at, T number) {
    std::memcpy(bytes.data() + at, &number, sizeof number);
    return bytes;
}

}  // namespace

TEST_CASE("a bone file with its seal computed anew loads back, whatever its compression") {
    const TemporaryFolder folder;
    for (const std::uint32_t packing : packings) {
        CAPTURE(packing);
        file::write_whole_file(folder / "a.vdb", sealed(bone_bytes(folder, packing)));
        CHECK(bone::load_bone(folder / "a.vdb").distance.values == small_bone().distance.values);
    }
}

TEST_CASE("a chunk of a bone file that is not as long as its node is refused, packed or not, of either sign",
          "[slow]") {
    const TemporaryFolder folder;
    for (const std::uint32_t packing : {1u, 3u, 4u, 6u}) {
        const std::string bytes = bone_bytes(folder, packing);
        int sizes = 0;
        for (std::size_t grid = bytes.find("Tree_float_5_4_3"); grid != std::string::npos;) {
            // Chunks are in trees, which begin behind the transform.
            const std::size_t next = bytes.find("Tree_float_5_4_3", grid + 1);
            const std::size_t tree = bytes.find("ScaleMap", grid) + 8 + 120;
            // All places at which a number might be the size of a chunk; a negative one is that of whole floats.
            for (std::size_t at = tree; at + 8 <= std::min(next, bytes.size()); ++at) {
                const auto old = number_at<std::int64_t>(bytes, at);
                if (old == 0 || old > 150000 || old < -150000 || (old > 0 && old % 256 == 0) || old % 4 < 0) continue;
                for (const std::int64_t size :
                     {std::int64_t{-1} << 20, std::int64_t{1} << 20, -old - 4, old + 4, INT64_MIN, INT64_MAX}) {
                    CAPTURE(packing, at, old, size);
                    // Other numbers than sizes may be anything; what counts is that OpenVDB is not reached with a wrong one.
                    const std::string said = refusal(folder, with_number(bytes, at, size));
                    sizes += said.find("chunk") != std::string::npos;
                }
            }
            grid = next;
        }
        CAPTURE(packing);
        CHECK(sizes >= 12);
    }
}

TEST_CASE("counts of a bone file that are more than it can hold are refused before memory is taken") {
    const TemporaryFolder folder;
    for (const std::uint32_t packing : packings) {
        const std::string bytes = bone_bytes(folder, packing);
        CAPTURE(packing);
        // Number of metadata behind the head, their first name's length, and of grids behind them.
        CHECK_THAT(refusal(folder, with_number(bytes, 57, 0x7fffffffu)), ContainsSubstring("metadata"));
        CHECK_THAT(refusal(folder, with_number(bytes, 61, 0xffffffffu)), ContainsSubstring("characters"));
        const std::size_t grid = bytes.find("distance") - 4;
        CHECK_THAT(refusal(folder, with_number(bytes, grid - 4, 0x7fffffffu)), ContainsSubstring("grids"));
        // Behind the transform: buffers, background, tiles, children.
        const std::size_t tree = bytes.find("ScaleMap", grid) + 8 + 120;
        REQUIRE(number_at<std::uint32_t>(bytes, tree) == 1);
        CHECK_THAT(refusal(folder, with_number(bytes, tree, 2u)), ContainsSubstring("several buffers"));
        CHECK_THAT(refusal(folder, with_number(bytes, tree + 8, 0xffffffffu)), ContainsSubstring("tiles"));
        CHECK_THAT(refusal(folder, with_number(bytes, tree + 12, 0xffffffffu)), ContainsSubstring("damaged"));
        CHECK_THAT(refusal(folder, with_number(bytes, tree + 16, 1)), ContainsSubstring("position"));
        CHECK_THAT(refusal(folder, bytes.substr(0, bytes.size() - 1)), ContainsSubstring("damaged"));
        CHECK_THAT(refusal(folder, bytes + "x"), ContainsSubstring("after its last grid"));
    }
}

TEST_CASE("bone files of another tree, format or compression are refused") {
    const TemporaryFolder folder;
    const std::string bytes = bone_bytes(folder, 6);
    CHECK_THAT(refusal(folder, with_number(bytes, 8, 220u)), ContainsSubstring("format 220"));
    CHECK_THAT(refusal(folder, with_number(bytes, 8, 225u)), ContainsSubstring("format 225"));
    std::string other = bytes;
    CHECK_THAT(refusal(folder, other.replace(bytes.find("Tree_float"), 10, "Tree_int32")),
               ContainsSubstring("Tree_float_5_4_3"));
    const std::size_t packing = bytes.find("Tree_float_5_4_3") + 16 + 4 + 24;
    REQUIRE(number_at<std::uint32_t>(bytes, packing) == 6);
    for (const std::uint32_t unknown : {5u, 8u, 0x80000006u})
        CHECK_THAT(refusal(folder, with_number(bytes, packing, unknown)), ContainsSubstring("compression"));
    // One more entry of metadata, by which OpenVDB would read two bytes per value.
    std::string half = with_number(bytes, packing + 4, number_at<std::uint32_t>(bytes, packing + 4) + 1);
    half.insert(packing + 8, std::string("\x16\0\0\0is_saved_as_half_float\4\0\0\0bool\1\0\0\0\1", 39));
    CHECK_THAT(refusal(folder, half), ContainsSubstring("16-bit numbers"));
}

TEST_CASE("a bone that needs more memory than one file may take is told apart from a damaged one") {
    const TemporaryFolder folder;
    bone::save_bone(small_bone(), folder / "a.vdb");
    const std::uint64_t before = file::memory_limit();
    file::set_memory_limit(100'000);
    CHECK_THROWS_AS(bone::load_bone(folder / "a.vdb"), file::NoRoom);
    file::set_memory_limit(before);
    CHECK_NOTHROW(bone::load_bone(folder / "a.vdb"));
}

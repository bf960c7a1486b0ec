// SPDX-License-Identifier: Apache-2.0
#include "assets/file/room.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/sound/sound.hpp"
#include "assets/table/sample_log.hpp"
#include "assets/table/trajectory.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <sys/stat.h>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("sizes of memory are read with their units, and what is none is refused") {
    CHECK(file::parse_memory_size("2 GB") == 2'000'000'000u);
    CHECK(file::parse_memory_size("1.5GiB") == 1'610'612'736u);
    CHECK(file::parse_memory_size("500 MB") == 500'000'000u);
    CHECK(file::parse_memory_size("2000000") == 2'000'000u);
    for (const char* text : {"", "GB", "-2 GB", "0", "2 XB", "1 kB", "nan GB", "1e300 GB", "2 GB or so"}) {
        CAPTURE(text);
        CHECK_THROWS_WITH(file::parse_memory_size(text), ContainsSubstring("is not a size of memory"));
    }
}

TEST_CASE("what needs more than the limit is short memory, and what a file cannot hold is a damaged file") {
    const std::uint64_t before = file::memory_limit();
    file::set_memory_limit(1'000'000);
    CHECK_NOTHROW(file::require_room(1e6, "a.nii", "its samples"));
    CHECK_THROWS_AS(file::require_room(1.1e6, "a.nii", "its samples"), file::NoRoom);
    file::set_memory_limit(before);
    CHECK_NOTHROW(file::require_possible(10.0, 10.0, "a.wav", "samples"));
    CHECK_THROWS_AS(file::require_possible(11.0, 10.0, "a.wav", "samples"), Error);
}

TEST_CASE("pipes and devices are refused by every reader, without waiting for them") {
    const TemporaryFolder folder;
    const std::string refusal = "is a pipe, a socket or a device";
    for (const char* ending : {"", ".nrrd", ".nii", ".inv3", ".dcm", ".wav", ".csv"}) {
        const auto pipe = folder / ("pipe" + std::string(ending));
        REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
        CAPTURE(ending);
        Hash hash;
        CHECK_THROWS_WITH(file::read_whole_file(pipe), ContainsSubstring(refusal));
        CHECK_THROWS_WITH(file::add_file(hash, pipe), ContainsSubstring(refusal));
        CHECK_THROWS_WITH(volume::read_volume(pipe), ContainsSubstring(refusal));
        CHECK_THROWS_WITH(sound::load_sound(pipe), ContainsSubstring(refusal));
        CHECK_THROWS_WITH(table::load_sample_log(pipe, {}), ContainsSubstring(refusal));
        CHECK_THROWS_WITH(table::read_trajectory(pipe, {}), ContainsSubstring(refusal));
    }
    CHECK_THROWS_WITH(file::read_whole_file("/dev/zero"), ContainsSubstring(refusal));
}

// SPDX-License-Identifier: Apache-2.0
#include "assets/file/cache.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/kept_cache.hpp"

#include <sys/stat.h>

#include <chrono>
#include <string>

using namespace tactus;
namespace fs = std::filesystem;

namespace {

const std::string block(400'000, 'x');

fs::path cached(int n) { return file::cache_folder() / "results" / ("file" + std::to_string(n)); }

}  // namespace

TEST_CASE("the cache stays within its limit, and what was unused for longest goes first") {
    const test::KeptCache cache("1");
    const auto now = fs::file_time_type::clock::now();
    for (int n = 0; n < 2; ++n) {
        file::write_cached(cached(n), block);
        fs::last_write_time(cached(n), now - std::chrono::seconds(100 - n));
    }
    file::touch_cached(cached(0));  // used: the other one is now the oldest
    file::write_cached(cached(2), block);
    CHECK(fs::exists(cached(0)));
    CHECK_FALSE(fs::exists(cached(1)));
    CHECK(fs::exists(cached(2)));
    CHECK(file::cache_content().bytes == 2 * block.size());
    // What is larger than the whole cache is not written, and pushes nothing out.
    file::write_cached(cached(3), std::string(2'000'000, 'x'));
    CHECK_FALSE(fs::exists(cached(3)));
    CHECK(file::cache_content().files == 2);
}

TEST_CASE("a file that another process is writing is not removed, and one that a dead process left is") {
    const test::KeptCache cache("1");
    file::write_cached(cached(0), block);
    const fs::path fresh = cached(1).string() + ".part", left = cached(2).string() + ".part";
    cache.write("tactus/results/" + fresh.filename().string(), block);
    cache.write("tactus/results/" + left.filename().string(), block);
    fs::last_write_time(left, fs::file_time_type::clock::now() - std::chrono::hours(48));
    file::write_cached(cached(3), block);
    CHECK(fs::exists(fresh));
    CHECK_FALSE(fs::exists(left));
    file::clear_cache();
    CHECK(fs::exists(fresh));
    CHECK(file::cache_content().files == 1);
}

TEST_CASE("with a limit of 0 nothing is kept, and a limit that is no number is refused") {
    {
        const test::KeptCache cache("0");
        CHECK(file::cache_folder().empty());
        file::write_cached(cache.path / "tactus" / "x", block);
        CHECK_FALSE(fs::exists(cache.path / "tactus"));
    }
    const test::KeptCache cache("4 GB");
    CHECK_THROWS_AS(file::cache_limit(), Error);
}

TEST_CASE("only its owner may look into the cache") {
    const test::KeptCache cache;
    file::write_cached(cached(0), block);
    struct stat found{};
    REQUIRE(::stat((cache.path / "tactus").c_str(), &found) == 0);
    CHECK((found.st_mode & 0777) == 0700);
}

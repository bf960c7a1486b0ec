// SPDX-License-Identifier: Apache-2.0
#include "assets/file/whole_file.hpp"

#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <filesystem>
#include <string>

using namespace tactus;

namespace {

std::string bytes_of_length(std::size_t length) {
    std::string bytes(length, '\0');
    for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<char>(i * 37 + i / 251);
    return bytes;
}

}  // namespace

TEST_CASE("what was written is read back, and no part of it is left beside") {
    TemporaryFolder folder;
    for (const std::size_t length : {0u, 1u, 4096u, 100'003u}) {
        const std::string bytes = bytes_of_length(length);
        file::write_whole_file(folder / "a.bin", bytes);
        CHECK(file::read_whole_file(folder / "a.bin") == bytes);
        CHECK_FALSE(std::filesystem::exists(folder / "a.bin.part"));
    }
}

TEST_CASE("a hash of a file in blocks is the hash of its bytes at once") {
    TemporaryFolder folder;
    for (const std::size_t length : {0u, 3u, 65'535u, 65'536u, 65'537u, 200'001u}) {
        const std::string bytes = bytes_of_length(length);
        file::write_whole_file(folder / "a.bin", bytes);
        Hash of_file, of_bytes;
        file::add_file(of_file, folder / "a.bin");
        of_bytes.add_bytes(bytes.data(), bytes.size());
        CHECK(of_file.value() == of_bytes.value());
    }
}

TEST_CASE("a folder and a file that is not there are told") {
    TemporaryFolder folder;
    Hash hash;
    CHECK_THROWS_WITH(file::read_whole_file(folder / "none"), Catch::Matchers::ContainsSubstring("none: no such file"));
    CHECK_THROWS_WITH(file::add_file(hash, folder / "."), Catch::Matchers::ContainsSubstring("this is a folder"));
    CHECK_THROWS_WITH(file::write_whole_file(folder / "none" / "a", "x"),
                      Catch::Matchers::ContainsSubstring("cannot be written"));
}

TEST_CASE("a file that is replaced keeps its permissions") {
    namespace fs = std::filesystem;
    TemporaryFolder folder;
    const fs::path file = folder / "mine.toml";
    file::write_whole_file(file, "old");
    const fs::perms mine = fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_write;
    fs::permissions(file, mine);
    file::write_durable_file(file, "new");
    CHECK(file::read_whole_file(file) == "new");
    CHECK(fs::status(file).permissions() == mine);
}

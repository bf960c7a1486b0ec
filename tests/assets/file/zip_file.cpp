// SPDX-License-Identifier: Apache-2.0
#include "assets/file/zip_file.hpp"

#include "assets/file/room.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/written_zip.hpp"

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

const std::string lines = [] {
    std::string text;
    for (int n = 0; n < 2000; ++n) text += "line " + std::to_string(n * 7919 % 1000) + "\n";
    return text;
}();

std::string refusal(const std::filesystem::path& path) {
    try {
        const file::ZipFile zip(path);
        for (const file::ZipFile::Entry& entry : zip.entries()) zip.read(entry);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("the files of a zip come back with their bytes, whole or their start") {
    const TemporaryFolder folder;
    test::write_zip(folder / "a.zip", {{"one.txt", lines}, {"empty", ""}, {"deep/two.txt", "two"}});
    const file::ZipFile zip(folder / "a.zip");
    REQUIRE(zip.entries().size() == 2);
    CHECK(zip.read(zip.entries()[0]) == lines);
    CHECK(zip.read(zip.entries()[0], 6) == lines.substr(0, 6));
    CHECK(zip.read(zip.entries()[1]) == "two");
    CHECK(zip.entries()[1].name == (folder / "a.zip").string() + "/deep/two.txt");
    CHECK(file::is_zip_file(folder / "a.zip"));
}

TEST_CASE("names in a zip stay text: nothing is written outside, and control characters do not reach the terminal") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "inner");
    test::write_zip(folder / "inner/a.zip", {{"../escaped.txt", lines}, {"/absolute@[2J.txt", lines}});
    std::string bytes = file::read_whole_file(folder / "inner/a.zip");
    for (std::size_t at = bytes.find("e@["); at != std::string::npos; at = bytes.find("e@[")) bytes[at + 1] = '\x1b';
    file::write_whole_file(folder / "inner/a.zip", bytes);
    const file::ZipFile zip(folder / "inner/a.zip");
    REQUIRE(zip.entries().size() == 2);
    for (const file::ZipFile::Entry& entry : zip.entries()) {
        CHECK(zip.read(entry) == lines);
        CHECK(entry.name.find('\x1b') == std::string::npos);
    }
    CHECK_FALSE(std::filesystem::exists(folder / "escaped.txt"));
    CHECK(std::distance(std::filesystem::directory_iterator(folder / "inner"), {}) == 1);
}

TEST_CASE("a zip that would fill the memory is refused before a byte of it is unpacked") {
    const TemporaryFolder folder;
    const auto made = [&] { test::write_zip(folder / "a.zip", {{"one.txt", lines}, {"two.txt", lines + "x"}}); };
    made();
    CHECK(refusal(folder / "a.zip").empty());
    SECTION("a size that deflate cannot reach") {
        test::patch_zip(folder / "a.zip", test::central_record, 24, 4, 0xf0000000);
        CHECK_THAT(refusal(folder / "a.zip"), ContainsSubstring("claims 4026531840 bytes"));
    }
    SECTION("files that share their bytes") {
        // Both claim nearly all of the file.
        const auto size = std::filesystem::file_size(folder / "a.zip");
        test::patch_zip(folder / "a.zip", test::central_record, 20, 4, size - 200);
        std::string bytes = file::read_whole_file(folder / "a.zip");
        const std::size_t first = bytes.find(test::central_record);
        for (std::size_t n = 0; n < 4; ++n) bytes[first + 20 + n] = static_cast<char>((size - 200) >> (8 * n) & 0xff);
        file::write_whole_file(folder / "a.zip", bytes);
        CHECK_THAT(refusal(folder / "a.zip"), ContainsSubstring("shares its bytes"));
    }
    SECTION("a list of millions of files") {
        test::patch_zip(folder / "a.zip", test::end_record, 12, 4, 0x7fffffff);
        CHECK_THAT(refusal(folder / "a.zip"), ContainsSubstring("at most 100000 files"));
    }
    SECTION("a file larger than the memory limit") {
        const std::uint64_t before = file::memory_limit();
        const file::ZipFile zip(folder / "a.zip");
        file::set_memory_limit(10'000);
        CHECK_THROWS_AS(zip.read(zip.entries()[0]), file::NoRoom);
        CHECK_NOTHROW(zip.read(zip.entries()[0], 100));
        file::set_memory_limit(before);
    }
    SECTION("more bytes than the list says") {
        test::patch_zip(folder / "a.zip", test::central_record, 24, 4, 10);
        CHECK_FALSE(refusal(folder / "a.zip").empty());
    }
    SECTION("a password") {
        test::write_zip(folder / "a.zip", {{"one.txt", lines}}, "secret");
        CHECK_THAT(refusal(folder / "a.zip"), ContainsSubstring("password"));
    }
}

TEST_CASE("damaged bytes in a zip are one error, cut anywhere") {
    const TemporaryFolder folder;
    test::write_zip(folder / "a.zip", {{"one.txt", lines}});
    const std::string whole = file::read_whole_file(folder / "a.zip");
    std::string flipped = whole;
    flipped[200] = static_cast<char>(flipped[200] ^ 0x55);
    file::write_whole_file(folder / "a.zip", flipped);
    CHECK_THAT(refusal(folder / "a.zip"), ContainsSubstring("damaged"));
    for (std::size_t length = 0; length < whole.size(); length += 97) {
        file::write_whole_file(folder / "a.zip", whole.substr(0, length));
        CAPTURE(length);
        CHECK_THAT(refusal(folder / "a.zip"), ContainsSubstring("a.zip"));
    }
}

// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/nrrd_header.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr const char* fields[] = {"type: short",
                                  "dimension: 3",
                                  "space: left-posterior-superior",
                                  "sizes: 2 2 2",
                                  "space directions: (1,0,0) (0,1,0) (0,0,1)",
                                  "kinds: domain domain domain",
                                  "endian: little",
                                  "encoding: raw",
                                  "space origin: (0,0,0)"};

// A volume whose header has `line` in place of the field of that name, or besides the others.
std::string nrrd_with(const std::string& line) {
    const std::string name = line.substr(0, line.find(':') + 1);
    std::string text = "NRRD0005\n";
    bool is_there = false;
    for (const std::string field : fields) {
        const bool is_it = name.size() > 1 && field.starts_with(name);
        is_there = is_there || is_it;
        text += (is_it ? line : field) + "\n";
    }
    return text + (is_there ? "" : line + "\n") + "\n" + std::string(16, '\1');
}

}  // namespace

TEST_CASE("a long line of an NRRD header is refused, whichever field it is") {
    const TemporaryFolder folder;
    for (const char* field : {"type",      "dimension",        "space",
                              "sizes",     "space directions", "kinds",
                              "endian",    "encoding",         "space origin",
                              "spacings",  "thicknesses",      "axis mins",
                              "axis maxs", "centers",          "labels",
                              "units",     "old min",          "line skip",
                              "byte skip", "space units",      "measurement frame",
                              "data file", "no such field"})
        for (const std::size_t size : {701u, 1100u, 70000u})
            for (const char* filling : {"a", "1 ", "(1,"}) {
                CAPTURE(field, size, filling);
                std::string line = fmt::format("{}: ", field);
                while (line.size() < size) line += filling;
                file::write_whole_file(folder / "a.nrrd", nrrd_with(line));
                CHECK_THROWS_AS(volume::read_volume(folder / "a.nrrd"), Error);
            }
    file::write_whole_file(folder / "a.nrrd", "NRRD0005" + std::string(5000, '1'));
    CHECK_THROWS_AS(volume::read_volume(folder / "a.nrrd"), Error);
    // Looks like a key with a value only behind its field.
    file::write_whole_file(folder / "a.nrrd", nrrd_with("type: " + std::string(1100, 'a') + ":=b"));
    CHECK_THROWS_WITH(volume::read_volume(folder / "a.nrrd"), ContainsSubstring("2:1: a header field has"));
}

TEST_CASE("fields up to 700 bytes, long comments, key/value pairs and contents of an NRRD header are read") {
    const TemporaryFolder folder;
    const auto reads = [&](const std::string& line) {
        file::write_whole_file(folder / "a.nrrd", nrrd_with(line));
        CHECK(volume::read_volume(folder / "a.nrrd").size == std::array<int, 3>{2, 2, 2});
    };
    reads("# " + std::string(100000, 'c'));
    reads("key:=" + std::string(100000, 'v'));
    reads("content: " + std::string(5000, 'v'));
    reads("space origin: (" + std::string(200, '0') + "," + std::string(200, '0') + "," + std::string(200, '0') + ")");
}

TEST_CASE("an NRRD header of too many lines, or of another format, is refused") {
    const TemporaryFolder folder;
    std::string many = "# c";
    for (int n = 0; n < 10001; ++n) many += "\n# c";
    file::write_whole_file(folder / "a.nrrd", nrrd_with(many));
    CHECK_THROWS_WITH(volume::read_volume(folder / "a.nrrd"), ContainsSubstring("more than 10000 lines"));
    file::write_whole_file(folder / "a.nrrd", "P5\n2 2\n255\nabcd");
    CHECK_THROWS_WITH(volume::read_volume(folder / "a.nrrd"), ContainsSubstring("does not begin with 'NRRD000'"));
}

TEST_CASE("samples as text are read, and a number of thousands of letters among them is refused") {
    const TemporaryFolder folder;
    std::string text = nrrd_with("encoding: ascii");
    text.resize(text.find("\n\n") + 2);
    file::write_whole_file(folder / "a.nrrd", text + "1 2 3 4 5 6 7 8\n");
    CHECK(volume::read_volume(folder / "a.nrrd").values == std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8});
    for (const char letter : {'(', '1', 'a'}) {
        file::write_whole_file(folder / "a.nrrd", text + "1 2 3 " + std::string(100000, letter) + " 5 6 7 8\n");
        CHECK_THROWS_WITH(volume::read_volume(folder / "a.nrrd"),
                          ContainsSubstring("a text number has more than 500 characters"));
    }
    text.insert(text.size() - 1, "data file: a.txt\n");
    file::write_whole_file(folder / "a.nhdr", text);
    file::write_whole_file(folder / "a.txt", "1 2 3 " + std::string(100000, '7') + " 5 6 7 8\n");
    CHECK_THROWS_WITH(volume::read_volume(folder / "a.nhdr"),
                      ContainsSubstring("a text number has more than 500 characters"));
}

// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/nrrd_header.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <bzlib.h>

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

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

namespace {

// 2 x 3 x 4 samples of 16 bits, 1000 n - 5000, with the lines of `header` after the usual ones and `data` behind them.
std::string header_of_24(const std::string& lines) {
    return "NRRD0005\ntype: short\ndimension: 3\nspace: LPS\nsizes: 2 3 4\n"
           "space directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (10,20,30)\n" +
           lines + "\n";
}

std::vector<float> values_of_24() {
    std::vector<float> values;
    for (int n = 0; n < 24; ++n) values.push_back(static_cast<float>(1000 * n - 5000));
    return values;
}

std::string bytes_of_24(bool big, int from = 0, int to = 24) {
    std::string bytes;
    for (int n = from; n < to; ++n) {
        const auto word = static_cast<std::uint16_t>(1000 * n - 5000);
        const char low = static_cast<char>(word & 0xff), high = static_cast<char>(word >> 8);
        bytes += big ? std::string{high, low} : std::string{low, high};
    }
    return bytes;
}

std::string as_hex(const std::string& bytes) {
    std::string text;
    for (const char c : bytes)
        text += fmt::format("{:02X}{}", static_cast<unsigned char>(c), text.size() % 35 == 34 ? "\n" : "");
    return text;
}

std::string bzipped(const std::string& bytes) {
    std::string packed(bytes.size() + 1000, '\0');
    auto size = static_cast<unsigned>(packed.size());
    std::string copy = bytes;
    REQUIRE(BZ2_bzBuffToBuffCompress(packed.data(), &size, copy.data(), static_cast<unsigned>(copy.size()), 9, 0, 0) ==
            BZ_OK);
    return packed.substr(0, size);
}

}  // namespace

TEST_CASE("an NRRD of each encoding, byte order and place of its samples gives the same volume") {
    const TemporaryFolder folder;
    const std::string little = "endian: little\n", big = "endian: big\n", bytes = bytes_of_24(false);
    std::string text;
    for (const float value : values_of_24()) text += fmt::format("{}{}", value, text.size() % 7 == 0 ? ",\n" : " ");
    file::write_whole_file(folder / "all.raw", bytes);
    file::write_whole_file(folder / "offset.raw", "one line\nanother\nskip" + bytes);
    for (int n = 0; n < 4; ++n)
        file::write_whole_file(folder / fmt::format("slice{:02}.raw", 2 * n + 7), bytes_of_24(false, 6 * n, 6 * n + 6));
    const std::vector<std::pair<std::string, std::string>> files{
        {"raw, little endian", header_of_24(little + "encoding: raw\n") + bytes},
        {"raw, big endian", header_of_24(big + "encoding: raw\n") + bytes_of_24(true)},
        {"lines that end with CR LF",
         "NRRD0004\r\n# a comment\r\ntype: int16\r\ndimension: 3\r\nspace: "
         "left-posterior-superior\r\nsizes: 2 3 4\r\nspace directions: (1,0,0) (0, 2, 0) ( 0,0,3 )\r\nkinds: domain "
         "domain domain\r\nendian: little\r\nencoding: raw\r\nspace origin: (10,20,30)\r\n\r\n" +
             bytes},
        {"text", header_of_24("encoding: ascii\n") + text},
        {"hexadecimal digits", header_of_24(little + "encoding: hex\n") + as_hex(bytes)},
        {"bzip2 in two streams",
         header_of_24(little + "encoding: bzip2\n") + bzipped(bytes.substr(0, 20)) + bzipped(bytes.substr(20))},
        {"bzip2 with a line behind it", header_of_24(little + "encoding: bzip2\n") + bzipped(bytes) + "\n"},
        {"another file", header_of_24(little + "encoding: raw\ndata file: all.raw\n")},
        {"bytes at the end", header_of_24(little + "encoding: raw\nbyte skip: -1\ndatafile: offset.raw\n")},
        {"lines and bytes skipped",
         header_of_24(little + "encoding: raw\nlineskip: 2\nbyteskip: 4\ndata file: offset.raw\n")},
        {"a list of files",
         header_of_24(little + "encoding: raw\ndata file: LIST\nslice07.raw\nslice09.raw\nslice11.raw\n"
                               "slice13.raw")},
        {"numbered files", header_of_24(little + "encoding: raw\ndata file: slice%02d.raw 7 13 2\n")},
    };
    for (const auto& [name, content] : files) {
        CAPTURE(name);
        file::write_whole_file(folder / "a.nrrd", content);
        const volume::ScanVolume read = volume::read_volume(folder / "a.nrrd");
        CHECK(read.size == std::array<int, 3>{2, 3, 4});
        CHECK(read.values == values_of_24());
        CHECK(glm::length(read.spacing() - Vec3(1e-3, 2e-3, 3e-3)) < 1e-12);
        CHECK(glm::length(read.map.origin - Vec3(1e-2, 2e-2, 3e-2)) < 1e-12);
    }
    // All samples are there; the end of the stream, with its checksum, is not.
    const std::string packed = bzipped(bytes);
    file::write_whole_file(folder / "a.nrrd",
                           header_of_24(little + "encoding: bzip2\n") + packed.substr(0, packed.size() - 4));
    CHECK_THROWS_WITH(volume::read_volume(folder / "a.nrrd"), ContainsSubstring("cut short"));
}

TEST_CASE("axes of one sample are left out of an NRRD wherever they stand, and the others keep their directions") {
    const TemporaryFolder folder;
    const std::string vectors[] = {"(1,0,0)", "(0,2,0)", "(0,0,3)"}, sizes[] = {"2", "3", "4"};
    for (std::size_t single = 0; single <= 3; ++single) {
        CAPTURE(single);
        std::string size_line = "sizes:", direction_line = "space directions:";
        for (std::size_t n = 0; n <= 3; ++n) {
            if (n == single) size_line += " 1", direction_line += " none";
            if (n < 3) size_line += " " + sizes[n], direction_line += " " + vectors[n];
        }
        file::write_whole_file(folder / "a.nrrd",
                               "NRRD0005\ntype: short\ndimension: 4\nspace: LPS\n" + size_line + "\n" + direction_line +
                                   "\nspace origin: (0,0,0)\nendian: little\nencoding: raw\n\n" + bytes_of_24(false));
        const volume::ScanVolume read = volume::read_volume(folder / "a.nrrd");
        CHECK(read.size == std::array<int, 3>{2, 3, 4});
        CHECK(read.values == values_of_24());
        CHECK(glm::length(read.spacing() - Vec3(1e-3, 2e-3, 3e-3)) < 1e-12);
        CHECK(read.notes == std::vector<std::string>{"a fourth axis of one sample was left out"});
    }
}

TEST_CASE("a damaged field of an NRRD header is refused with its line") {
    const TemporaryFolder folder;
    for (const auto& [line, message] : std::vector<std::pair<std::string, std::string>>{
             {"type: shrt", "2:1: the type 'shrt' is unknown"},
             {"dimension: 3x", "3:1: '3x' is no dimension"},
             {"space directions: (1,0,0) (0,1) (0,0,1)", "6:1: '(0,1)' is no vector of three numbers"},
             {"space directions: (1,0,0) (0,1,0)", "its header states 3 axes and 2 space directions"},
             {"encoding: rar", "9:1: the encoding 'rar' is unknown"},
             {"endian: middle", "8:1: endian is little or big"},
             {"sizes: 2 0 2", "5:1: '0' is no size"},
             {"space origin: (0,0,0", "is no vector, as (1,0,0)"},
             {"space units: \"mm\" \"mm", "is no unit between quotes"},
             {"data file: slice%s.raw 1 3 1", "holds no number"},
             {"data file: slice%03d.raw 1 3 0", "no files are numbered"},
             {"no field", "is no header field"}}) {
        CAPTURE(line);
        file::write_whole_file(folder / "a.nrrd", nrrd_with(line));
        CHECK_THROWS_WITH(volume::read_volume(folder / "a.nrrd"), ContainsSubstring(message));
    }
    std::string twice = nrrd_with("endian: little");
    twice.insert(twice.find("endian"), "sizes: 2 2 2\n");
    file::write_whole_file(folder / "a.nrrd", twice);
    CHECK_THROWS_WITH(volume::read_volume(folder / "a.nrrd"), ContainsSubstring("the field 'sizes' comes twice"));
}

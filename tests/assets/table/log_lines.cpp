// SPDX-License-Identifier: Apache-2.0
#include "assets/table/log_lines.hpp"

#include "tests/support/catch.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

using namespace tactus;

namespace {

table::LogBlocks blocks_of(std::string_view text) {
    return table::LogBlocks([rest = text](std::span<char> out) mutable {
        const std::size_t count = rest.copy(out.data(), out.size());
        rest.remove_prefix(count);
        return count;
    });
}

std::vector<std::string> lines_of(table::LogBlocks blocks) {
    std::vector<std::string> lines;
    for (std::string_view line; blocks.next(line);) {
        // To ask does not move the line.
        const char* const place = line.data();
        const bool is_last = blocks.at_end();
        CHECK(line.data() == place);
        lines.emplace_back(line);
        if (is_last) CHECK_FALSE(blocks.next(line));
    }
    CHECK(blocks.at_end());
    CHECK(blocks.number() == static_cast<int>(lines.size()));
    return lines;
}

}  // namespace

TEST_CASE("lines read in blocks are those of the text, wherever a block of 1 MiB ends") {
    for (const std::string_view end : {"\n", "\r\n", "\r"})
        for (std::size_t shift = 0; shift < 8; ++shift) {
            CAPTURE(end.size(), shift);
            // A line end lies on each side of the border of the first block.
            std::string text(shift, 'x');
            while (text.size() < (std::size_t{1} << 20) + 3000) text += "12.5,  7" + std::string(end);
            text += "the last";
            std::vector<std::string> expected;
            table::LogLines whole(text);
            for (std::string_view line; whole.next(line);) expected.emplace_back(line);
            CHECK(lines_of(blocks_of(text)) == expected);
        }
}

TEST_CASE("marks are left out and UTF-16 is converted across blocks") {
    CHECK(lines_of(blocks_of("\xef\xbb\xbf"
                             "a\nb")) == std::vector<std::string>{"a", "b"});
    std::string little = "\xff\xfe", big = "\xfe\xff";
    std::vector<std::string> expected;
    for (int n = 0; n < 80000; ++n) {
        for (const char c : std::string_view("1.25;\n")) little += {c, '\0'}, big += {'\0', c};
        expected.emplace_back("1.25;");
    }
    little += std::string("\xb2\0", 2), big += std::string("\0\xb2", 2);
    expected.emplace_back("\xc2\xb2");
    CHECK(lines_of(blocks_of(little)) == expected);
    CHECK(lines_of(blocks_of(big)) == expected);
    CHECK(lines_of(blocks_of("")).empty());
}

TEST_CASE("a line of many megabytes is given in parts that are longer than a line may be") {
    const std::string text(3 << 20, '7');
    table::LogBlocks blocks = blocks_of(text);
    std::string_view line;
    REQUIRE(blocks.next(line));
    CHECK(line.size() > table::LogBlocks::max_line);
    CHECK(line.size() <= std::size_t{2} << 20);
}

// SPDX-License-Identifier: Apache-2.0
// Files that are no patch: each gets one clear error.
#include "assets/file/toml_depth.hpp"
#include "patch_reading.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string repeated(std::string_view text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
}

std::ptrdiff_t lines(const std::string& text) { return std::ranges::count(text, '\n'); }

}  // namespace

TEST_CASE("text that is no TOML is one problem with its place") {
    CHECK(lines(problems_of("[nodes.a\n")) == 1);
    CHECK_THAT(problems_of("title = \"x\"\n[$a]\n"), ContainsSubstring("p.toml:2:2: not valid TOML"));
    CHECK_THAT(problems_of("title = \"x\"\nseed = = 3\n"), ContainsSubstring("p.toml:2:8: not valid TOML"));
    CHECK_THAT(problems_of("title = \"never ends\nseed = 1\n"), ContainsSubstring("p.toml:1:"));
    CHECK_THAT(problems_of("title = \"\"\"never ends\n\n"),
               ContainsSubstring("p.toml:") && ContainsSubstring("not valid TOML"));
    CHECK_THAT(problems_of("seed = 1\nseed = 2\n"), ContainsSubstring("p.toml:2:") && ContainsSubstring("redefine"));
    CHECK(lines(problems_of(std::string("\x7f"
                                        "ELF\x02\x01\x01\0\0\xff\xfe",
                                        11))) == 1);
    CHECK(lines(problems_of(std::string(1000, '\0'))) == 1);
    CHECK(lines(problems_of("title = \"\xc3\x28\"\n")) == 1);
}

TEST_CASE("an empty patch is told to have nodes") {
    CHECK_THAT(problems_of(""), ContainsSubstring("p.toml:1:1: the patch has no nodes"));
    CHECK_THAT(problems_of("\xEF\xBB\xBF"), ContainsSubstring("no nodes"));
    CHECK_THAT(problems_of("# nothing\n\n"), ContainsSubstring("no nodes"));
}

TEST_CASE("nesting without end is refused, however it is written") {
    CHECK(lines(problems_of("x = " + repeated("[", 500'000))) == 1);
    CHECK(lines(problems_of("x = " + repeated("{a=", 500'000))) == 1);
    CHECK_THAT(problems_of("title = \"x\"\n[" + repeated("a.", 500'000) + "a]\n"),
               ContainsSubstring("p.toml:2:") && ContainsSubstring("dots"));
    CHECK_THAT(problems_of(repeated("a.", 500'000) + "a = 1\n"),
               ContainsSubstring("p.toml:1:66: a key has at most 32 dots"));
    CHECK_THAT(problems_of("x = {" + repeated("\"a\" . ", 500'000) + "a = 1}\n"), ContainsSubstring("dots"));
    CHECK_THAT(problems_of("[" + repeated("'.' . ", 100) + "a]\n"), ContainsSubstring("dots"));
}

TEST_CASE("dots in texts and comments are not nesting") {
    const std::string dots(1000, '.');
    CHECK_FALSE(file::overlong_key("a = \"" + dots + "\"\n"));
    CHECK_FALSE(file::overlong_key("a = '" + dots + "'\n"));
    CHECK_FALSE(file::overlong_key("a = \"\"\"\n" + dots + "\\\"\"\"\n" + dots + "\"\"\"\n"));
    CHECK_FALSE(file::overlong_key("# " + dots + "\na = 1\n"));
    CHECK_FALSE(file::overlong_key("a = \"\\\"" + dots + "\"\n"));
    CHECK_FALSE(file::overlong_key(repeated("x.y = 1.5\n", 1000)));
    CHECK_FALSE(file::overlong_key("a = \"" + dots));
    CHECK_FALSE(file::overlong_key("a = \"\\"));
    CHECK(file::overlong_key("a = \"x\"\nb" + dots) == std::size_t{9 + file::max_dots_in_key});
}

TEST_CASE("a megabyte of text is read or refused, with a short message") {
    CHECK_THAT(problems_of("title = \"" + std::string(1 << 20, 'x') + "\"\n"), ContainsSubstring("no nodes"));
    const std::string message = problems_of("wires = [\"" + std::string(1 << 20, 'x') + "\"]\n");
    CHECK(lines(message) == 1);
    CHECK(message.size() < 300);
    CHECK(lines(problems_of(std::string(1 << 20, 'x'))) == 1);
    CHECK(lines(problems_of(repeated("[a]\n", 1 << 18))) == 1);
}

TEST_CASE("what cannot be opened as a patch says why") {
    patch::Problems problems;
    const auto refusal = [&](const std::filesystem::path& file) -> std::string {
        try {
            patch::load_patch(file, problems);
        } catch (const Error& error) {
            return error.what();
        }
        return {};
    };
    CHECK(refusal("no/such/patch.toml") == "no/such/patch.toml: there is no such patch");
    CHECK(refusal(std::filesystem::temp_directory_path()) ==
          std::filesystem::temp_directory_path().string() + ": is a folder, not a patch");
    CHECK_THAT(refusal("/dev/zero"), ContainsSubstring("/dev/zero: is a pipe, a socket or a device"));
    CHECK_THAT(refusal("/dev/null"), ContainsSubstring("/dev/null: is a pipe, a socket or a device"));
    CHECK(problems.empty());
}

// SPDX-License-Identifier: Apache-2.0
#include "assets/file/module.hpp"

#include "assets/bone/vdb_codec.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("a module is loaded once") {
    void* const first = file::load_module(bone::vdb_module, bone::vdb_codec_symbol);
    CHECK(first != nullptr);
    CHECK(file::load_module(bone::vdb_module, bone::vdb_codec_symbol) == first);
}

TEST_CASE("a missing module is an error that names the two places where it may be") {
    CHECK_THROWS_WITH(file::load_module("tactus-none.so", "none"),
                      ContainsSubstring("/tests/tactus-none.so nor ") && ContainsSubstring("/tactus/tactus-none.so") &&
                          ContainsSubstring("build or install tactus-none.so"));
}

TEST_CASE("a module of another version is an error that names the function it lacks") {
    CHECK_THROWS_WITH(
        file::load_module(bone::vdb_module, "tactus_other_codec"),
        ContainsSubstring("cannot load a part of this program: ") && ContainsSubstring("tactus_other_codec"));
}

// SPDX-License-Identifier: Apache-2.0
#include "tools/window/training/score_words.hpp"

#include "tests/support/catch.hpp"

using namespace tactus;

TEST_CASE("a folder of results that is gone gives no score and a reason") {
    const std::string words = window::score_of("/nowhere/at/all");
    CHECK(words.starts_with("no score: "));
    CHECK(words.size() > 12);
}

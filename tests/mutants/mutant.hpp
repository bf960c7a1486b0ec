// SPDX-License-Identifier: Apache-2.0
// The fault that TACTUS_MUTANT switches on in the mutated copies of sources that the test program `mutants` compiles.
#pragma once

#include <cstdlib>

namespace tactus::test {

inline bool is_mutant(int number) noexcept {
    static const int chosen = [] {
        const char* const text = std::getenv("TACTUS_MUTANT");
        return text ? std::atoi(text) : 0;
    }();
    return chosen == number;
}

}  // namespace tactus::test

// SPDX-License-Identifier: Apache-2.0
// The C functions of libtactus: whatever a program calls, with whatever, it gets a result or an error with a reason.
#include "tests/tools/embed/any_calls.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::size_t at = 0;
    const auto pick = [&](int count) {
        unsigned word = at < size ? data[at++] : 0u;
        if (count > 256 && at < size) word = word << 8 | data[at++];
        return static_cast<int>(word % static_cast<unsigned>(count));
    };
    tactus::test::make_any_calls(pick, static_cast<int>(size / 4));
    return 0;
}

// SPDX-License-Identifier: Apache-2.0
// parse_quantity: any text is a finite quantity or a tactus::Error, and what it formats parses back.
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const auto quantity = tactus::parse_quantity({reinterpret_cast<const char*>(data), size});
        if (!std::isfinite(quantity.value)) std::abort();
        const std::string again = tactus::format_quantity(quantity.value, "");
        const double difference = tactus::parse_quantity(again).value - quantity.value;
        if (std::abs(difference) > 1e-11 * std::abs(quantity.value) + 1e-300) std::abort();
    } catch (const tactus::Error&) {
        // Refusing is right for most texts.
    }
    return 0;
}

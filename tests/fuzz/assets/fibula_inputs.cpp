// SPDX-License-Identifier: Apache-2.0
// fibula_inputs_of_text and plan_fibula: any text gives a plan of finite numbers, or is refused with one message.
#include "assets/reconstruction/fibula_inputs.hpp"
#include "dsp/core/error.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace reconstruct = tactus::reconstruction;
    try {
        const auto inputs =
            reconstruction::fibula_inputs_of_text({reinterpret_cast<const char*>(data), size}, "inputs.json");
        for (const auto& segment : reconstruction::plan_fibula(inputs).segments)
            if (!tactus::is_valid(segment.donor_to_target) || !std::isfinite(segment.tilt[0] + segment.tilt[1]))
                std::abort();
    } catch (const tactus::Error& error) {
        if (error.message().empty() || error.message().find('\n') != std::string::npos) std::abort();
    }
    return 0;
}

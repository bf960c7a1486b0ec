// SPDX-License-Identifier: Apache-2.0
// read_plan_text: any text is a plan or is refused with one message; a plan comes back from its own text as it was.
#include "assets/cases/plan_file.hpp"
#include "dsp/core/error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const tactus::cases::CasePlan plan =
            tactus::cases::read_plan_text({reinterpret_cast<const char*>(data), size}, "case.plan.json");
        for (const tactus::cases::PlanAlternative& alternative : plan.alternatives)
            tactus::cases::state_of(plan, alternative.place.head);
        const std::string text = tactus::cases::plan_text(plan);
        if (tactus::cases::plan_text(tactus::cases::read_plan_text(text, "again")) != text) std::abort();
    } catch (const tactus::Error& error) {
        if (error.message().empty() || error.message().find('\n') != std::string::npos) std::abort();
    }
    return 0;
}

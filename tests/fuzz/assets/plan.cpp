// SPDX-License-Identifier: Apache-2.0
// read_plan_text: any text is a plan or is refused with one message; a plan comes back from its own text as it was.
#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const tactus::plan::CasePlan plan =
            tactus::plan::read_plan_text({reinterpret_cast<const char*>(data), size}, "case.plan.json");
        for (const tactus::plan::PlanAlternative& alternative : plan.alternatives)
            tactus::plan::state_of(plan, alternative.place.head);
        const std::string text = tactus::plan::plan_text(plan);
        if (tactus::plan::plan_text(tactus::plan::read_plan_text(text, "again")) != text) std::abort();
    } catch (const tactus::Error& error) {
        if (error.message().empty() || error.message().find('\n') != std::string::npos) std::abort();
    }
    return 0;
}

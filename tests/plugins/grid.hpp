// SPDX-License-Identifier: Apache-2.0
// A value type that two plug-ins share by this header.
#pragma once

#include <cstdint>

namespace shared {

struct Counts {
    static constexpr auto wire_name = "counts";
    std::int64_t version = 0;
    std::uint64_t content_hash = 0;
    double total = 0.0;
#ifdef TACTUS_OTHER_LAYOUT
    double more = 0.0;
#endif
};

}  // namespace shared

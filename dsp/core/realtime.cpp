// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/realtime.hpp"

namespace tactus {

thread_local constinit int realtime_depth = 0;

}  // namespace tactus

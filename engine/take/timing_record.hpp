// SPDX-License-Identifier: Apache-2.0
// One timing decision of a live run.
#pragma once

#include "graph/node/device.hpp"

#include <cstdint>

namespace tactus::take {

enum class TimingKind : std::uint8_t {
    device_sample,  ///< `source` is the device
    held_read,      ///< activations tick … tick + count − 1 read index `value` of link `source`
    skipped,        ///< activations tick … tick + count − 1 never ran
    dropped,        ///< publications tick … tick + count − 1 to link `source` were dropped for lack of room
    parameter,  ///< from activation tick on, parameter change number `value` applies; it ramps over `source`
    ///< activations, 0: immediately
    fade,  ///< from activation tick on, forces fade: `source` 0, because the plan will change; 1, because of a
    ///< pause; `value` 1: the pause begins, 0: it ends
    plan,  ///< from activation tick on, plan number `value` runs; its changes of parameters on which a force
    ///< depends ramp over `source` activations, 0: immediately
    progress,  ///< all records before tick are in the log; an incomplete log is valid up to here
    end,  ///< the last activation of the group was tick − 1
    whole,  ///< the last record of a complete log; `value` is the number of all records
    heard,  ///< samples of sound input `source`, in `sample` (take/sound_record.hpp): the last `value` ones of
    ///< activations tick … tick + count − 1
    overdue,  ///< from activation tick on, source `value` of the force on device `source` is overdue or not finite;
    ///< −1: none is
};

/// Written by the deciding group, in its own order.
struct TimingRecord {
    TimingKind kind = TimingKind::end;
    std::uint16_t group = 0;
    std::uint32_t source = 0;
    std::int32_t count = 0;
    std::int64_t tick = 0;
    std::int64_t value = 0;
    DeviceSample sample;
};

}  // namespace tactus::take

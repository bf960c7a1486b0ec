// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruct/flap.hpp"

namespace tactus::reconstruct {

const char* name_of(VesselKind kind) { return kind == VesselKind::artery ? "artery" : "vein"; }

}  // namespace tactus::reconstruct

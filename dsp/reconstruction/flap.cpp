// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/flap.hpp"

namespace tactus::reconstruction {

const char* name_of(VesselKind kind) { return kind == VesselKind::artery ? "artery" : "vein"; }

}  // namespace tactus::reconstruction

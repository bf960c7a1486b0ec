// SPDX-License-Identifier: Apache-2.0
// The bundled bone: the body of a mandible, made by formula so that it is free of anyone's data.
#pragma once

#include "assets/bone/bone.hpp"

namespace tactus::library {

/// CT values (HU) of the segment at 0.3 mm voxels, LPS, slightly blurred: 55 mm along a parabolic arch, egg-shaped
/// section of 12 mm by 28 mm (z up), cortex of 2.2 to 3 mm thicker at the lower border, trabecular core, and a
/// mandibular canal of 3 mm bore with a thin wall, filled with soft matter. Typical adult values, not measured from one.
volume::Grid mandible_hu();

/// The same as a bone, through the steps that an imported CT takes. Deterministic.
bone::Bone make_mandible();

}  // namespace tactus::library

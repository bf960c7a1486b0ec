// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/kerf_doubt.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::analysis {

std::string kerf_doubt(const fit::KerfEstimate& kerf) {
    if (kerf.is_open)
        return fmt::format(
            "unsure: up to {:.1f} mm of bone may be lost between the faces; neither the faces nor the cortex beyond "
            "them exclude it: specify the width with --kerf, or --kerf 0 if no bone is lost",
            kerf.loss * 1e3);
    const std::string faces = kerf.given ? fmt::format("unsure: the given kerf is {:.1f} mm", *kerf.given * 1e3)
                                         : "unsure: the faces touch";
    if (!kerf.is_contradicted)
        return faces + ", but rough faces do not locate so wide a gap to 0.5 mm: place the fragment by hand";
    const double estimate = std::round(kerf.kerf * 1e4) / 10.0;  // mm
    if (!(estimate > 0.0))
        return faces + ", but the cortex beyond the faces indicates that no bone is lost: specify --kerf 0 if so";
    return fmt::format(
        "{}, but the cortex beyond the faces indicates a kerf of {:.1f} ± {:.1f} mm: specify --kerf {:.1f} if that "
        "much bone is lost, or place the fragment by hand",
        faces, estimate, kerf.spread * 1e3, estimate);
}

}  // namespace tactus::analysis

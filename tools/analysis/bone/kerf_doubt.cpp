// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/kerf_doubt.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::analysis {

std::string kerf_doubt(const fit::KerfEstimate& kerf) {
    const std::string said = kerf.told ? fmt::format("unsure: told a kerf of {:.1f} mm", *kerf.told * 1e3)
                                       : "unsure: the faces lie on each other, and the cortex beyond them does not";
    if (kerf.is_open)
        return fmt::format(
            "unsure: neither the faces nor the cortex beyond them exclude that up to {:.1f} mm of bone is lost between "
            "them: say how much with --kerf, or --kerf 0 if none is",
            kerf.loss * 1e3);
    if (!kerf.is_contradicted)
        return said + "; across rough faces so wide a gap is not known to 0.5 mm: place it by hand";
    const double seen = std::round(kerf.kerf * 1e4) / 10.0;  // mm
    if (!(seen > 0.0))
        return said + ", and the cortex beyond the faces says that no bone is lost: --kerf 0 if that is so";
    return fmt::format(
        "{}; a kerf of about {:.1f} mm is seen ({:.1f} ± {:.1f} mm): --kerf \"{:.1f} mm\" if so much bone is lost, "
        "or place it by hand",
        said, seen, seen, kerf.spread * 1e3, seen);
}

}  // namespace tactus::analysis

// SPDX-License-Identifier: Apache-2.0
// A small reconstruction of a jaw whose numbers are known.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/flap.hpp"
#include "tests/dsp/reconstruction/donors.hpp"

#include <glm/geometric.hpp>

namespace tactus::reconstruction {

inline constexpr double milli = 1e-3;

/// A straight, round donor of 330 mm along z and two segments of 40 mm across the front of a jaw, from the patient's
/// right (plane 1) to the left (plane 3). Its pedicle leaves at plane 3.
inline FibulaInputs small_inputs() {
    FibulaInputs in;
    in.planes = {{{-40 * milli, 0, 0}, Vec3(1, 0, 0), {}},
                 {{0, -10 * milli, 0}, {}, {}},
                 {{40 * milli, 0, 0}, Vec3(1, 0, 0), {}}};
    in.line_point = {0.1, 0, -0.2};
    in.donor = closed_tube(Vec3(0.1, 0.0, -0.2), Vec3(0.0, 0.0, 1.0), 0.33, 40, 61,
                           [](double, double) { return 7.0 * milli; });
    return in;
}

/// A vessel along the whole donor, `aside` of its line, from the knee on.
inline FlapVessel along_donor(const char* name, VesselKind kind, const Vec3& aside) {
    FlapVessel vessel{name, kind, 1.5 * milli, {}};
    for (int n = 0; n <= 66; ++n) vessel.points.push_back(Vec3(0.1, 0.0, 0.13 - 5.0 * milli * n) + aside);
    return vessel;
}

/// Artery and vein behind the donor's line (LPS: +y), where the jaw's inside is; sites below the left angle of the jaw.
inline Flap small_flap() {
    Flap flap;
    flap.vessels = {along_donor("peroneal", VesselKind::artery, Vec3(0, 10 * milli, 0)),
                    along_donor("comitant", VesselKind::vein, Vec3(3 * milli, 10 * milli, 0))};
    flap.sites = {{"facial artery", VesselKind::artery, Vec3(0.06, 0.04, -0.03)},
                  {"facial vein", VesselKind::vein, Vec3(0.063, 0.04, -0.03)}};
    return flap;
}

}  // namespace tactus::reconstruction

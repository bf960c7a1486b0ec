// SPDX-License-Identifier: Apache-2.0
// Dimension drawings of the osteotomies of a donor: distances along the bone, angles in two planes.
#pragma once

#include "devices/display/figure.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/flap.hpp"

#include <cstddef>

namespace tactus::report {

/// The donor from the ankle (left) to the knee, seen from the front and from the medial side, with all cuts, their
/// distances from its end at the ankle, vessels and perforators. `inputs` have a donor.
display::Figure donor_drawing(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan,
                              const reconstruction::Flap& flap);

/// m along the line from its point to the donor's end at the ankle. `inputs` have a donor.
double ankle_end(const reconstruction::FibulaInputs& inputs);

/// One cut in the same two views, with its angles and where it meets the surface, mm from the end at the ankle.
display::Figure osteotomy_drawing(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan,
                                  std::size_t segment, std::size_t end);

}  // namespace tactus::report

// SPDX-License-Identifier: Apache-2.0
// The narrowest place of a branch, measured in the scan.
#pragma once

#include "dsp/vessel/search.hpp"

namespace tactus::vessel {

/// Places where the radius of the nodes is least beside the vessel before and after, and short lost stretches, each fitted
/// (fitted_narrowing) where it is shorter than six radii; the one that narrows most, less its error, is the stenosis. Within
/// it the radii of the nodes become those of the fit. None for branches shorter than six radii.
std::optional<Stenosis> measured_stenosis(const Search& search, const Noise& noise, Branch& branch);

}  // namespace tactus::vessel

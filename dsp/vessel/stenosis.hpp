// SPDX-License-Identifier: Apache-2.0
// Measures the narrowest position of a branch in the scan.
#pragma once

#include "dsp/vessel/search.hpp"

namespace tactus::vessel {

/// Candidates are local minima of the nodes' radius and short lost stretches; each is fitted (fitted_narrowing) if it
/// is shorter than six radii. The stenosis is the candidate with the largest narrowing less its error. Within it the
/// radii of the nodes are replaced by those of the fit. Empty for branches shorter than six radii.
std::optional<Stenosis> measured_stenosis(const Search& search, const Noise& noise, Branch& branch);

}  // namespace tactus::vessel

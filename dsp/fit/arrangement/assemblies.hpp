// SPDX-License-Identifier: Apache-2.0
// Connected components of an arrangement's fragments, connected by fits.
#pragma once

#include "dsp/fit/arrangement/arrangement.hpp"

#include <vector>

namespace tactus::fit {

/// Returns the components of the shown fragments that are connected by valid fits or chains of them: the largest first,
/// then in order of their first fragment. A fragment without a fit is a component of its own. Groups do not connect.
std::vector<std::vector<int>> assemblies(const Arrangement& arrangement);

/// Returns one flag per fragment: whether it is a fixed partner for a fragment that is being moved. Fixed partners are
/// all fragments connected to a locked fragment or, if none is locked, the largest component of two or more. Fragments
/// that move with `moving` are excluded, and so are connections through them. All zero if there is no fixed partner.
std::vector<char> standing(const Arrangement& arrangement, int moving);

}  // namespace tactus::fit

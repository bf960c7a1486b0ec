// SPDX-License-Identifier: Apache-2.0
// Which fragments of an arrangement hang together by fits.
#pragma once

#include "dsp/fit/arrangement/arrangement.hpp"

#include <vector>

namespace tactus::fit {

/// The shown fragments in parts that are connected by fits which hold, chains of fits included: the largest part first,
/// then in order of their first fragment. A fragment without a fit is a part of its own. Groups do not connect.
std::vector<std::vector<int>> assemblies(const Arrangement& arrangement);

/// One per fragment: whether it belongs to what a moving fragment is brought to. That is everything connected to a
/// locked fragment or, when none is locked, the largest connected part of two or more. What moves with `moving` is left
/// out, and so are the connections through it. All zero when nothing stands.
std::vector<char> standing(const Arrangement& arrangement, int moving);

}  // namespace tactus::fit

// SPDX-License-Identifier: Apache-2.0
// Moves all fragments of an assembly at once until all mated faces fit best together: what remains of each fit is spread
// over the whole assembly, and errors do not pile up along a chain or round a ring.
#pragma once

#include "dsp/fit/fragment_matcher.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tactus::fit {

/// A pair of faces, numbered by the matcher, of fragments of different bodies.
using FacePair = std::pair<std::size_t, std::size_t>;

/// All pairs of faces that lie on each other at these poses. `body`: the rigid body of each fragment, negative: takes no
/// part.
std::vector<FacePair> mated_faces(const FragmentMatcher& matcher, std::span<const Pose> poses,
                                  std::span<const int> body);

/// Gauss–Newton steps on the poses of all bodies with the robust energy of all pairs, Levenberg's damping, and a scale
/// that narrows as in the search; a pose graph whose edges are surfaces. Bodies in `fixed` stay; there must be one. Poses
/// are those of the fragments, and fragments of one body move together. Returns the number of steps.
int refine_jointly(const FragmentMatcher& matcher, std::span<const FacePair> pairs, std::span<const int> body,
                   std::span<const char> fixed, std::span<Pose> poses);

}  // namespace tactus::fit

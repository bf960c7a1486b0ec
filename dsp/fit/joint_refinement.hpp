// SPDX-License-Identifier: Apache-2.0
// Refines the poses of all fragments of an assembly together. This distributes the residuals over the whole assembly,
// so that errors do not accumulate along a chain or around a ring.
#pragma once

#include "dsp/fit/fragment_matcher.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tactus::fit {

/// A pair of faces, numbered by the matcher, of fragments of different bodies.
using FacePair = std::pair<std::size_t, std::size_t>;

/// Returns all pairs of faces that are in contact at these poses. `body`: the rigid body of each fragment; fragments
/// with a negative number are excluded.
std::vector<FacePair> mated_faces(const FragmentMatcher& matcher, std::span<const Pose> poses,
                                  std::span<const int> body);

/// Gauss–Newton steps on the poses of all bodies with the robust energy of all pairs, Levenberg's damping, and a scale
/// that narrows as in the search: a pose graph whose edges are surfaces. Bodies in `fixed` do not move; there must be
/// at least one. Poses are those of the fragments, and fragments of one body move together. Returns the number of
/// steps.
int refine_jointly(const FragmentMatcher& matcher, std::span<const FacePair> pairs, std::span<const int> body,
                   std::span<const char> fixed, std::span<Pose> poses);

}  // namespace tactus::fit

// SPDX-License-Identifier: Apache-2.0
// Registrations as lists of numbers, for cached results.
#pragma once

#include "assets/plan/kept_result.hpp"
#include "dsp/fit/registration/mirror.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace tactus::analysis {

inline constexpr std::size_t registration_numbers = 11, mirror_fit_numbers = 24;

void add_pose(plan::ResultKey& key, const Pose& pose);
void add_registration(std::vector<double>& numbers, const fit::Registration& r);
std::vector<double> numbers_of_mirror_fit(const fit::MirrorFit& fit);

/// Reads numbers written by the functions above, in the same order. Missing numbers are 0.
class NumberReader {
public:
    explicit NumberReader(std::vector<double> numbers) : numbers_(std::move(numbers)) {}

    double next() { return at_ < numbers_.size() ? numbers_[at_++] : 0.0; }
    bool is_at_end() const { return at_ >= numbers_.size(); }
    Pose pose();
    fit::Registration registration();
    fit::MirrorFit mirror_fit();

private:
    std::vector<double> numbers_;
    std::size_t at_ = 0;
};

}  // namespace tactus::analysis

// SPDX-License-Identifier: Apache-2.0
// Comparisons of vibrations, and the runs of a patch beside its recordings, as results.
#pragma once

#include "tools/analysis/vibration/validation.hpp"
#include "tools/report/result/fields.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::report {

/// How many comparisons passed, failed, or could not be made.
struct VerdictCounts {
    std::size_t passed = 0, failed = 0, bad = 0;

    bool passes() const { return failed + bad == 0; }
};

/// Pairs of records with the error of each, empty for success.
struct ComparedPairs {
    std::span<const analysis::ComparedPair> pairs;
    std::span<const std::string> errors;

    VerdictCounts counts() const;
};

const Fields<ComparedPairs>& comparison_fields();
/// A row per pair.
std::string comparison_table(const ComparedPairs& pairs);

struct ValidatedRuns {
    const analysis::Validation* validation;
    const analysis::ValidateSettings* settings;

    VerdictCounts counts() const;
};

const Fields<ValidatedRuns>& validation_fields();
/// A row per run.
std::string validation_table(const analysis::Validation& validation);

}  // namespace tactus::report

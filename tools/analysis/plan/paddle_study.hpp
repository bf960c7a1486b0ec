// SPDX-License-Identifier: Apache-2.0
// The skin paddle of a plan: where it lies on the leg, and how it covers a defect.
#pragma once

#include "dsp/skin/paddle.hpp"
#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/flap_study.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::analysis {

struct PaddleStudy {
    skin::DrapedPaddle draped;
    skin::DrapeSettings settings;
    std::vector<CaseWarning>
        warnings;  ///< "perforator-too-short", "defect-uncovered", "fold-at-bone", "no-perforator",
                                        ///< "not-at-rest"
    std::vector<std::string> notes;     ///< about the file of the curve
};

/// The middle of a paddle of the leg when nobody states it, frame of the donor: at the middle of the perforators along the
/// line (of the kept bone without any), 20 mm behind the posterior border of the bone (Heitmann 2003, Beppu 1992). Throws
/// Error without the donor's surface there.
Vec3 default_paddle_place(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan,
                          const reconstruction::Flap& flap);

/// Drapes the plan's paddle over the closed curve of `defect` (.mrk.json or .fcsv, LPS or RAS). Throws Error.
PaddleStudy study_paddle(FlapStudy& study, const std::filesystem::path& defect, const skin::DrapeSettings& settings);

}  // namespace tactus::analysis

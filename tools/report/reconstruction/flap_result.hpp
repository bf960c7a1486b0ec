// SPDX-License-Identifier: Apache-2.0
// A flap of a plan as a result: its parts, its vessels and sites, its clearances, candidates, and its skin paddle.
#pragma once

#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/reconstruction/ranking.hpp"
#include "dsp/reconstruction/reach.hpp"
#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/paddle_study.hpp"
#include "tools/report/result/fields.hpp"

#include <optional>
#include <vector>

namespace tactus::report {

/// Contents of a plan's reconstruction, without points of vessels and plates.
const Fields<reconstruction::Reconstruction>& reconstruction_fields();

struct MeasuredFlap {
    const reconstruction::FlapMeasures* measures;
    const std::vector<analysis::CaseWarning>* warnings;
    std::optional<std::vector<reconstruction::Candidate>> candidates;
};
const Fields<MeasuredFlap>& flap_fields();

/// reaches, spans, clearances, tumour_margin_mm
const Fields<reconstruction::FlapMeasures>& flap_measures_fields();

struct RankedCandidate {
    std::size_t rank;
    const reconstruction::Candidate* candidate;
};
const Fields<RankedCandidate>& candidate_fields();
std::vector<RankedCandidate> numbered(const std::vector<reconstruction::Candidate>& all);

struct DrapedFlap {
    const analysis::PaddleStudy* study;
    const reconstruction::SkinPaddle* paddle;
};
const Fields<DrapedFlap>& paddle_fields();

}  // namespace tactus::report

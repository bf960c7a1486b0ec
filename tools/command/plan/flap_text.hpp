// SPDX-License-Identifier: Apache-2.0
// Measures of a flap as JSON and text, in mm and degrees.
#pragma once

#include "assets/file/json.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/reconstruction/ranking.hpp"
#include "dsp/reconstruction/reach.hpp"

#include <span>

namespace tactus::command {

/// Millimetres, or null.
inline file::Json in_mm(const std::optional<double>& metres) {
    return metres ? file::Json(*metres * 1e3) : file::Json(nullptr);
}

file::Json flap_json(const reconstruction::FlapMeasures& measures);
file::Json candidates_json(std::span<const reconstruction::Candidate> all);
/// What a plan holds, without points of vessels and plates.
file::Json reconstruction_json(const reconstruction::Reconstruction& all);

void print_flap(const reconstruction::FlapMeasures& measures);
void print_candidates(std::span<const reconstruction::Candidate> all);
void print_reconstruction(const reconstruction::Reconstruction& all);

}  // namespace tactus::command

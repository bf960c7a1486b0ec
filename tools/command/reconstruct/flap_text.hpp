// SPDX-License-Identifier: Apache-2.0
// Measures of a flap as JSON and text, in mm and degrees.
#pragma once

#include "assets/file/json.hpp"
#include "assets/reconstruct/reconstruction.hpp"
#include "dsp/reconstruct/ranking.hpp"
#include "dsp/reconstruct/reach.hpp"

#include <span>

namespace tactus::command {

/// Millimetres, or null.
inline file::Json in_mm(const std::optional<double>& metres) {
    return metres ? file::Json(*metres * 1e3) : file::Json(nullptr);
}

file::Json flap_json(const reconstruct::FlapMeasures& measures);
file::Json candidates_json(std::span<const reconstruct::Candidate> all);
/// What a plan holds, without points of vessels and plates.
file::Json reconstruction_json(const reconstruct::Reconstruction& all);

void print_flap(const reconstruct::FlapMeasures& measures);
void print_candidates(std::span<const reconstruct::Candidate> all);
void print_reconstruction(const reconstruct::Reconstruction& all);

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace tactus::library {

/// Writes a synthesised recording set of a reciprocating bone saw into `folder` (made if missing): `reciprocating.toml`
/// and 12 FLAC files of 2 s at 48 kHz, in free air and cutting at 3, 7 and 12 N, at 150, 190 and 233 Hz.
///
/// No power spectrum of a bone saw has been published, so that the sounds are computed from published values: 233 Hz
/// maximum rate, stroke 3.0 mm, blade of 18 teeth per inch, 7 N thrust, and handle acceleration of 90 to 182 m/s²
/// unweighted. The teeth pass fastest at mid-stroke, twice per cycle. Deterministic. Throws Error.
void make_saw_recordings(const std::filesystem::path& folder);

}  // namespace tactus::library

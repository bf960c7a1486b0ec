// SPDX-License-Identifier: Apache-2.0
// Tracks a vessel in a scan from one seed and writes the result.
#pragma once

#include "dsp/vessel/runoff.hpp"
#include "dsp/vessel/straightened.hpp"
#include "dsp/vessel/tracker.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct VesselSettings {
    std::filesystem::path scan;
    std::string series;                        ///< DICOM: the series to read
    std::optional<std::string> unit;           ///< of files without a unit
    Vec3 seed{0.0};                            ///< LPS, m
    vessel::TrackSettings track;
    std::optional<vessel::LegGeometry> leg;    ///< evaluates the run-off of a lower leg
    std::vector<std::filesystem::path> out;    ///< see write_track
    std::filesystem::path straightened;  ///< if not empty: file of the image of the straightened branch of the seed
};

inline constexpr double min_hu_of_vessels = -150.0;  ///< below fat: lower HU count as this value

struct FoundVessel {
    vessel::Followed found;
    std::optional<vessel::RunOff> run_off;
    std::optional<vessel::Straightened> straightened;
    std::vector<std::string> notes;  ///< about the reading of the scan
    std::vector<std::string>
        warnings;  ///< of the run-off, then of the track; also written to files that can store them
    double seconds = 0.0;  ///< processor time of the tracking
};

/// Writes the files if a vessel was found. Throws Error for unreadable scans, label maps, files that cannot be written,
/// and seeds outside of the scan, in air (calibrated HU below -200), in bone or in a stent.
FoundVessel follow_vessel(const VesselSettings& settings);

}  // namespace tactus::analysis

// SPDX-License-Identifier: Apache-2.0
// Follows a vessel in a scan from one seed and writes what was found.
#pragma once

#include "dsp/vessel/runoff.hpp"
#include "dsp/vessel/straightened.hpp"
#include "dsp/vessel/tracker.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::study {

struct VesselSettings {
    std::filesystem::path scan;
    std::string series;                        ///< DICOM: the series to read
    std::optional<std::string> unit;           ///< of files that state none
    Vec3 seed{0.0};                            ///< LPS, m
    vessel::TrackSettings track;
    std::optional<vessel::LegGeometry> leg;    ///< judges the run-off of a lower leg
    std::vector<std::filesystem::path> out;    ///< see write_track
    std::filesystem::path straightened;  ///< not empty: pulls the branch of the seed straight, for a picture there
};

inline constexpr double least_hu_of_vessels = -150.0;  ///< below fat: lower HU count as this value

struct FoundVessel {
    vessel::Followed found;
    std::optional<vessel::RunOff> run_off;
    std::optional<vessel::Straightened> straightened;
    std::vector<std::string> notes;  ///< on how the scan was read
    std::vector<std::string>
        warnings;  ///< of the run-off, then of the track; also in the files that have a place for them
    double seconds = 0.0;  ///< processor time of the tracking
};

/// Writes the files when a vessel was found. Throws Error for scans that cannot be read, label maps, seeds outside of the scan, on
/// air (calibrated HU below -200), bone or a stent, and for files that cannot be written.
FoundVessel follow_vessel(const VesselSettings& settings);

}  // namespace tactus::study

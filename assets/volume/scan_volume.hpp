// SPDX-License-Identifier: Apache-2.0
// A volume of patient data as it was read: samples, where they lie, and what their numbers mean.
#pragma once

#include "assets/volume/patient_frame.hpp"
#include "dsp/volume/grid.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::volume {

/// What the numbers of a volume are.
enum class HuKind {
    calibrated,  ///< HU: air is near -1000
    masked,      ///< HU inside the bone, exact zeros around it
    scanner,     ///< an unknown line of HU: density needs two known points
    none         ///< no densities at all: labels
};
enum class VolumeKind { ct, labels };

std::string_view name_of(HuKind kind);      ///< "calibrated", "masked", "scanner", "none"
std::string_view name_of(VolumeKind kind);  ///< "ct", "labels"
std::string_view name_of(Frame frame);      ///< "LPS", "RAS"

/// One structure of a label map.
struct Segment {
    int label = 1;                 ///< its value in the volume
    std::string name;              ///< empty: "label N"
    std::optional<Vec3> colour{};  ///< sRGB, 0 to 1; else one of a set of colours that are told apart easily
};

/// A volume in the order of its file, first axis fastest.
struct ScanVolume {
    std::array<int, 3> size{0, 0, 0};
    std::vector<float> values;         ///< size[0]·size[1]·size[2]
    SampleMap<Frame::lps> map;         ///< index → m
    Frame file_frame = Frame::lps;     ///< what the file said before it was turned to LPS
    VolumeKind kind = VolumeKind::ct;
    HuKind hu = HuKind::calibrated;
    std::vector<Segment> segments;     ///< those a label map names; empty when it names none
    bool uniform = true;               ///< slices were evenly spaced in the file (else they were interpolated)
    std::string format;                ///< "NRRD", "NIfTI", "DICOM", "InVesalius"
    std::string encoding;              ///< how samples were stored: "raw", "gzip", a transfer syntax, ...
    std::string source;                ///< file or folder, without its path
    std::vector<std::string> notes;    ///< what was set right while reading, one sentence each

    std::size_t count() const {
        return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
               static_cast<std::size_t>(size[2]);
    }
    Vec3 spacing() const;      ///< m, along the file's axes
    double tilt_deg() const;   ///< how far the third axis leans from the normal of the first two, degrees
};

struct ReadOptions {
    std::string series;  ///< DICOM: the series to take, by its UID or the end of it; needed where a folder has several
};

/// Reads NRRD (.nrrd, .nhdr, .seg.nrrd), NIfTI-1 and -2 (.nii, .nii.gz), a DICOM file or a folder of them, or an
/// InVesalius project (.inv3), by content where it tells and by extension otherwise. Throws Error for what is damaged,
/// too short for what its header claims (before memory is taken for it), without geometry, or none of these formats.
ScanVolume read_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// True for files and folders that read_volume would try; false for meshes, bones and everything else.
bool is_volume_file(const std::filesystem::path& path);

/// The same volume on axes of LPS, see ReorientedVolume.
Grid lps_grid(ScanVolume volume);

}  // namespace tactus::volume

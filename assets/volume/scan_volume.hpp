// SPDX-License-Identifier: Apache-2.0
// A scan as read from a file: samples, geometry, and the meaning of the values.
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

/// The meaning of a volume's values.
enum class HuKind {
    calibrated,  ///< HU: air is near -1000
    masked,      ///< HU inside the bone, exact zeros around it
    scanner,     ///< uncalibrated: HU needs two known points
    none         ///< labels, no densities
};
enum class VolumeKind {
    ct,
    labels,
    maybe_labels  ///< floating-point samples with values like those of labels: the file does not state which
};

/// Whether the values are in HU. A masked volume is not if its greatest value is 255 or less: bone exceeds that, and
/// masked images of 8 bits, probabilities and scaled values do not.
bool are_hu(HuKind kind, double greatest);

std::string_view name_of(HuKind kind);      ///< "calibrated", "masked", "scanner", "none"
std::string_view name_of(VolumeKind kind);  ///< "ct", "labels", "labels?"
std::string_view name_of(Frame frame);      ///< "LPS", "RAS"

/// Key of the HU of the surface in the header of an exported bone: a key/value pair in NRRD, "key=value" in the text
/// `descrip` of NIfTI. Without it the surface could only be guessed from the histogram.
inline constexpr std::string_view surface_hu_key = "tactus_surface_hu";

/// One structure of a label map.
struct Segment {
    int label = 1;                 ///< its value in the volume
    std::string name;              ///< empty: "label N"
    std::optional<Vec3> colour{};  ///< sRGB, 0 to 1; none: a colour from a palette
};

/// A volume in file order, first axis fastest.
struct ScanVolume {
    std::array<int, 3> size{0, 0, 0};
    std::vector<float> values;         ///< size[0]·size[1]·size[2]
    SampleMap<Frame::lps> map;         ///< index → m
    Frame file_frame = Frame::lps;     ///< frame of the file before the conversion to LPS
    VolumeKind kind = VolumeKind::ct;
    HuKind hu = HuKind::calibrated;
    std::vector<Segment> segments;     ///< named segments of a label map
    bool unit_stated = true;           ///< false: the file states no unit of length, mm is assumed
    bool uniform = true;               ///< the slices were evenly spaced in the file; false: they were interpolated
    std::optional<double> surface_hu;  ///< HU of the surface of an exported bone, as the file states it
    std::string format;                ///< "NRRD", "NIfTI", "DICOM", "InVesalius"
    std::string encoding;              ///< storage of the samples: "raw", "gzip", a transfer syntax, ...
    std::string source;                ///< name of the file or folder
    std::vector<std::string> notes;    ///< corrections made while reading, one sentence each

    std::size_t count() const {
        return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
               static_cast<std::size_t>(size[2]);
    }
    Vec3 spacing() const;      ///< m, along the file's axes
    double tilt_deg() const;   ///< angle between the third axis and the normal of the first two, degrees
};

struct ReadOptions {
    std::string
        series;  ///< DICOM: the series to read, by its UID or the end of it; several between commas are joined; needed when a folder has several
    std::optional<std::string> unit{};  ///< "mm", "cm" or "m", for files that state no unit of length; default: mm
    bool fill_gaps =
        false;  ///< DICOM: interpolate where slices are missing, with a note; else such a series is refused
};

/// Reads NRRD (.nrrd, .nhdr, .seg.nrrd), NIfTI-1 and -2 (.nii, .nii.gz), a DICOM file, a folder or zip of them,
/// or an InVesalius project (.inv3), detected by content if possible, otherwise by extension. Throws Error for files that are
/// damaged, shorter than the header claims (before memory is allocated), without geometry, or in another format.
ScanVolume read_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// Asks for the unit when the file states none and the volume is not plausible in mm; else empty. See unit_question.
std::string unit_question(const ScanVolume& volume);

/// True for files and folders that read_volume accepts by name; false for meshes, bones and everything else.
bool is_volume_file(const std::filesystem::path& path);

/// The volume on LPS axes, see ReorientedVolume.
Grid lps_grid(ScanVolume volume);

}  // namespace tactus::volume

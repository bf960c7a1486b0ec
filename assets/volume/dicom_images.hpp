// SPDX-License-Identifier: Apache-2.0
// The images in a DICOM file: headers and samples, read by a process of its own.
#pragma once

#include "assets/file/zip_file.hpp"
#include "dsp/core/types.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tactus::volume {

/// An image: a file, or a frame of a multi-frame file. Lengths in mm, LPS, as in the standard.
struct DicomImage {
    std::filesystem::path file;         ///< in a zip: ZIP/NAME, which is no path on the disk
    std::shared_ptr<const file::ZipFile> archive;  ///< the zip, or null
    file::ZipFile::Entry entry;         ///< in the zip
    int frame = 0;                      ///< from 0
    bool is_one_of_several = false;     ///< the file has more frames
    std::string instance, series, description, modality, rescale_type, syntax;
    int rows = 0, columns = 0;
    std::optional<Vec3> position;       ///< centre of the first sample
    bool has_own_position = true;       ///< false: a frame for which the file states only the position of all frames
    Vec3 along_row{0.0}, along_column{0.0};  ///< unit vectors; zero when not given
    double row_spacing = 0.0, column_spacing = 0.0;  ///< between rows, between columns; 0 when not given
    double slice_spacing = 0.0, slice_thickness = 0.0;  ///< 0 when not given
    double slope = 1.0, intercept = 0.0;
    bool has_rescale = false;
    bool is_localizer = false;
    bool is_colour = false;    ///< more than one sample per pixel, or a palette: no CT
    bool is_inverted = false;  ///< MONOCHROME1: displayed with low values bright; the values are not affected
    bool has_decimal_commas = false;  ///< numbers are written as "2,5"
    bool has_zero_slope = false;  ///< the file states a rescale slope of 0, which is read as 1
    int segment = 0;           ///< of a segmentation: number of the frame's segment; 0: none
    std::string segment_name;
};

/// The samples of all frames of a file, rescaled by each frame's slope and intercept.
struct DicomSamples {
    std::vector<float> values;
    std::size_t padded = 0;        ///< samples outside the field of view, which were read as air
    double padding = 0.0;          ///< their stored value
    bool is_padding_stated = true;  ///< false: recognised as the only value above 32767
};

/// Reads DICOM files in a process of its own, which it starts on first use and again after the process failed: GDCM ends
/// the program by an assertion, or by a signal, on some damaged files. The process has limits of memory and time. Any
/// thread may call it.
class DicomReader {
public:
    DicomReader();
    ~DicomReader();
    DicomReader(const DicomReader&) = delete;
    DicomReader& operator=(const DicomReader&) = delete;

    /// The images of a file in order of frames; none for files without images (reports, DICOMDIR). Throws Error for
    /// files that are damaged, and for images that claim more samples than the file can hold.
    std::vector<DicomImage> images(const std::filesystem::path& file);
    /// The same for a file in a zip.
    std::vector<DicomImage> images(const std::shared_ptr<const file::ZipFile>& archive,
                                   const file::ZipFile::Entry& entry);
    /// The samples of all frames of the file that `image` is in. Throws Error when they cannot be decoded.
    DicomSamples samples(const DicomImage& image);

private:
    struct Process;
    std::unique_ptr<Process> process_;
    std::mutex one_at_a_time_;
};

}  // namespace tactus::volume

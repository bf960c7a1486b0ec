// SPDX-License-Identifier: Apache-2.0
// The images in a DICOM file: headers and samples.
#pragma once

#include "assets/file/zip_file.hpp"
#include "dsp/core/types.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
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
    Vec3 along_row{0.0}, along_column{0.0};  ///< unit vectors; zero when not given
    double row_spacing = 0.0, column_spacing = 0.0;  ///< between rows, between columns; 0 when not given
    double slope = 1.0, intercept = 0.0;
    bool has_rescale = false;
    bool is_localizer = false;
    bool is_inverted = false;  ///< MONOCHROME1: displayed with low values bright; the values are not affected
};

/// The images of a file in order of frames; none for files without images (reports, DICOMDIR). Throws Error for images
/// that claim more samples than the file can hold, and for colour images.
std::vector<DicomImage> dicom_images(const std::filesystem::path& file);
/// The same for a file in a zip.
std::vector<DicomImage> dicom_images(const std::shared_ptr<const file::ZipFile>& archive,
                                     const file::ZipFile::Entry& entry);
/// All images of the file that `image` is in.
std::vector<DicomImage> dicom_images_beside(const DicomImage& image);

/// The samples of all frames, rescaled by each frame's slope and intercept. `images`: the result of dicom_images for
/// this file. Throws Error when they cannot be decoded.
std::vector<float> dicom_samples(const std::vector<DicomImage>& images);

}  // namespace tactus::volume

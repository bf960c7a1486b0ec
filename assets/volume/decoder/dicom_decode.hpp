// SPDX-License-Identifier: Apache-2.0
// Reads DICOM files with GDCM. For the process that reads scans only: GDCM ends the program on some damaged files.
#pragma once

#include "assets/volume/dicom_images.hpp"

#include <functional>
#include <string>
#include <vector>

namespace tactus::volume {

/// A file on disk, or the bytes of a file in a zip.
struct DicomSource {
    std::string name;                   ///< path, or name for messages
    const std::string* bytes = nullptr;  ///< null: on disk
};

/// As DicomReader::images.
std::vector<DicomImage> decode_dicom_images(const DicomSource& source);

/// The samples of `images`, the result of decode_dicom_images, into memory of as many floats as `memory` is asked for.
/// The result has no values.
DicomSamples decode_dicom_samples(const DicomSource& source, const std::vector<DicomImage>& images,
                                  const std::function<float*(std::size_t count)>& memory);

}  // namespace tactus::volume

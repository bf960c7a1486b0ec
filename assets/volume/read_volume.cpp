// SPDX-License-Identifier: Apache-2.0
#include "assets/file/whole_file.hpp"
#include "assets/file/zip_file.hpp"
#include "assets/volume/length_unit.hpp"
#include "assets/volume/readers.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>

namespace tactus::volume {

namespace {

enum class Format { nrrd, nifti, inv3, dicom, none };

bool ends_with(const std::filesystem::path& path, std::string_view ending) {
    return lower(path.filename().string()).ends_with(ending);
}

// NRRD and DICOM are detected by their first bytes, gzipped files and NIfTI by their names.
Format format_of(const std::filesystem::path& path) {
    if (std::filesystem::is_directory(path)) return Format::dicom;
    file::require_file(path);
    if (ends_with(path, ".nrrd") || ends_with(path, ".nhdr")) return Format::nrrd;
    if (ends_with(path, ".nii") || ends_with(path, ".nii.gz") || ends_with(path, ".hdr") || ends_with(path, ".img") ||
        ends_with(path, ".hdr.gz") || ends_with(path, ".img.gz"))
        return Format::nifti;
    if (ends_with(path, ".inv3")) return Format::inv3;
    if (ends_with(path, ".dcm") || ends_with(path, ".ima") || is_dicom_file(path) || file::is_zip_file(path))
        return Format::dicom;
    std::array<char, 7> mark{};
    std::ifstream(path, std::ios::binary).read(mark.data(), mark.size());
    return std::string_view(mark.data(), mark.size()) == "NRRD000" ? Format::nrrd : Format::none;
}

}  // namespace

bool is_volume_file(const std::filesystem::path& path) { return format_of(path) != Format::none; }

namespace {

std::unique_ptr<SliceReader> open_in_mm(const std::filesystem::path& path, const ReadOptions& options) {
    switch (format_of(path)) {
        case Format::nrrd: return open_nrrd(path);
        case Format::nifti: return open_nifti(path);
        case Format::inv3: return open_inv3(path);
        case Format::dicom: return open_dicom(path, options);
        case Format::none: break;
    }
    throw Error(
        fmt::format("{}: not a supported volume; use a DICOM folder, zip or file, .nrrd, .nhdr, .nii, .nii.gz, .hdr "
                    "with .img, or .inv3",
                    path.string()));
}

}  // namespace

std::unique_ptr<SliceReader> open_volume(const std::filesystem::path& path, const ReadOptions& options) {
    std::unique_ptr<SliceReader> reader = open_in_mm(path, options);
    ScanVolume& about = reader->about;
    if (!options.unit) return reader;
    const double scale = metres_in(*options.unit) / metres_in("mm");
    if (about.unit_stated && scale != 1.0)
        throw Error(fmt::format("{}: the file states its unit of length; leave out --unit", path.string()));
    about.map.step *= scale;
    about.map.origin *= scale;
    about.unit_stated = true;
    check_map(about.map, path.string());
    return reader;
}

ScanVolume read_volume(const std::filesystem::path& path, const ReadOptions& options) {
    return read_all(*open_volume(path, options));
}

}  // namespace tactus::volume

// SPDX-License-Identifier: Apache-2.0
// From DICOM images to a volume: which belong together, in which order, and where they lie.
#include "assets/volume/dicom_images.hpp"
#include "assets/volume/readers.hpp"
#include "dsp/core/error.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

namespace tactus {

namespace {

using Images = std::vector<DicomImage>;
constexpr std::size_t most_files = 100'000;

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(
             folder, std::filesystem::directory_options::skip_permission_denied)) {
        if (!entry.is_regular_file() || !is_dicom_file(entry.path())) continue;
        files.push_back(entry.path());
        if (files.size() > most_files)
            throw Error(fmt::format("{}: more than {} DICOM files; name the folder of one examination", folder.string(),
                                    most_files));
    }
    std::sort(files.begin(), files.end());
    return files;
}

// Those of a folder, or of a file; of a file with one image also its neighbours of the same series.
Images collect(const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) {
        Images own = dicom_images(path);
        if (own.empty()) throw Error(fmt::format("{}: holds no picture that can be read as DICOM", path.string()));
        if (own.size() > 1) return own;
        const auto folder = std::filesystem::absolute(path).parent_path();
        Images all;
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (!entry.is_regular_file() || !is_dicom_file(entry.path())) continue;
            Images found = dicom_images(entry.path());
            if (!found.empty() && found.front().series == own.front().series)
                all.insert(all.end(), found.begin(), found.end());
        }
        std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.file < b.file; });
        return all;
    }
    Images all;
    for (const auto& file : files_in(path)) {
        Images found = dicom_images(file);
        all.insert(all.end(), found.begin(), found.end());
    }
    if (all.empty()) throw Error(fmt::format("{}: holds no DICOM pictures", path.string()));
    return all;
}

// The images of the one series that was asked for, or of the only one. Scout views do not count as one.
Images choose(Images all, const std::string& wanted, const std::string& place) {
    std::map<std::string, Images> series;
    for (DicomImage& image : all) series[image.series].push_back(std::move(image));
    std::string list;
    std::vector<std::string> fitting;
    for (const auto& [uid, images] : series) {
        list += fmt::format("\n  {}  {} {} \"{}\"{}", uid, images.size(), images.size() == 1 ? "image" : "images",
                            images.front().description, images.front().is_localizer ? " (scout view)" : "");
        if (wanted.empty() ? !images.front().is_localizer : uid.ends_with(wanted)) fitting.push_back(uid);
    }
    if (fitting.size() == 1) return std::move(series[fitting.front()]);
    if (wanted.empty())
        throw Error(fmt::format("{}: holds {} series; choose one with --series UID:{}", place, series.size(), list));
    throw Error(fmt::format("{}: --series {} names {} of its {} series:{}", place, wanted, fitting.size(),
                            series.size(), list));
}

std::string where(const DicomImage& image) {
    return image.frame > 0 ? fmt::format("{} frame {}", image.file.filename().string(), image.frame + 1)
                           : image.file.filename().string();
}

// Throws unless all images have one size, spacing and orientation.
void check_alike(const Images& images, const std::string& place) {
    const DicomImage& first = images.front();
    for (const DicomImage& image : images) {
        const std::string name = where(image);
        if (!image.position || glm::length(image.along_row) < 0.5 || glm::length(image.along_column) < 0.5)
            throw Error(fmt::format("{}: {} does not say where in the patient it lies (image position and orientation)",
                                    place, name));
        if (!(image.row_spacing > 0.0) || !(image.column_spacing > 0.0))
            throw Error(fmt::format("{}: {} does not give its pixel spacing", place, name));
        if (image.rows != first.rows || image.columns != first.columns)
            throw Error(
                fmt::format("{}: images of different size in one series: {} has {} x {}, {} has {} x {}; take out "
                            "those that do not belong",
                            place, where(first), first.columns, first.rows, name, image.columns, image.rows));
        if (glm::length(image.along_row - first.along_row) + glm::length(image.along_column - first.along_column) >
            1e-3)
            throw Error(fmt::format("{}: {} and {} are oriented differently; take out those that do not belong", place,
                                    where(first), name));
        if (std::abs(image.row_spacing - first.row_spacing) + std::abs(image.column_spacing - first.column_spacing) >
            1e-4)
            throw Error(fmt::format("{}: {} and {} differ in pixel spacing", place, where(first), name));
    }
    const double cosine = glm::dot(glm::normalize(first.along_row), glm::normalize(first.along_column));
    if (std::abs(cosine) > 1e-3) throw Error(fmt::format("{}: rows and columns are not square to each other", place));
}

struct Slices {
    Images images;               // ascending along the normal
    std::vector<double> height;  // mm along the normal
};

Slices in_order(Images images, const std::string& place) {
    const Vec3 normal = glm::normalize(glm::cross(images.front().along_row, images.front().along_column));
    const auto height = [&](const DicomImage& image) { return glm::dot(normal, *image.position); };
    std::stable_sort(images.begin(), images.end(), [&](const auto& a, const auto& b) { return height(a) < height(b); });
    Slices slices;
    for (DicomImage& image : images) {
        const double h = height(image);
        if (!slices.height.empty() && h - slices.height.back() < 1e-3) {
            const DicomImage& before = slices.images.back();
            if (image.file == before.file || dicom_samples({image}) != dicom_samples({before}))
                throw Error(
                    fmt::format("{}: two different images at one place ({} and {}): several phases or "
                                "reconstructions in one series; keep the files of one",
                                place, where(before), where(image)));
            continue;
        }
        slices.height.push_back(h);
        slices.images.push_back(std::move(image));
    }
    if (slices.images.size() < 2) throw Error(fmt::format("{}: one slice is no volume", place));
    return slices;
}

double median_gap(const std::vector<double>& height) {
    std::vector<double> gaps;
    for (std::size_t n = 1; n < height.size(); ++n) gaps.push_back(height[n] - height[n - 1]);
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2), gaps.end());
    return gaps[gaps.size() / 2];
}

// A few gaps of just two or three slices between even ones: slices are missing, and nobody should invent them.
void check_complete(const Slices& slices, const std::string& place) {
    const double usual = median_gap(slices.height);
    std::size_t wide = 0, at = 0;
    for (std::size_t n = 1; n < slices.height.size(); ++n) {
        const double times = (slices.height[n] - slices.height[n - 1]) / usual, whole = std::round(times);
        if (whole >= 2.0 && std::abs(times - whole) < 0.03) ++wide, at = n;
        else if (std::abs(times - 1.0) > 0.03) return;  // truly uneven
    }
    if (wide > 0 && wide <= std::max<std::size_t>(1, slices.height.size() / 10))
        throw Error(
            fmt::format("{}: slices are missing in {} {}, as between {} and {} ({:.2f} mm apart, elsewhere {:.2f} "
                        "mm); copy the series again",
                        place, wide, wide == 1 ? "place" : "places", where(slices.images[at - 1]),
                        where(slices.images[at]), slices.height[at] - slices.height[at - 1], usual));
}

// One slice of the result from four of the file that are unevenly spaced: a cubic with the slopes of a parabola.
void interpolate(const Slices& slices, const std::vector<float>& from, std::size_t each, double height, float* out) {
    const auto& h = slices.height;
    const auto above = std::upper_bound(h.begin() + 1, h.end() - 1, height);
    const std::size_t b = static_cast<std::size_t>(above - h.begin()), a = b - 1;
    const std::size_t before = a > 0 ? a - 1 : a, after = b + 1 < h.size() ? b + 1 : b;
    const double gap = h[b] - h[a], t = std::clamp((height - h[a]) / gap, 0.0, 1.0);
    const auto slope = [&](std::size_t n, std::size_t i, std::size_t low, std::size_t high) {
        const auto value = [&](std::size_t s) { return double(from[s * each + i]); };
        if (low == n) return (value(high) - value(n)) / (h[high] - h[n]);
        if (high == n) return (value(n) - value(low)) / (h[n] - h[low]);
        const double down = (value(n) - value(low)) / (h[n] - h[low]), up = (value(high) - value(n)) / (h[high] - h[n]);
        const double share = (h[n] - h[low]) / (h[high] - h[low]);
        return (1.0 - share) * down + share * up;
    };
    for (std::size_t i = 0; i < each; ++i) {
        const double y0 = from[a * each + i], y1 = from[b * each + i];
        const double m0 = slope(a, i, before, b) * gap, m1 = slope(b, i, a, after) * gap;
        out[i] =
            static_cast<float>(y0 + t * (m0 + t * (3.0 * (y1 - y0) - 2.0 * m0 - m1 + t * (2.0 * (y0 - y1) + m0 + m1))));
    }
}

std::vector<float> evened(const Slices& slices, const std::vector<float>& from, std::size_t each, int count,
                          double gap) {
    std::vector<float> values(each * static_cast<std::size_t>(count));
    for (int n = 0; n < count; ++n)
        interpolate(slices, from, each, slices.height.front() + n * gap, &values[each * static_cast<std::size_t>(n)]);
    return values;
}

std::vector<float> load(const Slices& slices, std::size_t each) {
    std::vector<float> values(slices.images.size() * each);
    std::map<std::filesystem::path, std::vector<std::size_t>> by_file;
    for (std::size_t n = 0; n < slices.images.size(); ++n) by_file[slices.images[n].file].push_back(n);
    for (const auto& [file, members] : by_file) {
        const Images all = dicom_images(file);
        const std::vector<float> frames = dicom_samples(all);
        for (const std::size_t n : members)
            std::copy_n(&frames[each * static_cast<std::size_t>(slices.images[n].frame)], each, &values[n * each]);
    }
    return values;
}

// Steps between slices may lean (a tilted gantry) but must lie on one line.
Vec3 line_through(const Slices& slices, const std::string& place) {
    const Vec3 start = *slices.images.front().position;
    const double all = slices.height.back() - slices.height.front();
    const Vec3 per_mm = (*slices.images.back().position - start) / all;
    for (std::size_t n = 0; n < slices.images.size(); ++n) {
        const Vec3 off = *slices.images[n].position - start - per_mm * (slices.height[n] - slices.height.front());
        if (glm::length(off) > 0.1)
            throw Error(fmt::format("{}: {} lies {:.2f} mm beside the line of the others", place,
                                    where(slices.images[n]), glm::length(off)));
    }
    return per_mm;
}

}  // namespace

bool is_dicom_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    char mark[132] = {};
    return file.read(mark, sizeof mark) && std::string_view(mark + 128, 4) == "DICM";
}

ScanVolume read_dicom(const std::filesystem::path& path, const ReadOptions& options) {
    const std::string place = path.string();
    Images chosen = choose(collect(path), options.series, place);
    check_alike(chosen, place);
    const std::size_t found = chosen.size();
    const Slices slices = in_order(std::move(chosen), place);
    check_complete(slices, place);
    const Vec3 per_mm = line_through(slices, place);

    ScanVolume volume;
    volume.format = "DICOM";
    volume.source = path.filename().empty() ? path.parent_path().filename().string() : path.filename().string();
    const DicomImage& first = slices.images.front();
    volume.encoding = first.syntax;
    const auto count = static_cast<int>(slices.images.size());
    const double all = slices.height.back() - slices.height.front(), mean = all / (count - 1);
    double shortest = all;
    for (std::size_t n = 1; n < slices.height.size(); ++n) {
        const double gap = slices.height[n] - slices.height[n - 1];
        shortest = std::min(shortest, gap);
        if (std::abs(gap - mean) > 0.01 * mean + 0.005) volume.uniform = false;
    }
    // Not finer than a quarter of the mean: one close pair must not multiply the volume.
    const double wanted = volume.uniform ? mean : std::max(shortest, 0.25 * mean);
    const int layers = volume.uniform ? count : static_cast<int>(std::lround(all / wanted)) + 1;
    const double gap = all / (layers - 1);
    volume.size = {first.columns, first.rows, layers};
    const std::size_t total = checked_count({first.columns, first.rows, std::max(layers, count)}, place);
    volume.map.step[0] = glm::normalize(first.along_row) * (first.column_spacing * 1e-3);
    volume.map.step[1] = glm::normalize(first.along_column) * (first.row_spacing * 1e-3);
    volume.map.step[2] = per_mm * (gap * 1e-3);
    volume.map.origin = *first.position * 1e-3;
    check_map(volume.map, place);

    const std::size_t each = total / static_cast<std::size_t>(std::max(layers, count));
    volume.values = load(slices, each);
    if (!volume.uniform) {
        volume.values = evened(slices, volume.values, each, layers, gap);
        volume.notes.push_back(
            fmt::format("slices {:.3g} mm apart at the closest and {:.3g} mm on the mean were "
                        "interpolated to {:.3g} mm",
                        shortest, mean, gap));
    }
    if (found > slices.images.size())
        volume.notes.push_back(fmt::format("{} images were there twice", found - slices.images.size()));
    if (first.is_inverted)
        volume.notes.push_back("MONOCHROME1: meant to be shown inverted; its values are taken as they are");
    settle_meaning(volume, false);
    const bool rescaled = first.has_rescale && (first.rescale_type.empty() || first.rescale_type == "HU");
    if (first.modality == "CT" && volume.hu == HuKind::scanner && rescaled && first.intercept != 0.0)
        volume.hu = HuKind::calibrated;
    if (first.has_rescale && !rescaled) volume.hu = HuKind::scanner;
    return volume;
}

}  // namespace tactus

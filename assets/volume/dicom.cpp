// SPDX-License-Identifier: Apache-2.0
// Builds a volume from DICOM images: selects the series, sorts the slices and finds their geometry.
#include "assets/volume/dicom_images.hpp"
#include "assets/volume/readers.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/volume/compact_slice.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>

namespace tactus::volume {

namespace {

using Images = std::vector<DicomImage>;
constexpr std::size_t max_slice_files = 100'000;
constexpr std::size_t mark_end = 132;  // bytes: preamble and mark

// Old files begin with their first element, of group 2 or 8: its tag, and a representation or a short length.
bool is_without_preamble(std::string_view start) {
    const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(start[n]); };
    if ((byte(0) != 2 && byte(0) != 8) || byte(1) != 0 || byte(3) != 0) return false;
    const auto is_capital = [&](std::size_t n) { return start[n] >= 'A' && start[n] <= 'Z'; };
    return (is_capital(4) && is_capital(5)) || (byte(5) == 0 && byte(6) == 0 && byte(7) == 0 && byte(4) > 0);
}

bool has_dicom_mark(std::string_view start) { return start.size() >= mark_end && start.substr(128, 4) == "DICM"; }

// The images in a zip. Images of one name get their number, so that they stay different files.
Images collect_zip(DicomReader& reader, const std::filesystem::path& path) {
    const auto archive = std::make_shared<const file::ZipFile>(path);
    Images all;
    std::set<std::string> names;
    for (file::ZipFile::Entry entry : archive->entries()) {
        if (entry.size < mark_end || !has_dicom_mark(archive->read(entry, mark_end)) ||
            entry.name.ends_with("/DICOMDIR"))
            continue;
        if (!names.insert(entry.name).second) entry.name += fmt::format("#{}", entry.index + 1);
        Images found = reader.images(archive, entry);
        all.insert(all.end(), found.begin(), found.end());
    }
    if (all.empty())
        throw Error(fmt::format("{}: the zip has no DICOM images; other files must be unpacked first", path.string()));
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.file < b.file; });
    return all;
}

// The images of a folder, a zip or a file. A file with a single image adds the other files of its series in the folder.
Images collect(DicomReader& reader, const std::filesystem::path& path) {
    // The first bytes of a DICOM file are free, so they may look like those of a zip.
    if (!std::filesystem::is_directory(path) && !is_dicom_file(path) && file::is_zip_file(path))
        return collect_zip(reader, path);
    if (!std::filesystem::is_directory(path)) {
        Images own = reader.images(path);
        if (own.empty()) throw Error(fmt::format("{}: no image can be read as DICOM", path.string()));
        if (own.size() > 1) return own;
        const auto folder = std::filesystem::absolute(path).parent_path();
        Images all;
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            leave_if_stopped();
            if (!entry.is_regular_file() || entry.path().filename() == "DICOMDIR" || !is_dicom_file(entry.path()))
                continue;
            Images found = reader.images(entry.path());
            if (!found.empty() && found.front().series == own.front().series)
                all.insert(all.end(), found.begin(), found.end());
        }
        std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.file < b.file; });
        return all;
    }
    Images all;
    for (const auto& file : dicom_files_in(path)) {
        leave_if_stopped();
        Images found = reader.images(file);
        all.insert(all.end(), found.begin(), found.end());
    }
    if (all.empty()) throw Error(fmt::format("{}: the folder has no DICOM images", path.string()));
    return all;
}

std::string where(const DicomImage& image) {
    return image.frame > 0 ? fmt::format("{} frame {}", image.file.filename().string(), image.frame + 1)
                           : image.file.filename().string();
}

// "3 scout views (a.dcm, b.dcm, ...)", or "1 colour image (c.dcm)".
std::string counted(const Images& images, const char* what) {
    std::string names;
    for (std::size_t n = 0; n < images.size() && n < 3; ++n) names += (n > 0 ? ", " : "") + where(images[n]);
    return fmt::format("{} {}{} ({}{})", images.size(), what, images.size() == 1 ? "" : "s", names,
                       images.size() > 3 ? ", ..." : "");
}

// Takes the images that are no slices, as `is_other` finds them, and notes them. Keeps all when nothing would be left.
void set_aside(Images& images, const char* what, const std::function<bool(const DicomImage&)>& is_other,
               std::vector<std::string>& notes) {
    Images others;
    std::ranges::copy_if(images, std::back_inserter(others), is_other);
    if (others.empty() || others.size() == images.size()) return;
    std::erase_if(images, is_other);
    notes.push_back("left out: " + counted(others, what));
}

std::string uid_and_count(const std::string& uid, const Images& images) {
    return fmt::format("{}, {} {}", uid, images.size(), images.size() == 1 ? "image" : "images");
}

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Whether the images are the even slices of one scan, as when an archive split it over several series.
bool is_one_scan(const Images& images) {
    const DicomImage& first = images.front();
    const Vec3 across = glm::cross(first.along_row, first.along_column);
    if (images.size() < 4 || !first.position || glm::length(across) < 0.5) return false;
    std::vector<double> heights, gaps;
    for (const DicomImage& image : images) {
        if (!image.position || image.rows != first.rows || image.columns != first.columns ||
            glm::length(image.along_row - first.along_row) + glm::length(image.along_column - first.along_column) >
                1e-3 ||
            std::abs(image.row_spacing - first.row_spacing) > 1e-4)
            return false;
        heights.push_back(glm::dot(glm::normalize(across), *image.position));
    }
    std::ranges::sort(heights);
    for (std::size_t n = 1; n < heights.size(); ++n) gaps.push_back(heights[n] - heights[n - 1]);
    const double middle = median_of(gaps);
    return std::ranges::all_of(gaps, [&](double gap) { return std::abs(gap - middle) < 0.1 * middle; });
}

// The words between commas.
std::vector<std::string> wanted_series(const std::string& list) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at <= list.size() && !list.empty();) {
        const std::size_t end = std::min(list.find(',', at), list.size());
        words.push_back(list.substr(at, end - at));
        at = end + 1;
    }
    return words;
}

// The images of the selected series, or of the only one. Scout views are not counted. Everything that is left out is noted.
Images choose(Images all, const std::string& wanted, const std::string& place, std::vector<std::string>& notes) {
    if (std::ranges::all_of(all, &DicomImage::is_colour))
        throw Error(fmt::format("{}: {} holds colour images, which are no CT", place, where(all.front())));
    set_aside(all, "colour image", [](const DicomImage& image) { return image.is_colour; }, notes);
    std::map<std::string, Images> series;
    for (DicomImage& image : all) series[image.series].push_back(std::move(image));
    std::string list;
    std::vector<std::string> fitting;
    std::size_t positions = 0;
    const auto is_scout = [](const Images& images) { return std::ranges::all_of(images, &DicomImage::is_localizer); };
    for (const auto& [uid, images] : series) {
        list += fmt::format("\n  {}  {} {} \"{}\"{}", uid, images.size(), images.size() == 1 ? "image" : "images",
                            images.front().description, is_scout(images) ? " (scout view)" : "");
        if (wanted.empty() && !is_scout(images)) fitting.push_back(uid);
        positions += images.front().position.has_value();
    }
    for (const std::string& word : wanted_series(wanted)) {
        std::vector<std::string> matching;
        for (const auto& [uid, images] : series)
            if (uid.ends_with(word)) matching.push_back(uid);
        if (matching.size() != 1 || std::ranges::find(fitting, matching.front()) != fitting.end())
            throw Error(fmt::format("{}: --series {} matches {} of {} series{}:{}", place, word, matching.size(),
                                    series.size(), matching.size() == 1 ? ", and is named twice" : "", list));
        fitting.push_back(matching.front());
    }
    // Documents and captures of a screen lie nowhere in the patient.
    if (wanted.empty() && fitting.size() > 1 && positions > 0)
        std::erase_if(fitting, [&](const std::string& uid) {
            return std::ranges::none_of(series[uid],
                                        [](const DicomImage& image) { return image.position.has_value(); });
        });
    if (fitting.size() != 1 && wanted.empty()) {
        Images together;
        for (const std::string& uid : fitting) together.insert(together.end(), series[uid].begin(), series[uid].end());
        const bool is_split = fitting.size() > 1 && is_one_scan(together);
        throw Error(
            fmt::format("{}: there are {} series; {} with --series {}:{}", place, series.size(),
                        is_split ? "their slices follow each other as those of one scan: join them" : "choose one",
                        is_split ? fmt::format("{}", fmt::join(fitting, ",")) : "UID", list));
    }
    Images chosen;
    std::string joined;
    for (const std::string& uid : fitting) {
        joined += (joined.empty() ? "" : "; ") + uid_and_count(uid, series[uid]);
        std::ranges::move(series[uid], std::back_inserter(chosen));
    }
    if (fitting.size() > 1) notes.push_back(fmt::format("{} series were joined: {}", fitting.size(), joined));
    for (const auto& [uid, images] : series)
        if (std::ranges::find(fitting, uid) == fitting.end())
            notes.push_back(fmt::format("left out: series {} \"{}\"{}", uid_and_count(uid, images),
                                        images.front().description, is_scout(images) ? ", a scout view" : ""));
    set_aside(chosen, "scout view", [](const DicomImage& image) { return image.is_localizer; }, notes);
    set_aside(chosen, "image without a position", [](const DicomImage& image) { return !image.position; }, notes);
    return chosen;
}

// Frames of one file that states one position for all of them, as cone-beam scanners write: they follow each other along
// the normal by the stated spacing of slices, or by their thickness.
void stack_frames(Images& images, const std::string& place, std::vector<std::string>& notes) {
    DicomImage& first = images.front();
    const bool is_one_file = std::ranges::all_of(images, [&](const DicomImage& image) {
        return image.file == first.file && image.is_one_of_several && !image.has_own_position;
    });
    if (!is_one_file || images.size() < 2 || glm::length(first.along_row) < 0.5 ||
        glm::length(first.along_column) < 0.5)
        return;
    const bool has_spacing = first.slice_spacing != 0.0;
    const double spacing = has_spacing ? first.slice_spacing : first.slice_thickness;
    if (!(std::abs(spacing) > 0.0))
        throw Error(
            fmt::format("{}: its {} frames have one position and no spacing between slices; add it to the file "
                        "(SpacingBetweenSlices), or export one file per slice",
                        place, images.size()));
    const bool has_position = first.position.has_value();
    const Vec3 start = first.position.value_or(Vec3(0.0)),
               normal = glm::normalize(glm::cross(first.along_row, first.along_column));
    for (DicomImage& image : images) image.position = start + normal * (spacing * image.frame);
    notes.push_back(
        fmt::format("the file states {} for its {} frames: they were stacked along their normal by the {} of "
                    "{:.4g} mm; check which end is up",
                    has_position ? "one position" : "no position", images.size(),
                    has_spacing ? "spacing between slices" : "slice thickness", std::abs(spacing)));
}

std::string unit_of(const DicomImage& image) { return image.rescale_type.empty() ? "HU" : image.rescale_type; }

// Throws unless all images have one size, spacing, orientation and unit of values.
void check_alike(const Images& images, const std::string& place) {
    const DicomImage& first = images.front();
    for (const DicomImage& image : images) {
        const std::string name = where(image);
        if (!image.position || glm::length(image.along_row) < 0.5 || glm::length(image.along_column) < 0.5)
            throw Error(fmt::format("{}: {} has no image position and orientation", place, name));
        if (!(image.row_spacing > 0.0) || !(image.column_spacing > 0.0))
            throw Error(fmt::format("{}: {} has no pixel spacing", place, name));
        if (image.rows != first.rows || image.columns != first.columns)
            throw Error(
                fmt::format("{}: images of different size in one series: {} has {} x {}, {} has {} x {}; remove the "
                            "images that do not belong",
                            place, where(first), first.columns, first.rows, name, image.columns, image.rows));
        if (glm::length(image.along_row - first.along_row) + glm::length(image.along_column - first.along_column) >
            1e-3)
            throw Error(fmt::format("{}: {} and {} have different orientations; remove the images that do not belong",
                                    place, where(first), name));
        if (std::abs(image.row_spacing - first.row_spacing) + std::abs(image.column_spacing - first.column_spacing) >
            1e-4)
            throw Error(fmt::format("{}: {} and {} differ in pixel spacing", place, where(first), name));
        if (image.modality != first.modality)
            throw Error(fmt::format("{}: {} is {} and {} is {} (Modality); remove the images that do not belong", place,
                                    where(first), first.modality, name, image.modality));
        if (image.has_zero_slope != first.has_zero_slope)
            throw Error(fmt::format("{}: {} states a RescaleSlope of 0, and {} another; export the series again", place,
                                    where(image.has_zero_slope ? image : first),
                                    where(image.has_zero_slope ? first : image)));
        if (image.has_rescale != first.has_rescale)
            throw Error(
                fmt::format("{}: {} states a rescale to HU (RescaleSlope, RescaleIntercept) and {} none, so that "
                            "their values do not compare; export the series again",
                            place, where(image.has_rescale ? image : first), where(image.has_rescale ? first : image)));
        if (unit_of(image) != unit_of(first))
            throw Error(
                fmt::format("{}: the values of {} are in {} and those of {} in {} (RescaleType); remove the images "
                            "that do not belong",
                            place, where(first), unit_of(first), name, unit_of(image)));
    }
    const double cosine = glm::dot(glm::normalize(first.along_row), glm::normalize(first.along_column));
    if (std::abs(cosine) > 1e-3) throw Error(fmt::format("{}: rows and columns are not orthogonal", place));
}

struct Slices {
    Images images;  // ascending along the normal
    std::vector<double> height;  // mm along the normal
};

Slices in_order(DicomReader& reader, Images images, const std::string& place) {
    const Vec3 normal = glm::normalize(glm::cross(images.front().along_row, images.front().along_column));
    const auto height = [&](const DicomImage& image) { return glm::dot(normal, *image.position); };
    std::stable_sort(images.begin(), images.end(), [&](const auto& a, const auto& b) { return height(a) < height(b); });
    Slices slices;
    for (DicomImage& image : images) {
        const double h = height(image);
        if (!slices.height.empty() && h - slices.height.back() < 1e-3) {
            const DicomImage& before = slices.images.back();
            if (image.file == before.file || reader.samples(image).values != reader.samples(before).values)
                throw Error(
                    fmt::format("{}: two different images at the same position ({} and {}): the series has several "
                                "phases or reconstructions; keep the files of one",
                                place, where(before), where(image)));
            continue;
        }
        slices.height.push_back(h);
        slices.images.push_back(std::move(image));
    }
    if (slices.images.size() < 2) throw Error(fmt::format("{}: one slice is not a volume", place));
    return slices;
}

// Gaps that are about two or more of the gaps around them: slices are missing there. One or two wide gaps in a row are
// isolated; more are a part of the scan with another spacing, as in heads that are scanned in two parts. Returns the
// indices of the upper slices.
std::vector<std::size_t> missing_at(const std::vector<double>& height) {
    std::vector<double> gaps;
    for (std::size_t n = 1; n < height.size(); ++n) gaps.push_back(height[n] - height[n - 1]);
    std::vector<std::size_t> missing;
    constexpr std::size_t reach = 5, max_in_row = 2;
    for (std::size_t first = 0; first < gaps.size();) {
        std::size_t end = first + 1;
        bool is_isolated = false;
        // The longest row of gaps that are all wide beside their surroundings on both sides.
        for (std::size_t count = max_in_row; count > 0 && !is_isolated; --count) {
            end = first + count;
            if (end > gaps.size()) continue;
            // At an end of the scan only a single gap is isolated.
            if (count > 1 && (first == 0 || end == gaps.size())) continue;
            std::vector<double> before(gaps.begin() + static_cast<std::ptrdiff_t>(first > reach ? first - reach : 0),
                                       gaps.begin() + static_cast<std::ptrdiff_t>(first)),
                after(gaps.begin() + static_cast<std::ptrdiff_t>(end),
                      gaps.begin() + static_cast<std::ptrdiff_t>(std::min(end + reach, gaps.size())));
            if (before.empty() && after.empty()) continue;
            if (before.size() + after.size() < 2) continue;
            // The gaps beside the row decide: where the spacing changes, one side is as wide.
            double local = 0.0;
            for (const std::vector<double>* side : {&before, &after})
                if (!side->empty()) local = std::max(local, median_of(*side));
            if (!before.empty() && before.back() > 1.5 * local) continue;
            if (!after.empty() && after.front() > 1.5 * local) continue;
            std::size_t even = 0;
            for (const std::vector<double>* side : {&before, &after})
                even += static_cast<std::size_t>(
                    std::ranges::count_if(*side, [&](double gap) { return std::abs(gap - local) < 0.4 * local; }));
            const auto is_wide = [&](double gap) {
                const double times = gap / local, whole = std::round(times);
                return whole >= 2.0 && std::abs(times - whole) <= 0.1 * times;
            };
            is_isolated = 4 * even >= 3 * (before.size() + after.size()) &&
                          std::all_of(gaps.begin() + static_cast<std::ptrdiff_t>(first),
                                      gaps.begin() + static_cast<std::ptrdiff_t>(end), is_wide);
        }
        if (is_isolated)
            for (std::size_t n = first; n < end; ++n) missing.push_back(n + 1);
        else end = first + 1;
        first = end;
    }
    return missing;
}

// Throws when slices are missing, unless they are to be interpolated. Returns a note.
std::string check_complete(const Slices& slices, const std::string& place, bool fills) {
    const std::vector<std::size_t> missing = missing_at(slices.height);
    if (missing.empty()) return {};
    std::string places;
    for (std::size_t n = 0; n < missing.size() && n < 3; ++n) {
        const std::size_t at = missing[n];
        places += fmt::format("{}between {} and {} (at {:.2f} and {:.2f} mm, {:.2f} mm apart)", n > 0 ? ", " : "",
                              where(slices.images[at - 1]), where(slices.images[at]), slices.height[at - 1],
                              slices.height[at], slices.height[at] - slices.height[at - 1]);
    }
    if (missing.size() > 3) places += ", ...";
    const std::string text = fmt::format("slices are missing in {} {}: {}", missing.size(),
                                         missing.size() == 1 ? "place" : "places", places);
    if (fills) return text + "; they were interpolated";
    throw Error(fmt::format("{}: {}; copy the series again, or interpolate there with --fill-gaps", place, text));
}

// Decodes the slices of a series on request. A multi-frame file is decoded once and cached.
class Samples {
public:
    Samples(DicomReader& reader, const Slices& slices, std::size_t each)
        : reader_(reader), slices_(slices), each_(each) {}

    std::size_t padded = 0;  // samples so far
    double padding = 0.0;
    bool is_padding_stated = true;

    void read(std::size_t n, std::span<float> values) {
        const DicomImage& image = slices_.images[n];
        if (!image.is_one_of_several) {
            const std::vector<float> samples = decoded(image);
            std::copy_n(samples.begin(), each_, values.begin());
            return;
        }
        std::vector<CompactSlice>& frames = frames_[image.file];
        if (frames.empty()) {
            const std::vector<float> samples = decoded(image);
            for (std::size_t at = 0; at < samples.size(); at += each_)
                frames.emplace_back(std::span(samples).subspan(at, each_));
        }
        frames.at(static_cast<std::size_t>(image.frame)).copy(0, values);
    }

private:
    std::vector<float> decoded(const DicomImage& image) {
        DicomSamples read = reader_.samples(image);
        if (read.values.size() < each_ || read.values.size() % each_ != 0)
            throw Error(fmt::format("{}: the number of samples differs from the header", image.file.string()));
        if (read.padded > 0 && counted_.insert(image.file).second) {
            padded += read.padded;
            padding = read.padding;
            is_padding_stated = read.is_padding_stated;
        }
        return std::move(read.values);
    }

    DicomReader& reader_;
    const Slices& slices_;
    std::size_t each_;
    std::map<std::filesystem::path, std::vector<CompactSlice>> frames_;
    std::set<std::filesystem::path> counted_;
};

// Evenly spaced slices by cubic Hermite interpolation over four slices of the file, with slopes from parabolas.
class ResampledSlices {
public:
    ResampledSlices(const Slices& slices, std::size_t each) : h_(slices.height), each_(each) {}

    void read(double height, Samples& samples, std::span<float> out) {
        const auto above = std::upper_bound(h_.begin() + 1, h_.end() - 1, height);
        const std::size_t b = static_cast<std::size_t>(above - h_.begin()), a = b - 1;
        const std::size_t before = a > 0 ? a - 1 : a, after = b + 1 < h_.size() ? b + 1 : b;
        std::erase_if(slices_, [&](const auto& entry) { return entry.first < before || entry.first > after; });
        for (std::size_t n = before; n <= after; ++n)
            if (std::vector<float>& slice = slices_[n]; slice.empty()) {
                slice.resize(each_);
                samples.read(n, slice);
            }
        const double gap = h_[b] - h_[a], t = std::clamp((height - h_[a]) / gap, 0.0, 1.0);
        std::array<const float*, 4> from{};
        for (std::size_t n = before; n <= after; ++n) from[n - before] = slices_[n].data();
        const auto slope = [&](std::size_t n, std::size_t low, std::size_t high, std::size_t i) {
            const auto value = [&](std::size_t s) { return double(from[s - before][i]); };
            if (low == n) return (value(high) - value(n)) / (h_[high] - h_[n]);
            if (high == n) return (value(n) - value(low)) / (h_[n] - h_[low]);
            const double down = (value(n) - value(low)) / (h_[n] - h_[low]),
                         up = (value(high) - value(n)) / (h_[high] - h_[n]);
            const double share = (h_[n] - h_[low]) / (h_[high] - h_[low]);
            return (1.0 - share) * down + share * up;
        };
        for (std::size_t i = 0; i < each_; ++i) {
            const double y0 = from[a - before][i], y1 = from[b - before][i];
            const double m0 = slope(a, before, b, i) * gap, m1 = slope(b, a, after, i) * gap;
            const double value =
                y0 + t * (m0 + t * (3.0 * (y1 - y0) - 2.0 * m0 - m1 + t * (2.0 * (y0 - y1) + m0 + m1)));
            // A cubic overshoots at edges; densities that no sample has are artefacts.
            double low = y0, high = y0;
            for (std::size_t n = before; n <= after; ++n) {
                low = std::min(low, double(from[n - before][i]));
                high = std::max(high, double(from[n - before][i]));
            }
            out[i] = static_cast<float>(std::clamp(value, low, high));
        }
    }

private:
    const std::vector<double>& h_;
    std::size_t each_;
    std::map<std::size_t, std::vector<float>> slices_;
};

// Slice positions may be oblique (a tilted gantry) but must be collinear.
Vec3 line_through(const Slices& slices, const std::string& place) {
    const Vec3 start = *slices.images.front().position;
    const double all = slices.height.back() - slices.height.front();
    const Vec3 per_mm = (*slices.images.back().position - start) / all;
    for (std::size_t n = 0; n < slices.images.size(); ++n) {
        const Vec3 off = *slices.images[n].position - start - per_mm * (slices.height[n] - slices.height.front());
        if (glm::length(off) > 0.1)
            throw Error(fmt::format("{}: {} lies {:.2f} mm off the line of the other slices", place,
                                    where(slices.images[n]), glm::length(off)));
    }
    return per_mm;
}

class DicomSlices final : public SliceReader {
public:
    DicomSlices(const std::filesystem::path& path, const ReadOptions& options) {
        const std::string place = path.string();
        Images chosen = choose(collect(reader_, path), options.series, place, about.notes);
        stack_frames(chosen, place, about.notes);
        check_alike(chosen, place);
        const std::size_t found = chosen.size();
        slices_ = in_order(reader_, std::move(chosen), place);
        if (std::string filled = check_complete(slices_, place, options.fill_gaps); !filled.empty())
            about.notes.push_back(std::move(filled));
        const Vec3 per_mm = line_through(slices_, place);

        about.format = "DICOM";
        about.source = path.filename().empty() ? path.parent_path().filename().string() : path.filename().string();
        const DicomImage& first = slices_.images.front();
        about.encoding = first.syntax;
        const auto count = static_cast<int>(slices_.images.size());
        const double all = slices_.height.back() - slices_.height.front(), mean = all / (count - 1);
        double shortest = all;
        for (std::size_t n = 1; n < slices_.height.size(); ++n) {
            const double gap = slices_.height[n] - slices_.height[n - 1];
            shortest = std::min(shortest, gap);
            if (std::abs(gap - mean) > 0.01 * mean + 0.005) about.uniform = false;
        }
        // At least a quarter of the mean spacing: one close pair of slices must not multiply the volume.
        const double wanted = about.uniform ? mean : std::max(shortest, 0.25 * mean);
        const int layers = about.uniform ? count : static_cast<int>(std::lround(all / wanted)) + 1;
        gap_ = all / (layers - 1);
        about.size = {first.columns, first.rows, layers};
        checked_count({first.columns, first.rows, std::max(layers, count)}, place);
        about.map.step[0] = glm::normalize(first.along_row) * (first.column_spacing * 1e-3);
        about.map.step[1] = glm::normalize(first.along_column) * (first.row_spacing * 1e-3);
        about.map.step[2] = per_mm * (gap_ * 1e-3);
        about.map.origin = *first.position * 1e-3;
        check_map(about.map, place);
        if (!about.uniform)
            about.notes.push_back(fmt::format(
                "slices with a spacing of at least {:.3g} mm, {:.3g} mm on average, were interpolated to {:.3g} mm",
                shortest, mean, gap_));
        if (found > slices_.images.size())
            about.notes.push_back(fmt::format("{} duplicate images ignored", found - slices_.images.size()));
        if (std::ranges::any_of(slices_.images, &DicomImage::has_decimal_commas))
            about.notes.push_back(
                "numbers are written with decimal commas, against the standard; they were read as such");
        if (first.has_zero_slope) about.notes.push_back("RescaleSlope is 0, against the standard; it was read as 1");
        if (first.is_inverted)
            about.notes.push_back("MONOCHROME1: only the display is inverted; the values are not changed");
        samples_.emplace(reader_, slices_, slice_size());
        resampled_.emplace(slices_, slice_size());
    }

    void read(int k, std::span<float> values) override {
        if (about.uniform) samples_->read(static_cast<std::size_t>(k), values);
        else resampled_->read(slices_.height.front() + k * gap_, *samples_, values);
    }

    void settle(const Tally& tally) override {
        const bool is_segmentation = slices_.images.front().modality == "SEG";
        settle_meaning(about, tally, is_segmentation);
        // Also when most voxels are in the segment.
        if (is_segmentation && tally.whole && tally.high <= 1.0f)
            about.kind = VolumeKind::labels, about.hu = HuKind::none;
        if (samples_->padded > 0)
            about.notes.push_back(fmt::format("{} samples are padding ({:g}{}); they were read as air",
                                              samples_->padded, samples_->padding,
                                              samples_->is_padding_stated ? "" : ", the only value above 32767"));
        samples_->padded = 0;
        const DicomImage& first = slices_.images.front();
        const bool rescaled = first.has_rescale && (first.rescale_type.empty() || first.rescale_type == "HU");
        if (first.modality == "CT" && about.hu == HuKind::scanner && rescaled && first.intercept != 0.0)
            about.hu = HuKind::calibrated;
        // These modalities measure other quantities, whatever their range.
        constexpr std::array<std::string_view, 4> others{"MR", "PT", "NM", "US"};
        const bool is_other = std::ranges::find(others, std::string_view(first.modality)) != others.end();
        if ((first.has_rescale && !rescaled) || (is_other && about.hu != HuKind::none)) about.hu = HuKind::scanner;
    }

private:
    DicomReader reader_;
    Slices slices_;
    double gap_ = 0.0;  // mm
    std::optional<Samples> samples_;
    std::optional<ResampledSlices> resampled_;
};

}  // namespace

bool is_dicom_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string start(mark_end, '\0');
    return file.read(start.data(), mark_end) && (has_dicom_mark(start) || is_without_preamble(start));
}

std::vector<std::filesystem::path> dicom_files_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(
             folder, std::filesystem::directory_options::skip_permission_denied)) {
        // A DICOMDIR contains no images.
        if (!entry.is_regular_file() || entry.path().filename() == "DICOMDIR" || !is_dicom_file(entry.path())) continue;
        files.push_back(entry.path());
        if (files.size() > max_slice_files)
            throw Error(fmt::format("{}: more than {} DICOM files; name the folder of one examination", folder.string(),
                                    max_slice_files));
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::unique_ptr<SliceReader> open_dicom(const std::filesystem::path& path, const ReadOptions& options) {
    return std::make_unique<DicomSlices>(path, options);
}

}  // namespace tactus::volume

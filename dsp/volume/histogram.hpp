// SPDX-License-Identifier: Apache-2.0
// Histograms and Otsu's threshold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::volume {

/// Counts of values in bins of equal width between minimum and maximum.
struct Histogram {
    double low = 0.0, high = 0.0;
    std::vector<std::uint64_t> counts;

    double width() const { return (high - low) / static_cast<double>(counts.size()); }
    double middle(std::size_t bin) const { return low + (static_cast<double>(bin) + 0.5) * width(); }
};
Histogram histogram_of(std::span<const float> values, std::size_t bins);
/// Returns empty bins between `low` and `high`, to be filled by add_values; values beyond count in the first or last
/// bin.
Histogram empty_histogram(double low, double high, std::size_t bins);
void add_values(Histogram& histogram, std::span<const float> values);

/// Otsu's threshold (1979) among the bins [first, end): it minimises the variance within both groups. Returns the
/// index of the first bin above it; `first` when all values are in one bin.
std::size_t otsu(const Histogram& histogram, std::size_t first = 0, std::size_t end = SIZE_MAX);

/// HU. A class whose mean is lower is air: air has -1000, lungs -900 on average, fat -100 to -50 (Buzug, Computed
/// Tomography, 2008, p. 475). The limit lies midway between lungs and fat.
inline constexpr double max_air_hu = -500.0;
/// HU. A class whose mean is lower is soft tissue: fat, muscle, blood and organs lie below 100 (Buzug), and voxels at
/// the surface of bone raise the mean of their class.
inline constexpr double max_soft_tissue_hu = 150.0;
/// HU. Denser voxels are metal: bone and enamel lie below. Fillings and implants are few, but so dense that Otsu's
/// method would give them a class of their own.
inline constexpr double min_metal_hu = 2700.0;

/// The split of HU into bone and the rest.
struct TissueSplit {
    double threshold = 0.0;  ///< HU; meaningful only if has_soft_tissue
    bool has_air = false;  ///< a class of air was split off first
    bool has_soft_tissue = false;  ///< the class below the threshold is soft tissue; else the split is within bone
};

/// Splits off bone by Otsu's method. While the lower class is air it is removed and the rest is split again. The number
/// of splits therefore follows from the scan: two with air, one in a block cut out of soft tissue. A fixed number would
/// split cortical from cancellous bone when there is no air. Metal does not count.
TissueSplit split_hu(const Histogram& histogram);

/// The same for uncalibrated numbers, in which air cannot be recognised: two splits, as a whole scan contains air.
double split_scanner_values(const Histogram& histogram);

/// Half the median of the values above zero: the surface of bone in a volume with zeros around it.
double half_of_median(const Histogram& histogram);

}  // namespace tactus::volume

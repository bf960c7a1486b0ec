// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/scan_volume.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus {

std::string_view name_of(HuKind kind) {
    switch (kind) {
        case HuKind::calibrated: return "calibrated";
        case HuKind::masked: return "masked";
        case HuKind::scanner: return "scanner";
        case HuKind::none: break;
    }
    return "none";
}

std::string_view name_of(VolumeKind kind) { return kind == VolumeKind::ct ? "ct" : "labels"; }

std::string_view name_of(Frame frame) { return frame == Frame::lps ? "LPS" : "RAS"; }

Vec3 ScanVolume::spacing() const {
    return {glm::length(map.step[0]), glm::length(map.step[1]), glm::length(map.step[2])};
}

double ScanVolume::tilt_deg() const {
    const Vec3 normal = glm::cross(map.step[0], map.step[1]);
    const double cosine = std::abs(glm::dot(glm::normalize(normal), glm::normalize(map.step[2])));
    return std::acos(std::min(cosine, 1.0)) * 57.29577951308232;
}

HuKind guess_hu(const ScanVolume& volume) {
    if (volume.values.empty()) return HuKind::scanner;
    if (*std::min_element(volume.values.begin(), volume.values.end()) <= -500.0f) return HuKind::calibrated;
    const auto& size = volume.size;
    std::size_t zeros = 0, border = 0, border_zeros = 0, n = 0;
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i, ++n) {
                const bool zero = volume.values[n] == 0.0f;
                zeros += zero;
                if (i == 0 || j == 0 || k == 0 || i == size[0] - 1 || j == size[1] - 1 || k == size[2] - 1)
                    ++border, border_zeros += zero;
            }
    return zeros * 2 > volume.values.size() && border_zeros * 100 >= border * 99 ? HuKind::masked : HuKind::scanner;
}

}  // namespace tactus

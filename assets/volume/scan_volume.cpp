// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/scan_volume.hpp"

#include "assets/volume/length_unit.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::volume {

std::string_view name_of(HuKind kind) {
    switch (kind) {
        case HuKind::calibrated: return "calibrated";
        case HuKind::masked: return "masked";
        case HuKind::scanner: return "scanner";
        case HuKind::none: break;
    }
    return "none";
}

bool are_hu(HuKind kind, double greatest) {
    return kind == HuKind::calibrated || (kind == HuKind::masked && greatest > 255.0);
}

std::string_view name_of(VolumeKind kind) {
    return kind == VolumeKind::ct ? "ct" : kind == VolumeKind::labels ? "labels" : "labels?";
}

std::string_view name_of(Frame frame) { return frame == Frame::lps ? "LPS" : "RAS"; }

Vec3 ScanVolume::spacing() const {
    return {glm::length(map.step[0]), glm::length(map.step[1]), glm::length(map.step[2])};
}

double ScanVolume::tilt_deg() const {
    const Vec3 normal = glm::cross(map.step[0], map.step[1]);
    const double cosine = std::abs(glm::dot(glm::normalize(normal), glm::normalize(map.step[2])));
    return std::acos(std::min(cosine, 1.0)) * 57.29577951308232;
}

std::string unit_question(const ScanVolume& volume) {
    if (volume.unit_stated) return {};
    const Vec3 h = volume.spacing() * 1e3;
    return unit_question("the scan", std::max({h.x * volume.size[0], h.y * volume.size[1], h.z * volume.size[2]}),
                         plausible_scan);
}

}  // namespace tactus::volume

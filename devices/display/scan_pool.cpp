// SPDX-License-Identifier: Apache-2.0
#include "devices/display/scan_pool.hpp"

#include "dsp/core/stop.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::display {

namespace {

constexpr int max_per_side = 512;

}  // namespace

GreyImage grey_image(const volume::Grid& grid, const GreyScale& scale) {
    GreyImage image;
    if (grid.values.size() != grid.count() || *std::ranges::min_element(grid.size) < 2) return image;
    std::array<int, 3> step{};
    std::array<int, 3>& size = image.size;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        step[axis] = (grid.size[axis] + max_per_side - 1) / max_per_side;
        size[axis] = (grid.size[axis] - 1) / step[axis] + 1;
    }
    std::vector<std::uint8_t>& grey = image.grey;
    grey.reserve(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
                 static_cast<std::size_t>(size[2]));
    for (int k = 0; k < size[2]; ++k) {
        leave_if_stopped();
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i) {
                const double value = static_cast<double>(grid.at(i * step[0], j * step[1], k * step[2]));
                const double share = (value - scale.black) / (scale.white - scale.black);
                grey.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0))));
            }
    }
    // Samples lie at the middle of texels.
    const Vec3 texels(size[0], size[1], size[2]), spacing = grid.spacing * Vec3(step[0], step[1], step[2]);
    image.to_texture = glm::translate(glm::scale(Mat4(1.0), 1.0 / (texels * spacing)), 0.5 * spacing - grid.origin);
    return image;
}

ScanPool::~ScanPool() {
    for (const Texture& scan : scans_)
        if (scan.name != 0) glDeleteTextures(1, &scan.name);
}

ScanPool::Scan ScanPool::make(const GreyImage& image) {
    if (image.empty()) return -1;
    Texture made{0, image.to_texture};
    glGenTextures(1, &made.name);
    glBindTexture(GL_TEXTURE_3D, made.name);
    for (const GLenum edge : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, edge, GL_CLAMP_TO_EDGE);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_R8, image.size[0], image.size[1], image.size[2], 0, GL_RED, GL_UNSIGNED_BYTE,
                 image.grey.data());
    glBindTexture(GL_TEXTURE_3D, 0);
    const auto free = std::ranges::find(scans_, 0u, &Texture::name);
    const auto place = free - scans_.begin();
    if (free == scans_.end()) scans_.push_back(made);
    else *free = made;
    return static_cast<Scan>(place);
}

void ScanPool::remove(Scan scan) {
    if (scan < 0) return;
    Texture& known = scans_[static_cast<std::size_t>(scan)];
    glDeleteTextures(1, &known.name);
    known.name = 0;
}

void ScanPool::bind(Scan scan) const {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, scan < 0 ? 0 : scans_[static_cast<std::size_t>(scan)].name);
}

}  // namespace tactus::display

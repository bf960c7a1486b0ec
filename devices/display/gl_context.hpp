// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tactus::display {

/// A current OpenGL 3.3 core context without a surface, for as long as it lives. Throws Error when there is none.
class SurfacelessContext {
public:
    SurfacelessContext();
    ~SurfacelessContext();
    SurfacelessContext(const SurfacelessContext&) = delete;
    SurfacelessContext& operator=(const SurfacelessContext&) = delete;

private:
    void* display_ = nullptr;
    void* context_ = nullptr;
};

}  // namespace tactus::display

// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tactus::display {

/// A surfaceless OpenGL 3.3 core context, current during its lifetime. Throws Error when it cannot be created.
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

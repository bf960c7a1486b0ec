// SPDX-License-Identifier: Apache-2.0
// A program of shaders.
#pragma once

#include <utility>

namespace tactus::display {

/// A linked pair of shaders. The context it was made in must be current whenever it is used or destroyed.
class GlProgram {
public:
    /// Throws Error with what the driver says.
    GlProgram(const char* vertex, const char* fragment);
    ~GlProgram();
    GlProgram(GlProgram&& other) noexcept : program_(std::exchange(other.program_, 0)) {}
    GlProgram& operator=(GlProgram&&) = delete;

    void use() const;
    /// Location of a uniform, −1 for none.
    int uniform(const char* name) const;

private:
    unsigned program_ = 0;
};

}  // namespace tactus::display

// SPDX-License-Identifier: Apache-2.0
// The few things of OpenGL that every drawing file needs. Inside devices/display only.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <utility>

namespace tactus {

/// A linked pair of shaders. The context it was made in must be current whenever it is used or destroyed.
class GlProgram {
public:
    /// Throws Error with what the driver says.
    GlProgram(const char* vertex, const char* fragment);
    ~GlProgram() { glDeleteProgram(program_); }
    GlProgram(GlProgram&& other) noexcept : program_(std::exchange(other.program_, 0)) {}
    GlProgram& operator=(GlProgram&&) = delete;

    void use() const { glUseProgram(program_); }
    GLint uniform(const char* name) const { return glGetUniformLocation(program_, name); }

private:
    GLuint program_ = 0;
};

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
#include "devices/display/gl_program.hpp"

#include "dsp/core/error.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace tactus::display {
namespace {

GLuint compile(GLenum kind, const char* source) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == 0) {
        std::array<char, 1024> log{};
        glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()) - 1, nullptr, log.data());
        glDeleteShader(shader);
        throw Error(fmt::format("the graphics driver refuses a shader: {}", log.data()));
    }
    return shader;
}

}  // namespace

bool is_software_driver() {
    const GLubyte* const name = glGetString(GL_RENDERER);
    const std::string_view driver = name ? reinterpret_cast<const char*>(name) : "";
    return driver.find("llvmpipe") != std::string_view::npos || driver.find("softpipe") != std::string_view::npos;
}

GlProgram::GlProgram(const char* vertex, const char* fragment) : program_(glCreateProgram()) {
    for (const auto& [kind, source] : {std::pair{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}}) {
        const GLuint shader = compile(static_cast<GLenum>(kind), source);
        glAttachShader(program_, shader);
        glDeleteShader(shader);  // lives on as long as the program
    }
    glLinkProgram(program_);
    GLint good = 0;
    glGetProgramiv(program_, GL_LINK_STATUS, &good);
    if (good == 0) throw Error("the graphics driver cannot link a shader");
}

GlProgram::~GlProgram() { glDeleteProgram(program_); }

void GlProgram::use() const { glUseProgram(program_); }

int GlProgram::uniform(const char* name) const { return glGetUniformLocation(program_, name); }

}  // namespace tactus::display

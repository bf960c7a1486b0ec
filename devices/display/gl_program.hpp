// SPDX-License-Identifier: Apache-2.0
// A shader program, and the kind of driver that executes it.
#pragma once

#include <utility>

namespace tactus::display {

/// Returns true if the current context renders on the processor (Mesa's llvmpipe and softpipe).
bool is_software_driver();

/// A linked vertex and fragment shader. Its context must be current when it is used or destroyed.
class GlProgram {
public:
    /// Throws Error with the driver's message.
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

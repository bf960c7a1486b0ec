// SPDX-License-Identifier: Apache-2.0
#include "devices/display/gl_context.hpp"

#include "dsp/core/error.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

namespace tactus::display {
namespace {

[[noreturn]] void fail(const char* step) {
    throw Error(fmt::format(
        "cannot draw pictures offscreen: {} failed (EGL error {:#x}); install libegl-mesa0 and libgl1-mesa-dri", step,
        eglGetError()));
}

}  // namespace

SurfacelessContext::SurfacelessContext() {
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY) fail("eglGetPlatformDisplay");
    if (!eglInitialize(display_, nullptr, nullptr)) fail("eglInitialize");
    if (!eglBindAPI(EGL_OPENGL_API)) fail("eglBindAPI");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display_, wanted, &config, 1, &count) || count == 0) fail("eglChooseConfig");
    const EGLint version[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT) fail("eglCreateContext");
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
        eglDestroyContext(display_, context_);
        fail("eglMakeCurrent");
    }
}

// The EGL display stays initialised: there is one per process, and others may use it.
SurfacelessContext::~SurfacelessContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
}

}  // namespace tactus::display

#include "EglContext.h"

#include <EGL/eglext.h>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace osgTSS {

namespace {

[[noreturn]] void fail(const char* step) {
    char code[16];
    std::snprintf(code, sizeof code, "0x%x", static_cast<unsigned int>(eglGetError()));
    throw std::runtime_error(std::string("EGL gives no OpenGL: ") + step + " failed (" + code + ")");
}

EGLDisplay openDisplay() {
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const auto platform =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (platform && extensions && std::strstr(extensions, "EGL_MESA_platform_surfaceless")) {
        const EGLDisplay display = platform(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
    }
    const EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) fail("eglInitialize");
    return display;
}

} // namespace

EglContext::EglContext() : _display(openDisplay()) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_DEPTH_SIZE,
                             24,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(_display, wanted, &config, 1, &count) || count == 0) fail("eglChooseConfig");
    // Pictures are drawn into framebuffer objects of their own size.
    const EGLint size[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    _surface = eglCreatePbufferSurface(_display, config, size);
    if (_surface == EGL_NO_SURFACE) fail("eglCreatePbufferSurface");
    if (!eglBindAPI(EGL_OPENGL_API)) fail("eglBindAPI");
    _context = eglCreateContext(_display, config, EGL_NO_CONTEXT, nullptr);
    if (_context == EGL_NO_CONTEXT) fail("eglCreateContext");
    if (!eglMakeCurrent(_display, _surface, _surface, _context)) fail("eglMakeCurrent");
}

EglContext::~EglContext() {
    eglMakeCurrent(_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (_context != EGL_NO_CONTEXT) eglDestroyContext(_display, _context);
    if (_surface != EGL_NO_SURFACE) eglDestroySurface(_display, _surface);
    eglTerminate(_display);
}

} // namespace osgTSS

#pragma once
#include <EGL/egl.h>

namespace osgTSS {

/// An OpenGL context (compatibility profile) current in this thread, on a small buffer of its own and no
/// display server: surfaceless Mesa where there is one, else the default EGL display.
class EglContext {
public:
    /// Throws std::runtime_error that says which step failed.
    EglContext();
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

private:
    EGLDisplay _display = EGL_NO_DISPLAY;
    EGLSurface _surface = EGL_NO_SURFACE;
    EGLContext _context = EGL_NO_CONTEXT;
};

} // namespace osgTSS

#include "OffscreenViewer.h"

#include <osg/ComputeBoundsVisitor>
#include <osg/Geometry>
#include <osgTSS/SkinGeometry>

namespace osgTSS {

namespace {

/// What is shown, by its vertices: bounds of nodes are spheres about spheres, and OSG doubles those of rigged
/// meshes. Skins hold theirs where their bones have them from the first update on.
class ShownVertices : public osg::ComputeBoundsVisitor {
public:
    explicit ShownVertices(Framing& framing)
        : osg::ComputeBoundsVisitor(TRAVERSE_ACTIVE_CHILDREN), _framing(framing) {}

    void apply(osg::Drawable& drawable) override {
        const osg::Matrixd toWorld =
            _matrixStack.empty() ? osg::Matrixd() : osg::Matrixd(_matrixStack.back());
        const osg::Vec3Array* vertices = nullptr;
        if (const auto* skin = dynamic_cast<const SkinGeometry*>(&drawable))
            vertices = skin->getVertices();
        else if (const osg::Geometry* geometry = drawable.asGeometry())
            vertices = dynamic_cast<const osg::Vec3Array*>(geometry->getVertexArray());
        if (vertices)
            for (const osg::Vec3& v : *vertices) _framing.add(osg::Vec3d(v) * toWorld);
        else if (const osg::BoundingBox box = drawable.getBoundingBox(); box.valid())
            for (unsigned int k = 0; k < 8; ++k) _framing.add(osg::Vec3d(box.corner(k)) * toWorld);
    }

private:
    Framing& _framing;
};

} // namespace

OffscreenViewer::OffscreenViewer(osg::Node& scene, const Shot& shot) : _shot(shot) {
    _viewer->setThreadingModel(osgViewer::Viewer::SingleThreaded);
    const int width = shot.width * shot.finer, height = shot.height * shot.finer;
    _viewer->setUpViewerAsEmbeddedInWindow(0, 0, width, height);
    _viewer->setSceneData(&scene);
    _viewer->setKeyEventSetsDone(0);
    osg::Camera& camera = *_viewer->getCamera();
    camera.setClearColor(shot.background);
    camera.setProjectionMatrixAsPerspective(fieldOfView, static_cast<double>(shot.width) / shot.height, 1,
                                            1e4);
    camera.setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    _image->allocateImage(shot.width, shot.height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    _drawn->allocateImage(width, height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    camera.attach(osg::Camera::COLOR_BUFFER, _drawn.get());
    _viewer->getFrameStamp()->setFrameNumber(~0u); // frame() counts on, to 0
}

const osg::Image& OffscreenViewer::draw(unsigned int frame) {
    if (!_viewer->isRealized()) _viewer->realize();
    pass(frame);
    look(frame);
    _viewer->renderingTraversals();
    average();
    return *_image;
}

void OffscreenViewer::pass(unsigned int frame) {
    _viewer->advance(frame / framesPerSecond);
    _viewer->eventTraversal();
    _viewer->updateTraversal();
}

// Multisampled framebuffer objects are not to be had everywhere; a finer picture is.
void OffscreenViewer::average() {
    const int n = _shot.finer;
    for (int y = 0; y < _shot.height; ++y)
        for (int x = 0; x < _shot.width; ++x)
            for (int channel = 0; channel < 3; ++channel) {
                int sum = 0;
                for (int v = 0; v < n; ++v)
                    for (int u = 0; u < n; ++u) sum += _drawn->data(n * x + u, n * y + v)[channel];
                _image->data(x, y)[channel] = static_cast<unsigned char>((sum + n * n / 2) / (n * n));
            }
}

void OffscreenViewer::look(unsigned int frame) {
    osg::Camera& camera = *_viewer->getCamera();
    osg::Matrixd view;
    if (_shot.view && _shot.view->getInverse(frame / framesPerSecond, view))
        return camera.setViewMatrix(view);
    if (frame > 0) return;
    if (_shot.place) {
        const auto& [eye, at] = *_shot.place;
        const osg::Vec3d up =
            ((at - eye) ^ osg::Z_AXIS).length() > 1e-6 * (at - eye).length() ? osg::Z_AXIS : osg::Y_AXIS;
        return camera.setViewMatrixAsLookAt(eye, at, up);
    }
    ShownVertices shown(_shot.framing);
    if (!_shot.framed) _viewer->getSceneData()->accept(shown);
    camera.setViewMatrix(_shot.framing.view());
}

} // namespace osgTSS

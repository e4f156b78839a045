#include "OffscreenViewer.h"

namespace osgTSS {

namespace {

constexpr double framesPerSecond = 24;

} // namespace

OffscreenViewer::OffscreenViewer(osg::Node& scene, const Shot& shot) : _shot(shot) {
    _viewer->setThreadingModel(osgViewer::Viewer::SingleThreaded);
    _viewer->setUpViewerAsEmbeddedInWindow(0, 0, shot.width, shot.height);
    _viewer->setSceneData(&scene);
    _viewer->setKeyEventSetsDone(0);
    osg::Camera& camera = *_viewer->getCamera();
    camera.setClearColor(shot.background);
    camera.setProjectionMatrixAsPerspective(30, static_cast<double>(shot.width) / shot.height, 1, 1e4);
    camera.setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    _image->allocateImage(shot.width, shot.height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    const auto samples = static_cast<unsigned int>(shot.samples);
    camera.attach(osg::Camera::COLOR_BUFFER, _image.get(), samples);
    _viewer->getFrameStamp()->setFrameNumber(~0u); // frame() counts on, to 0
}

const osg::Image& OffscreenViewer::draw(unsigned int frame) {
    look(frame);
    _viewer->frame(frame / framesPerSecond);
    return *_image;
}

void OffscreenViewer::look(unsigned int frame) {
    osg::Camera& camera = *_viewer->getCamera();
    osg::Matrixd view;
    if (_shot.view && _shot.view->getInverse(frame / framesPerSecond, view))
        return camera.setViewMatrix(view);
    if (frame > 0) return;
    // As osgviewer's manipulators stand at first.
    const osg::BoundingSphere bound = _viewer->getSceneData()->getBound();
    const osg::Vec3d back = osg::Vec3d(0, -3.5 * bound.radius(), 0);
    camera.setViewMatrixAsLookAt(bound.center() + back, bound.center(), osg::Z_AXIS);
}

} // namespace osgTSS

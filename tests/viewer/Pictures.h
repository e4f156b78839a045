#pragma once
#include <osg/Camera>
#include <osg/GraphicsContext>
#include <osg/Image>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgViewer/Viewer>

#include <cstdlib>
#include <mutex>
#include <vector>

/// A stock viewer on whatever display there is, and what it draws.
namespace pictures {

constexpr int width = 160, height = 120;

inline bool haveDisplay() {
    return std::getenv("DISPLAY") != nullptr;
}

inline osg::ref_ptr<osg::Node> load(const std::string& scene) {
    osgDB::FilePathList& paths = osgDB::Registry::instance()->getLibraryFilePathList();
    const std::string own = std::string(OSGTSS_BINARY_DIR) + "/lib";
    if (paths.empty() || paths.front() != own) paths.push_front(own);
    return osgDB::readRefNodeFile(std::string(OSGTSS_SOURCE_DIR "/scenes/") + scene,
                                  new osgDB::Options("clock=frame"));
}

/// Keeps each frame drawn, in order.
class Keep : public osg::Camera::DrawCallback {
public:
    void operator()(osg::RenderInfo&) const override {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->readPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE);
        const std::lock_guard lock(_mutex);
        _frames.emplace_back(image->data(), image->data() + image->getTotalSizeInBytes());
    }
    std::vector<std::vector<unsigned char>> take() {
        const std::lock_guard lock(_mutex);
        return std::move(_frames);
    }

private:
    mutable std::mutex _mutex;
    mutable std::vector<std::vector<unsigned char>> _frames;
};

/// A viewer with one off-screen buffer.
inline osg::ref_ptr<osgViewer::Viewer> makeViewer(osg::Node& scene,
                                                  osgViewer::ViewerBase::ThreadingModel model, Keep& keep) {
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->readDISPLAY();
    traits->setUndefinedScreenDetailsToDefaultScreen();
    traits->width = width;
    traits->height = height;
    traits->pbuffer = true;
    traits->doubleBuffer = false;
    osg::ref_ptr<osgViewer::Viewer> viewer = new osgViewer::Viewer;
    osg::Camera& camera = *viewer->getCamera();
    camera.setGraphicsContext(osg::GraphicsContext::createGraphicsContext(traits));
    camera.setDrawBuffer(GL_FRONT);
    camera.setReadBuffer(GL_FRONT);
    camera.setViewport(0, 0, width, height);
    camera.setProjectionMatrixAsPerspective(30, static_cast<double>(width) / height, 1, 1e4);
    camera.setFinalDrawCallback(&keep);
    viewer->setThreadingModel(model);
    viewer->setSceneData(&scene);
    const osg::BoundingSphere bound = scene.getBound();
    camera.setViewMatrixAsLookAt(bound.center() + osg::Vec3d(0, -3.5 * bound.radius(), 0), bound.center(),
                                 osg::Z_AXIS);
    return viewer;
}

} // namespace pictures
